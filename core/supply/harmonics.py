"""Harmonics over a record of any length, of a supply whose frequency wanders.

The record is split into blocks of ten cycles, which is the window of IEC 61000-4-7 at 50 Hz. In each, phasors
of all orders are fitted by least squares under a Hann window, and turned by the phase of the block's own
voltage. Their mean over the blocks is coherent: harmonics stay as they are however the frequency wanders, and
what is no harmonic (interharmonics, sidebands, noise) turns from block to block and cancels. The standard
takes the root of the mean of squares instead, which is the same for harmonics that are steady.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.signals.clarke import CLARKE
from core.signals.sequence import PhaseSequence, sequence_phasors

HIGHEST_ORDER = 25
HIGHEST_OF_RATE = 0.45
"""Highest frequency that is fitted, of the sampling rate."""
BLOCK_CYCLES = 10
FEWEST_CYCLES = 3
"""Fewer do not tell neighbouring orders apart under a Hann window."""
CYCLE_SHORT = 0.05
"""Share of a cycle that a record may lack and still count as whole."""


@dataclass(frozen=True, slots=True)
class Harmonics:
    """Phasors of a record's quantities, rms, by the phase of its first quantities' main sequence.

    Parameters
    ----------
    frequency_hz : float
        Mean frequency [Hz].
    phasors : ndarray of complex, shape (quantities, orders)
        Orders 1, 2, 3 ...
    by_block : ndarray of complex, shape (quantities, blocks)
        Fundamentals of the single blocks.
    samples : int
        Number of samples from the end of the record that they are taken from.
    """

    frequency_hz: float
    phasors: NDArray[np.complex128]
    by_block: NDArray[np.complex128]
    samples: int


def harmonics_of(x: NDArray[np.float64], frequency_hz: float, sample_rate_hz: float) -> Harmonics:
    """Fit harmonics up to the 25th, or to the highest that the sampling tells.

    Parameters
    ----------
    x : ndarray, shape (quantities, n)
        Samples, all finite, at least three cycles of them. The first three rows are those of a supply.
    frequency_hz : float
        Frequency of the supply, to some hundredths of a hertz [Hz].
    sample_rate_hz : float
        Sampling rate, above 2.3 times the frequency [Hz].

    Returns
    -------
    Harmonics
        The harmonics.
    """
    per_cycle = sample_rate_hz / frequency_hz
    cycles = min(BLOCK_CYCLES, int(x.shape[1] / per_cycle + CYCLE_SHORT))
    length = min(round(cycles * per_cycle), x.shape[1])
    blocks = x.shape[1] // length
    split = x[:, -blocks * length :].reshape(x.shape[0], blocks, length)
    phase = _phases(_fitted(split[:3], per_cycle, 1)[..., 0])
    frequency_hz += _drift_hz(phase, frequency_hz, length / sample_rate_hz)
    per_cycle = sample_rate_hz / frequency_hz
    highest = min(HIGHEST_ORDER, int(HIGHEST_OF_RATE * per_cycle))
    found = _fitted(split, per_cycle, highest)
    phase = _phases(found[:3, :, 0])
    turned = found * np.exp(-1j * np.outer(phase, np.arange(1, highest + 1)))
    return Harmonics(
        frequency_hz=frequency_hz,
        phasors=np.asarray(turned.mean(axis=1), dtype=np.complex128),
        by_block=np.asarray(turned[..., 0], dtype=np.complex128),
        samples=blocks * length,
    )


def _fitted(blocks: NDArray[np.float64], per_cycle: float, highest: int) -> NDArray[np.complex128]:
    """Fit phasors, rms, by the first sample of each block (..., n), shape (..., highest)."""
    length = blocks.shape[-1]
    turning = np.exp(2j * pi / per_cycle * np.arange(length))
    powers = np.multiply.accumulate(np.broadcast_to(turning, (highest, length)))
    basis = np.concatenate([np.ones((1, length)), powers.real, powers.imag])
    weighted = basis * np.sin(pi * (np.arange(length) + 0.5) / length) ** 2
    products = (blocks @ weighted.T)[..., np.newaxis]
    found = np.linalg.solve(weighted @ basis.T, products)[..., 0]
    return np.asarray((found[..., 1 : highest + 1] - 1j * found[..., highest + 1 :]) / sqrt(2.0))


def _phases(supply: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return the phase of the main sequence of three phasors in each block, shape (blocks,) [rad]."""
    axes = CLARKE @ supply
    turning = 1j if sequence_phasors(axes[:, 0]).sequence is PhaseSequence.ABC else -1j
    return np.asarray(np.angle(axes[0] + turning * axes[1]))


def _drift_hz(phase: NDArray[np.float64], frequency_hz: float, block_s: float) -> float:
    """Return the mean frequency beside the given one: cycles from the first block to the last [Hz]."""
    if phase.size < 2:
        return 0.0
    beside = np.unwrap(phase - 2.0 * pi * frequency_hz * block_s * np.arange(phase.size))
    return float(beside[-1] - beside[0]) / (2.0 * pi * block_s * (phase.size - 1))
