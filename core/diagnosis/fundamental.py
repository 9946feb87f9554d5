"""What a hypothesis is held against: both sequences of a record's voltages and currents at supply frequency.

Shorted turns, load and sensors' delays all show there, turning forwards or backwards. Whatever else a record
holds (noise, slots, saturation, harmonics, a load that swings) tells nothing of them and would bend a fit:
noise on the voltages, played through a model, pulls every level towards zero, and no machine's harmonics are
those of a linear model. What it does tell is how far the phasors themselves may be trusted.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.signal.windows import tukey

from core.diagnosis.case import LONGEST_WINDOW_S, Case
from core.machines.base import Array
from core.machines.steady_state import ComplexArray

HIGHEST_ORDER = 13
"""Harmonics that repeat every cycle and so are no noise."""
TAPERED = 0.25
"""Share of the record over which it fades in and out: where a load swings, the current at one end of a record
differs from that at the other, and the step between them would pass for backward-turning current."""
FEWEST_BLOCKS = 3
EQUAL_CYCLES = 5.0
"""Weight, in cycles, of equal and independent noise on the four components."""


@dataclass(frozen=True, slots=True)
class Phasors:
    """Of one quantity's space vector, at the first sample compared.

    components: peak, forwards re, im, backwards re, im, shape (4,).  covariance: of their noise (4, 4).
    """

    components: Array
    covariance: Array

    @property
    def forward(self) -> complex:
        return complex(self.components[0], self.components[1])

    @property
    def backward(self) -> complex:
        return complex(self.components[2], self.components[3])

    def shrunk(self, cycles: int) -> Array:
        """Covariance drawn towards equal, independent components as far as few cycles leave it uncertain."""
        equal = np.trace(self.covariance) / 4.0 * np.eye(4)
        return np.asarray((cycles * self.covariance + EQUAL_CYCLES * equal) / (cycles + EQUAL_CYCLES))


@dataclass(frozen=True, slots=True)
class Fundamental:
    """One record's winding quantities at supply frequency.

    angular_frequency: w_s [rad/s].  cycles: how many the phasors are taken from.
    """

    current: Phasors
    voltage: Phasors
    angular_frequency: float
    cycles: int


def fundamental_of(case: Case) -> Fundamental:
    """Phasors over the last whole cycles of a record, a second at most."""
    per_cycle = case.sample_rate_hz / case.frequency_hz
    longest = min(case.current_ab.shape[1], round(LONGEST_WINDOW_S * case.sample_rate_hz))
    cycles = int(longest / per_cycle)
    samples = round(cycles * per_cycle)
    first = case.current_ab.shape[1] - samples
    turning = np.exp(-2j * pi / per_cycle * np.arange(samples))
    vectors = np.stack([x[0, first:] + 1j * x[1, first:] for x in (case.current_ab, case.voltage_ab)])
    highest = max(1, min(HIGHEST_ORDER, int(0.45 * per_cycle)))
    weight = tukey(samples, TAPERED)
    found, beside = _periodic(vectors, turning, weight, highest)
    blocks = max(cycles, FEWEST_BLOCKS)
    edges = np.round(np.arange(blocks) * samples / blocks).astype(np.int64)
    fewer = samples * float(weight @ weight) / float(weight.sum()) ** 2
    phasors = [
        Phasors(_components(found[k, 0], found[k, 1]), fewer * _scatter(beside[k], turning, edges))
        for k in (0, 1)
    ]
    return Fundamental(phasors[0], phasors[1], 2.0 * pi * case.frequency_hz, cycles=blocks)


def components(phasor: ComplexArray) -> Array:
    """Components (..., 4) from peak phasors on the Clarke axes, shape (2, ...)."""
    alpha, beta = phasor
    return _components((alpha + 1j * beta) / 2.0, (alpha - 1j * beta).conj() / 2.0)


def axis_phasors(values: Array) -> ComplexArray:
    """Peak phasors on the Clarke axes (2,) from components (4,)."""
    forward, backward = values[0] + 1j * values[1], values[2] - 1j * values[3]
    return np.array([forward + backward, -1j * (forward - backward)])


def _components(forward: ComplexArray, backward: ComplexArray) -> Array:
    return np.stack([forward.real, forward.imag, backward.real, backward.imag], axis=-1)


def _periodic(
    vectors: ComplexArray, turning: ComplexArray, weight: Array, highest: int
) -> tuple[ComplexArray, ComplexArray]:
    """Weighted least-squares fit of the harmonics -highest to highest.

    Returns coefficients of orders 1 and -1 (m, 2), and what of the vectors (m, n) is beside all harmonics.
    """
    basis = np.empty((2 * highest + 1, turning.size), dtype=np.complex128)
    basis[highest] = 1.0
    for order in range(1, highest + 1):
        basis[highest - order] = basis[highest - order + 1] * turning
        basis[highest + order] = basis[highest - order].conj()
    weighted = basis.conj() * weight
    found = np.asarray(np.linalg.solve(weighted @ basis.T, weighted @ vectors.T).T, dtype=np.complex128)
    return found[:, [highest + 1, highest - 1]], vectors - found @ basis


def _scatter(beside: ComplexArray, turning: ComplexArray, edges: NDArray[np.int64]) -> Array:
    """Covariance of the components from single cycles' (batch means; Law and Kelton, Simulation Modeling and
    Analysis): noise of any colour counts."""
    lengths = np.diff(edges, append=turning.size)
    turned = np.stack([beside * turning, beside * turning.conj()])
    cycles = np.empty((2, edges.size), dtype=np.complex128)
    np.add.reduceat(turned, edges, axis=1, out=cycles)
    forward, backward = cycles / lengths
    return np.asarray(np.cov(_components(forward, backward), rowvar=False)) / edges.size
