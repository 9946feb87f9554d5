"""Sidebands in the current of one phase, where there is nothing else: neither other phases nor voltages.

Offset, harmonics and both sidebands are fitted together by least squares, so that no window is needed to keep
the fundamental out of the sidebands: it is that which hides them from a Fourier transform at low slip. One
phase tells neither the load's swing nor the supply's from a broken bar. What tells is the change of the level
against a healthy record at the same slip.
"""

from dataclasses import dataclass
from math import ceil, inf, log, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.rotor.spikes import without_spikes
from core.signals.errors import SignalError

HIGHEST_ORDER = 7
FEWEST_TURNS = 1.5
"""Least distance of the sidebands from the fundamental, in cycles of it over the record."""
SEARCH_HZ = 1.0
"""How far from twice the slip the sidebands are looked for, and no farther than half of it."""
POINTS_A_TURN = 4.0
REFERENCES = 10
"""Pairs of lines beyond the search, a cycle over the record apart, that tell the noise."""
ITERATIONS = 6
MOST_OF_RATE = 0.45
"""Highest frequency of a harmonic over the sampling rate."""


@dataclass(frozen=True, slots=True)
class OnePhaseSidebands:
    """Sidebands of one phase's current.

    Parameters
    ----------
    lower, upper : float
        Amplitudes over the fundamental's.
    noise : float
        What noise around makes of one such amplitude, rms.
    distance_hz : float
        Distance of the sidebands from the fundamental [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    spikes : int
        Number of samples that were replaced.
    """

    lower: float
    upper: float
    noise: float
    distance_hz: float
    frequency_hz: float
    spikes: int


def one_phase_sidebands(
    current: Array, sample_rate_hz: float, slip: float, rated_frequency_hz: float
) -> OnePhaseSidebands:
    """Fit the sidebands (1 - 2s) f and (1 + 2s) f of one phase's current.

    Parameters
    ----------
    current : ndarray, shape (n,)
        Samples [A].
    sample_rate_hz : float
        Sampling rate [Hz].
    slip : float
        Slip, from the speed.
    rated_frequency_hz : float
        Frequency near which the supply's is [Hz].

    Returns
    -------
    OnePhaseSidebands
        The sidebands with the largest sum within the search.

    Raises
    ------
    SignalError
        If the record has missing samples, is all zero, or is too short for this slip.
    """
    duration_s = current.size / sample_rate_hz
    turns = 2.0 * slip * rated_frequency_hz * duration_s
    if not np.isfinite(current).all() or not np.abs(current).max(initial=0.0) > 0.0:
        raise SignalError("sidebands need finite samples of a current that flows")
    if turns < FEWEST_TURNS:
        needed_s = FEWEST_TURNS / (2.0 * slip * rated_frequency_hz) if slip > 0.0 else inf
        raise SignalError(
            f"{duration_s:.2f} s do not tell sidebands at twice a slip of {slip:.2%} from the supply: it "
            f"takes {needed_s:.1f} s"
        )
    samples = np.arange(current.size, dtype=np.float64)
    t: Array = np.asarray((samples - samples.mean()) / sample_rate_hz, dtype=np.float64)
    cleaned, spikes = without_spikes(current[np.newaxis], sample_rate_hz / rated_frequency_hz)
    x = cleaned[0]
    f = _frequency(x, t, rated_frequency_hz, sample_rate_hz)
    periodic = _periodic_basis(t, f, sample_rate_hz)
    centre, width = 2.0 * slip * f, min(SEARCH_HZ, slip * f)
    first, last = max(centre - width, FEWEST_TURNS / duration_s / 1.25), centre + width
    points = max(2, ceil((last - first) * duration_s * POINTS_A_TURN) + 1)
    searched = [float(one) for one in np.linspace(first, last, points)]
    orthonormal = np.linalg.qr(periodic)[0]
    found = np.array([_pair(x, _pair_basis(t, f, one), orthonormal) for one in searched])
    best = int(np.argmax(found.sum(axis=1)))
    together = np.hstack([periodic, _pair_basis(t, f, searched[best])])
    solution = np.linalg.lstsq(together, x)[0]
    left, fundamental = x - together @ solution, float(np.hypot(*solution[1:3]))
    beyond = [last + k / duration_s for k in range(1, REFERENCES + 1)]
    around = np.array([_pair(left, _pair_basis(t, f, one), orthonormal) for one in beyond])
    return OnePhaseSidebands(
        lower=float(found[best, 0]) / fundamental,
        upper=float(found[best, 1]) / fundamental,
        noise=sqrt(float(np.median(around**2)) / log(2.0)) / fundamental,
        distance_hz=searched[best],
        frequency_hz=f,
        spikes=spikes,
    )


def _frequency(x: Array, t: Array, near_hz: float, sample_rate_hz: float) -> float:
    """Fit the frequency by Gauss-Newton steps, all harmonics beside it (IEEE Std 1057, four parameters)."""
    f = near_hz
    for _ in range(ITERATIONS):
        basis = _periodic_basis(t, f, sample_rate_hz)
        amplitudes = np.linalg.lstsq(basis, x)[0]
        angle = 2.0 * pi * t
        orders = np.arange(1, 1 + (basis.shape[1] - 1) // 2)
        cosines, sines = amplitudes[1::2] * orders, amplitudes[2::2] * orders
        slope = angle * (basis[:, 1::2] @ sines - basis[:, 2::2] @ cosines)
        step = float(np.linalg.lstsq(np.column_stack([basis, slope]), x)[0][-1])
        f += step
        if not 0.5 * near_hz < f < 1.5 * near_hz:
            raise SignalError(f"the current has no line near {near_hz:g} Hz")
    return f


def _periodic_basis(t: Array, f: float, sample_rate_hz: float) -> Array:
    """Return offset, then cosine and sine of each harmonic, shape (n, 1 + 2 orders)."""
    orders = [k for k in range(1, HIGHEST_ORDER + 1) if k * f < MOST_OF_RATE * sample_rate_hz]
    columns: list[NDArray[np.float64]] = [np.ones(t.size)]
    for order in orders:
        angle = 2.0 * pi * order * f * t
        columns += [np.cos(angle), np.sin(angle)]
    return np.column_stack(columns)


def _pair_basis(t: Array, f: float, distance_hz: float) -> Array:
    angles = [2.0 * pi * (f + side * distance_hz) * t for side in (-1.0, 1.0)]
    return np.column_stack([wave(angle) for angle in angles for wave in (np.cos, np.sin)])


def _pair(x: Array, basis: Array, orthonormal: Array) -> tuple[float, float]:
    """Return the amplitudes of a pair of lines, with what the orthonormal columns span fitted beside them."""
    own = basis - orthonormal @ (orthonormal.T @ basis)
    solution = np.linalg.solve(own.T @ own, own.T @ x)
    return float(np.hypot(*solution[:2])), float(np.hypot(*solution[2:]))
