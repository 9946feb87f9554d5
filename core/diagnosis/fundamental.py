"""Both sequences of a record's voltages and currents at supply frequency, with which hypotheses are compared.

Shorted turns, load and sensors' delays all show there, turning forwards or backwards. Whatever else a record
holds (noise, slots, saturation, harmonics, a load that swings) tells nothing of them and would bend a fit:
noise on the voltages, played through a model, pulls every level towards zero, and no machine's harmonics are
those of a linear model. What it does tell is how far the phasors themselves may be trusted.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.case import LONGEST_WINDOW_S, Case
from core.machines.base import Array
from core.machines.steady_state import ComplexArray
from core.signals.windows import tukey_window

HIGHEST_ORDER = 13
"""Highest harmonic that counts as signal. Harmonics repeat every cycle, so they are no noise."""
TAPERED = 0.25
"""Share of the record over which it fades in and out: where a load swings, the current at one end of a record
differs from that at the other, and the step between them would pass for backward-turning current."""
CYCLE_SHORT = 0.05
"""Share of a cycle that a record may lack and still count as whole: no frequency is known to the last
digit."""
MOST_CORRELATED = 0.8
"""Correlation from cycle to cycle above which a record is too short to estimate it."""
EQUAL_CYCLES = 5.0
"""Weight, in cycles, of equal and independent noise on the four components."""


@dataclass(frozen=True, slots=True)
class Phasors:
    """Phasors of one quantity's space vector, at the first sample compared.

    Parameters
    ----------
    components : ndarray, shape (4,)
        Forwards re, im, backwards re, im, peak.
    scatter : ndarray, shape (4, 4)
        Covariance of their noise if cycles were independent.
    growth : ndarray, shape (4,)
        Growth of each one's standard deviation because cycles are not independent.
    by_cycle : ndarray of complex, shape (2, cycles)
        What single cycles have beside the components, forwards and backwards.
    """

    components: Array
    scatter: Array
    growth: Array
    by_cycle: ComplexArray

    @property
    def forward(self) -> complex:
        """Forward-turning phasor, peak."""
        return complex(self.components[0], self.components[1])

    @property
    def backward(self) -> complex:
        """Backward-turning phasor, peak."""
        return complex(self.components[2], self.components[3])

    @property
    def covariance(self) -> Array:
        """Covariance of the components' noise, whatever its colour, shape (4, 4)."""
        return np.asarray(self.scatter * np.outer(self.growth, self.growth))

    def shrunk(self, cycles: int) -> Array:
        """Draw the scatter towards equal, independent components as far as few cycles leave it uncertain.

        The result is steady enough from record to record to weigh with.
        """
        equal = np.trace(self.scatter) / 4.0 * np.eye(4)
        return np.asarray((cycles * self.scatter + EQUAL_CYCLES * equal) / (cycles + EQUAL_CYCLES))


@dataclass(frozen=True, slots=True)
class Fundamental:
    """One record's winding quantities at supply frequency.

    Parameters
    ----------
    current, voltage : Phasors
        Phasors, peak [A, V].
    angular_frequency : float
        Angular frequency w_s [rad/s].
    cycles : int
        Number of cycles that the phasors are taken from.
    weighting : float
        Variance of a mean over the record, which fades in and out, over that of an even one.
    """

    current: Phasors
    voltage: Phasors
    angular_frequency: float
    cycles: int
    weighting: float

    def variance(self, by_cycle: ComplexArray) -> float:
        """Return the variance of a record's value, whatever the colour of its noise."""
        variance = float(np.var(by_cycle, ddof=1)) / self.cycles
        return self.weighting * variance * _growth(by_cycle)


def fundamental_of(case: Case) -> Fundamental:
    """Find the phasors over the last whole cycles of a record, a second at most."""
    window = _window(case)
    samples, cycles, turning = window.turning.size, window.cycles, window.turning
    vectors = np.stack([x[0, -samples:] + 1j * x[1, -samples:] for x in (case.current_ab, case.voltage_ab)])
    found, beside = _periodic(vectors, window)
    edges = np.round(np.arange(cycles) * samples / cycles).astype(np.int64)
    weighting = samples * float(window.weight @ window.weight) / float(window.weight.sum()) ** 2
    phasors = []
    for k in (0, 1):
        single = _cycles(beside[k], turning, edges)
        scatter = weighting * np.cov(_components(*single), rowvar=False) / cycles
        growth = np.sqrt([_growth(one) for one in single]).repeat(2)
        phasors.append(Phasors(_components(found[k, 0], found[k, 1]), np.asarray(scatter), growth, single))
    return Fundamental(
        phasors[0], phasors[1], 2.0 * pi * case.frequency_hz, cycles=cycles, weighting=weighting
    )


def phasors_of(signals: Array, case: Case) -> ComplexArray:
    """Find the phasors of further signals of a record, at the same instant and over the same cycles."""
    window = _window(case)
    found = _harmonics(signals[:, -window.turning.size :].astype(np.complex128), window)
    return np.asarray(2.0 * found[:, window.highest + 1])


def components(phasor: ComplexArray) -> Array:
    """Split phasors of the Clarke axes into components."""
    alpha, beta = phasor
    return _components((alpha + 1j * beta) / 2.0, (alpha - 1j * beta).conj() / 2.0)


def axis_phasors(values: Array) -> ComplexArray:
    """Join components to phasors of the Clarke axes."""
    forward, backward = values[0] + 1j * values[1], values[2] - 1j * values[3]
    return np.array([forward + backward, -1j * (forward - backward)])


def _components(forward: ComplexArray, backward: ComplexArray) -> Array:
    return np.stack([forward.real, forward.imag, backward.real, backward.imag], axis=-1)


@dataclass(frozen=True, slots=True)
class _Window:
    """The last whole cycles of a record, and how they are weighed.

    powers: exp(-j k w t) of each sample, for orders k from 0 to the highest that the sampling tells (orders,
    n).  weight (n,).  gram: inner products of the harmonics -highest to highest, so weighed.
    """

    cycles: int
    powers: ComplexArray
    weight: Array
    gram: ComplexArray

    @property
    def turning(self) -> ComplexArray:
        """exp(-j w t) of each sample (n,)."""
        return np.asarray(self.powers[1])

    @property
    def highest(self) -> int:
        """Highest order that the sampling tells."""
        return len(self.powers) - 1


def _window(case: Case) -> _Window:
    recorded, per_cycle = case.current_ab.shape[1], case.sample_rate_hz / case.frequency_hz
    longest = min(recorded, round(LONGEST_WINDOW_S * case.sample_rate_hz))
    cycles = int(longest / per_cycle + CYCLE_SHORT)
    return _window_of(cycles, min(round(cycles * per_cycle), recorded), per_cycle)


@lru_cache(maxsize=1)
def _window_of(cycles: int, samples: int, per_cycle: float) -> _Window:
    """Make a window once for all signals of a record."""
    turning = np.exp(-2j * pi / per_cycle * np.arange(samples))
    weight = tukey_window(samples, TAPERED)
    highest = max(1, min(HIGHEST_ORDER, int(0.45 * per_cycle)))
    powers = np.empty((highest + 1, samples), dtype=np.complex128)
    powers[0] = 1.0
    for order in range(highest):
        np.multiply(powers[order], turning, out=powers[order + 1])
    # Inner products of the harmonics depend on the difference of their orders alone.
    low, high = _sums(powers, weight), _sums(powers, weight * powers[highest])
    differences = np.concatenate([low, high[1:]])
    lag = np.subtract.outer(np.arange(differences.size), np.arange(differences.size))
    gram = np.where(lag >= 0, differences[np.abs(lag)], differences[np.abs(lag)].conj())
    return _Window(cycles, powers, weight, gram)


def _periodic(vectors: ComplexArray, window: _Window) -> tuple[ComplexArray, ComplexArray]:
    """Weighted least-squares fit of the harmonics -highest to highest.

    Returns coefficients of orders 1 and -1 (m, 2), and what of the vectors (m, n) is beside all harmonics.
    """
    highest, powers = window.highest, window.powers
    found = _harmonics(vectors, window)
    periodic = (found[:, highest:].conj() @ powers).conj()
    periodic += found[:, highest - 1 :: -1] @ powers[1:]
    return found[:, [highest + 1, highest - 1]], vectors - periodic


def _harmonics(vectors: ComplexArray, window: _Window) -> ComplexArray:
    """Return the coefficients of the harmonics -highest to highest (m, orders)."""
    powers, weight = window.powers, window.weight
    # The basis turns the other way than `powers`: order k of it is their conjugate.
    forwards, backwards = _sums(powers, weight * vectors), _sums(powers, weight * vectors.conj()).conj()
    products = np.concatenate([backwards[:, :0:-1], forwards], axis=1)
    return np.asarray(np.linalg.solve(window.gram, products.T).T, dtype=np.complex128)


def _sums(powers: ComplexArray, values: ComplexArray | Array) -> ComplexArray:
    """Sum the values (..., n) times each power (orders, n), shape (..., orders)."""
    return np.asarray(values @ powers.T)


def _cycles(beside: ComplexArray, turning: ComplexArray, edges: NDArray[np.int64]) -> ComplexArray:
    """Return forward and backward phasors of single cycles, (2, cycles).

    Their scatter is noise of any spectrum (batch means; Law and Kelton, Simulation Modeling and Analysis).
    """
    lengths = np.diff(edges, append=turning.size)
    turned = np.stack([beside * turning, beside * turning.conj()])
    cycles = np.empty((2, edges.size), dtype=np.complex128)
    np.add.reduceat(turned, edges, axis=1, out=cycles)
    return np.asarray(cycles / lengths)


def _growth(cycles: ComplexArray) -> float:
    """Return the growth of a mean's variance because neighbouring cycles are correlated.

    It is (1 + r) / (1 - r) for a first-order autoregression, the bias of r for few cycles taken off.
    """
    beside = cycles - cycles.mean()
    energy = float(np.vdot(beside, beside).real)
    if energy == 0.0:
        return 1.0
    correlation = float(np.vdot(beside[:-1], beside[1:]).real) / energy
    unbiased = correlation + (1.0 + 3.0 * correlation) / cycles.size
    likely = float(np.clip(unbiased, 0.0, MOST_CORRELATED)) * cycles.size / (cycles.size + EQUAL_CYCLES)
    return (1.0 + likely) / (1.0 - likely)
