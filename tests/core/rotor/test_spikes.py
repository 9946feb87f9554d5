"""Single samples beside a waveform."""

import numpy as np

from core.rotor.spikes import without_spikes

PER_CYCLE = 100.0


def _waves(random: np.random.Generator) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    angle = 2.0 * np.pi * np.arange(3_000) / PER_CYCLE
    swing = 1.0 + 0.05 * np.sin(angle / 20.0)
    return np.stack([swing * np.sin(angle), np.cos(angle) + 0.1 * np.cos(5.0 * angle)]) + 0.002 * (
        random.standard_normal((2, 3_000))
    )


def test_spikes_are_replaced_by_what_the_neighbouring_cycles_have() -> None:
    clean = _waves(np.random.default_rng(1))
    spoiled = clean.copy()
    for row, at in ((0, 700), (0, 1_250), (1, 1_501)):
        spoiled[row, at] += 0.5
    repaired, count = without_spikes(spoiled, PER_CYCLE)
    assert count == 3
    assert np.abs(repaired - clean).max() < 0.05


def test_a_waveform_without_spikes_stays_as_it_is() -> None:
    clean = _waves(np.random.default_rng(2))
    repaired, count = without_spikes(clean, PER_CYCLE)
    assert count == 0
    assert repaired is clean
