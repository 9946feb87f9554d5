from math import nan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.signals import PhaseSequence, SequencePhasors, clarke, fundamental_phasors, sequence_phasors
from tests.core.signals.waveforms import three_phase

component = st.complex_numbers(min_magnitude=0.1, max_magnitude=1e3)


@given(component, component)
def test_components_come_back_from_the_waveforms_they_made(positive: complex, negative: complex) -> None:
    x_ab = clarke(three_phase(positive, negative, samples=400))
    found = sequence_phasors(fundamental_phasors(x_ab, 50, 10_000))
    assert found.positive == pytest.approx(positive, abs=1e-7)
    assert found.negative == pytest.approx(negative, abs=1e-7)


def test_they_are_fortescues() -> None:
    a = np.exp(2j * pi / 3)
    x_a, x_b, x_c = fundamental_phasors(three_phase(230 + 10j, 7 - 3j), 50, 10_000)
    found = sequence_phasors(fundamental_phasors(clarke(three_phase(230 + 10j, 7 - 3j)), 50, 10_000))
    assert found.positive == pytest.approx((x_a + a * x_b + a**2 * x_c) / 3)
    assert found.negative == pytest.approx((x_a + a**2 * x_b + a * x_c) / 3)


def test_unbalance_and_order_are_the_supplys_own() -> None:
    abc, acb = SequencePhasors(400, 12j), SequencePhasors(12j, 400)
    assert (abc.sequence, acb.sequence) == (PhaseSequence.ABC, PhaseSequence.ACB)
    assert abc.unbalance_factor == acb.unbalance_factor == pytest.approx(0.03)


def test_nothing_has_no_unbalance() -> None:
    assert SequencePhasors(0, 0).unbalance_factor == pytest.approx(nan, nan_ok=True)
