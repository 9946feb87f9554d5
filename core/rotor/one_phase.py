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
"""Highest frequency of a line over the sampling rate."""
FEWEST_CYCLES = 4.0
"""Spikes show against the cycles beside them."""
LARGEST_SLIP = 0.3
"""Beyond it a motor starts rather than runs, and its lower sideband nears zero frequency."""
LEAST_LINE = 0.5
"""Least share of the line at supply frequency in the rms value of what varies."""


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
        If the record has missing samples, is all zero or no alternating current of this frequency, is too
        short for this slip, or is sampled too slowly for the line and its sidebands.
    """
    require_rate(sample_rate_hz, slip, rated_frequency_hz)
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
    if slip > LARGEST_SLIP:
        raise SignalError(
            f"a slip of {slip:.2%} is none of a running motor: expected at most {LARGEST_SLIP:.0%}"
        )
    if duration_s * rated_frequency_hz < FEWEST_CYCLES:
        needed_s = FEWEST_CYCLES / rated_frequency_hz
        raise SignalError(f"{duration_s:.3f} s are too short: it takes {needed_s:.2f} s")
    largest = float(np.abs(current).max())  # squares of the largest numbers there are would be infinite
    cleaned, spikes = without_spikes(current[np.newaxis] / largest, sample_rate_hz / rated_frequency_hz)
    x = cleaned[0]
    _require_alternating(x)
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
    if fundamental < LEAST_LINE * sqrt(2.0) * float(x.std()):
        raise _no_line(rated_frequency_hz)
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


def require_rate(sample_rate_hz: float, slip: float, rated_frequency_hz: float) -> None:
    """Refuse a sampling rate that cannot hold the supply's line and its sidebands.

    Parameters
    ----------
    sample_rate_hz : float
        Sampling rate [Hz].
    slip : float
        Slip, from the speed.
    rated_frequency_hz : float
        Frequency near which the supply's is [Hz].

    Raises
    ------
    SignalError
        If the rate is too low.
    """
    highest_hz = rated_frequency_hz * (1.0 + 2.0 * slip) + min(SEARCH_HZ, slip * rated_frequency_hz)
    needed_hz = highest_hz / MOST_OF_RATE
    if sample_rate_hz < needed_hz:
        raise SignalError(
            f"a sampling rate of {sample_rate_hz:g} Hz cannot hold the line at {rated_frequency_hz:g} Hz and "
            f"its upper sideband at up to {highest_hz:.1f} Hz: it takes {needed_hz:.0f} Hz. Is the rate "
            "given in kHz, are the times in ms, or are these rms values?"
        )


def _require_alternating(x: Array) -> None:
    if float(x.min()) >= 0.0 or float(x.max()) <= 0.0:
        raise SignalError(
            "all samples have one sign: these are rms values or a rectified current, expected the samples of "
            "the alternating current itself"
        )


def _no_line(near_hz: float) -> SignalError:
    return SignalError(f"the current has no line near {near_hz:g} Hz: expected that of a running motor")


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
            raise _no_line(near_hz)
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
    # A line that harmonics span already has nothing of its own: the smallest solution is none.
    solution = np.linalg.lstsq(own, x)[0]
    return float(np.hypot(*solution[:2])), float(np.hypot(*solution[2:]))
