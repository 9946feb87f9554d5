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
    for row, at in ((0, 12), (0, 700), (0, 1_250), (1, 1_501), (1, 2_960)):
        spoiled[row, at] += 0.5
    repaired, count = without_spikes(spoiled, PER_CYCLE)
    assert count == 5
    assert np.abs(repaired - clean).max() < 0.05


def test_a_waveform_without_spikes_stays_as_it_is() -> None:
    clean = _waves(np.random.default_rng(2))
    repaired, count = without_spikes(clean, PER_CYCLE)
    assert count == 0
    assert repaired is clean


def test_steps_of_a_coarse_converter_are_no_spikes() -> None:
    """Where most cycles repeat exactly, what moves by a step is what a sideband does."""
    angle = 2.0 * np.pi * np.arange(3_000) / PER_CYCLE
    wave = np.cos(angle) + 0.005 * np.cos(0.7 * angle)
    coarse = np.round(wave[np.newaxis] / 0.02) * 0.02
    repaired, count = without_spikes(coarse, PER_CYCLE)
    assert count == 0
    coarse[0, 1_234] += 0.3
    assert without_spikes(coarse, PER_CYCLE)[1] == 1
    assert repaired.shape == coarse.shape
