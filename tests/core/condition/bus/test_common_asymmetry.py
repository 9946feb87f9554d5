"""What the motors of a bus share: the same whether it is computed anew or kept from the record before."""

from dataclasses import replace

import numpy as np

from core.condition.bus.neighbours import CommonAsymmetry, StandingEstimate, common_asymmetry
from core.signals.sequence import PhaseSequence


def estimate(number: int) -> StandingEstimate:
    random = np.random.default_rng(number)
    return StandingEstimate(
        motor=f"motor {number}",
        sequence=PhaseSequence.ABC,
        asymmetry=0.01 * random.standard_normal(2),
        covariance=1e-6 * (1.0 + random.uniform()) * np.eye(2),
        channels=1e-5 * np.eye(2),
        others=3,
        transformers=4,
    )


def test_what_is_kept_is_what_would_be_computed() -> None:
    own, *others = (estimate(number) for number in range(4))
    kept = CommonAsymmetry()
    cases = [
        (own, others),
        (replace(own, asymmetry=np.zeros(2)), list(others)),
        (own, others[:2]),
        (own, [*others[:2], estimate(7)]),
        (replace(own, transformers=2), others),
        (replace(own, channels=2.0 * own.channels), others),
        (replace(own, others=0), others),
        (replace(own, sequence=PhaseSequence.ACB), others),
        (others[0], [own, *others]),
        (own, others),
    ]
    for one, beside in cases:
        found, expected = kept.of(one, beside), common_asymmetry(one, beside)
        assert (found is None) == (expected is None)
        for a, b in zip(found or (), expected or (), strict=True):
            assert a.tolist() == b.tolist()


def test_nothing_is_computed_anew_for_the_next_record() -> None:
    own, *others = (estimate(number) for number in range(4))
    kept = CommonAsymmetry()
    assert kept.of(own, others) is kept.of(replace(own, asymmetry=np.zeros(2)), list(others))
