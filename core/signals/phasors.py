"""Fundamental frequency and phasors of sampled waveforms by least squares.

Phasors are rms values referred to the first sample: x(t) = sqrt(2) Re{X exp(j w t)}, t = 0 at sample 0.
Least squares, unlike the DFT, needs no whole number of cycles in the record.
"""

from collections.abc import Sequence
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.signals.errors import SignalError

MIN_CYCLES = 1.5
"""Shortest record for a frequency estimate; below it sequences and offset are no longer told apart."""

MAX_FREQUENCY_OF_RATE = 0.45
"""Highest frequency modelled, fraction of the sampling rate; at half of it both sequences coincide."""

MIN_FUNDAMENTAL_SHARE = 0.5
"""Least share of the voltages' energy in the fundamental; noise and open inputs have far less."""

HARMONICS_OF_A_SUPPLY = (1, 3, 5, 7, 11, 13)
"""Orders modelled beside the fundamental while its frequency is sought, in both sequences."""

HIGHEST_RATE_HZ = 1e12
"""Beyond it a rate is a mistake, and angles lose their digits."""

FEWEST_SAMPLES = 8
LARGEST_PHASOR = 1e307
"""Close to what a double holds."""
SMALLEST_SIZE = 1e-300
"""Least amplitude of samples; below it they are nothing."""

USUAL_SEARCH_HZ = (20.0, 120.0)
"""Where no motor says better: the mains of 50 and 60 Hz, and supplies that are off by far."""

LARGEST_CONDITION = 1e4
"""Condition of the normal equations, up to which they lose four digits; beyond it they are not used."""

_MAX_ITERATIONS = 12
_CONVERGED_CYCLES = 1e-8
"""Change of the whole record's phase at which the iteration stops [cycles]; far below any noise."""


def harmonic_phasors(
    x: NDArray[np.float64], frequency_hz: float, sample_rate_hz: float, orders: Sequence[int] = (1,)
) -> NDArray[np.complex128]:
    """Fit phasors of the given harmonic orders, with a constant offset beside them, by least squares.

    Name every order that the waveform contains: over a part of a cycle an order left out leaks into the
    others.

    Parameters
    ----------
    x : ndarray, shape (..., n)
        Samples, all finite.
    frequency_hz : float
        Frequency of the fundamental [Hz].
    sample_rate_hz : float
        Sampling rate [Hz].
    orders : sequence of int, optional
        Harmonic orders.

    Returns
    -------
    ndarray of complex, shape (..., len(orders))
        Phasors, rms, in the unit of x.

    Raises
    ------
    SignalError
        If there are fewer samples than unknowns, values that are not finite, or a frequency that is not
        between 0 and the sampling rate.
    """
    n = x.shape[-1]
    if n < 1 + 2 * len(orders):
        raise SignalError(
            f"{n} samples cannot tell {len(orders)} phasors and an offset apart; "
            f"at least {1 + 2 * len(orders)} are needed"
        )
    if not np.isfinite(x).all():
        raise SignalError("phasors need finite samples; the waveform has missing values")
    if not 0.0 < frequency_hz <= sample_rate_hz < HIGHEST_RATE_HZ:
        raise SignalError(
            f"phasors need a frequency between 0 and the sampling rate; found {frequency_hz:g} Hz "
            f"at {sample_rate_hz:g} Hz"
        )
    size = _size(x)
    # Re{X e^jθ} sqrt(2) = sqrt(2) (Re X cos θ - Im X sin θ)
    theta = 2 * pi * frequency_hz / sample_rate_hz * np.arange(n, dtype=np.float64)
    vectors = sqrt(2) * _rotating_vectors(theta, np.asarray(orders))
    basis = np.concatenate([vectors.real, -vectors.imag, np.ones((1, n))])
    samples = (x / size).reshape(-1, n)
    gram = basis @ basis.T
    if np.linalg.cond(gram) < LARGEST_CONDITION:
        solution, rank = np.linalg.solve(gram, basis @ samples.T), len(basis)
    else:
        solution, _, rank, _ = np.linalg.lstsq(basis.T, samples.T)
    if rank < len(basis) or np.abs(solution).max(initial=0.0) > LARGEST_PHASOR / size:
        raise SignalError(
            f"orders {tuple(orders)} of {frequency_hz:g} Hz cannot be told apart in {n} samples "
            f"at {sample_rate_hz:g} Hz"
        )
    count = len(orders)
    phasors = size * (solution[:count] + 1j * solution[count : 2 * count])
    return np.asarray(phasors.T.reshape(*x.shape[:-1], count), dtype=np.complex128)


def fundamental_phasors(
    x: NDArray[np.float64], frequency_hz: float, sample_rate_hz: float
) -> NDArray[np.complex128]:
    """Fit the phasors of the fundamental by least squares; see `harmonic_phasors`.

    Parameters
    ----------
    x : ndarray, shape (..., n)
        Samples, all finite.
    frequency_hz : float
        Frequency of the fundamental [Hz].
    sample_rate_hz : float
        Sampling rate [Hz].

    Returns
    -------
    ndarray of complex, shape (...)
        Phasors, rms, in the unit of x.
    """
    return harmonic_phasors(x, frequency_hz, sample_rate_hz)[..., 0]


def fundamental_frequency(
    v_ab: NDArray[np.float64], sample_rate_hz: float, *, search_hz: tuple[float, float] = USUAL_SEARCH_HZ
) -> float:
    """Estimate the fundamental frequency of a three-phase supply.

    This is the four-parameter sine fit of IEEE Std 1057 [1]_, carried over to the space vector v_alpha + j
    v_beta = sum over k of C_k exp(j k w t). Both sequences of every order share one frequency, so that
    neither phase order, unbalance nor harmonics bias it. A Hann-windowed spectrum gives the start value;
    Gauss-Newton steps on w with the C_k projected out (variable projection) refine it. Under white noise it
    is the maximum-likelihood estimate.

    Parameters
    ----------
    v_ab : ndarray, shape (2, n)
        Voltages on power-invariant Clarke axes [V].
    sample_rate_hz : float
        Sampling rate [Hz].
    search_hz : tuple of float, optional
        Lowest and highest frequency that is looked for [Hz].

    Returns
    -------
    float
        Frequency [Hz].

    Raises
    ------
    SignalError
        If the record is shorter than MIN_CYCLES of the frequency found, has no dominant line within
        `search_hz`, or has missing values.

    References
    ----------
    .. [1] IEEE Std 1057, Standard for Digitizing Waveform Recorders.
    """
    if not np.isfinite(v_ab).all():
        raise SignalError("a frequency needs finite samples; the voltages have missing values")
    if not search_hz[0] < sample_rate_hz < HIGHEST_RATE_HZ:
        raise SignalError(
            f"a frequency needs a sampling rate above {search_hz[0]:g} Hz; found {sample_rate_hz:g} Hz"
        )
    v_ab = v_ab / _size(v_ab)
    space_vector = v_ab[0] + 1j * v_ab[1]
    coarse_hz = _spectral_peak(space_vector, sample_rate_hz, search_hz)
    n = space_vector.size
    if n * coarse_hz / sample_rate_hz < MIN_CYCLES:
        raise SignalError(
            f"{n} samples at {sample_rate_hz:g} Hz are {n * coarse_hz / sample_rate_hz:.1f} cycles of "
            f"{coarse_hz:.1f} Hz; at least {MIN_CYCLES:g} are needed for a frequency"
        )
    if coarse_hz > MAX_FREQUENCY_OF_RATE * sample_rate_hz:
        raise SignalError(
            f"{coarse_hz:.1f} Hz sampled at {sample_rate_hz:g} Hz; at least {1 / MAX_FREQUENCY_OF_RATE:.1f} "
            "samples a cycle are needed"
        )
    return _refine(space_vector, coarse_hz, sample_rate_hz, search_hz)


def _size(x: NDArray[np.float64]) -> float:
    """Greatest magnitude, by which samples are divided: their squares must not leave the range of numbers."""
    return max(float(np.abs(x).max(initial=0.0)), SMALLEST_SIZE)


def _spectral_peak(
    space_vector: NDArray[np.complex128], sample_rate_hz: float, search_hz: tuple[float, float]
) -> float:
    """Frequency of the strongest line in either sequence, to a few hundredths of a DFT bin [Hz]."""
    n = space_vector.size
    if n < FEWEST_SAMPLES:
        raise SignalError(f"{n} samples are too few for a frequency; at least {FEWEST_SAMPLES} are needed")
    size = 4 * max(n, 16)
    spectrum = np.fft.fft((space_vector - space_vector.mean()) * np.hanning(n), size)
    half = size // 2
    power = np.abs(spectrum[1:half]) ** 2 + np.abs(spectrum[: size - half : -1]) ** 2
    first, last = (round(f * size / sample_rate_hz) - 1 for f in search_hz)
    band = power[max(first, 0) : max(last, 0)]
    peak = int(np.argmax(band)) if band.size else 0
    if not 0 < peak < band.size - 1 or band[peak - 1 : peak + 2].min() <= 0:
        raise SignalError(
            f"no spectral line between {search_hz[0]:g} and {search_hz[1]:g} Hz: is the supply connected?"
        )
    left, centre, right = np.log(band[peak - 1 : peak + 2])
    offset = 0.5 * (left - right) / (left - 2 * centre + right)
    return float((max(first, 0) + peak + 1 + offset) * sample_rate_hz / size)


def _refine(
    space_vector: NDArray[np.complex128],
    frequency_hz: float,
    sample_rate_hz: float,
    search_hz: tuple[float, float],
) -> float:
    n = space_vector.size
    # Time from the middle of the record: the derivative is then nearly orthogonal to the amplitudes.
    angle = 2 * pi / sample_rate_hz * (np.arange(n, dtype=np.float64) - (n - 1) / 2)  # of 1 Hz
    orders = _orders_below_nyquist(frequency_hz, sample_rate_hz)
    for _ in range(_MAX_ITERATIONS):
        basis = _rotating_vectors(frequency_hz * angle, orders)
        gram = _inner_products(2 * pi * frequency_hz / sample_rate_hz, n, orders)
        amplitudes = np.linalg.solve(gram, _products(basis, space_vector))
        slope = 1j * angle * ((orders * amplitudes) @ basis)
        # What the fit leaves has no part along the basis, nor has the gradient: products alone are needed.
        along = _products(basis, slope)
        left = np.vdot(slope, space_vector) - np.vdot(along, amplitudes)
        steepness = np.vdot(slope, slope) - np.vdot(along, np.linalg.solve(gram, along))
        step_hz = float(left.real / steepness.real)
        frequency_hz += step_hz
        if not search_hz[0] <= frequency_hz <= search_hz[1]:
            break
        if abs(step_hz) * n / sample_rate_hz < _CONVERGED_CYCLES:
            _check_dominant(frequency_hz, amplitudes[np.abs(orders) == 1], space_vector)
            return frequency_hz
    raise SignalError(
        f"the fundamental between {search_hz[0]:g} and {search_hz[1]:g} Hz does not settle: "
        "the voltages are not periodic at one frequency"
    )


def _check_dominant(
    frequency_hz: float, fundamental: NDArray[np.complex128], space_vector: NDArray[np.complex128]
) -> None:
    power = float(np.mean(np.abs(space_vector - space_vector.mean()) ** 2))
    share = float(np.sum(np.abs(fundamental) ** 2)) / power
    if share < MIN_FUNDAMENTAL_SHARE:
        raise SignalError(
            f"the strongest line, {frequency_hz:.2f} Hz, holds {share:.0%} of the voltages' energy; "
            f"a supply's fundamental holds at least {MIN_FUNDAMENTAL_SHARE:.0%}"
        )


def _products(basis: NDArray[np.complex128], x: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Inner products of the basis (orders, n) with x (n)."""
    return np.asarray((basis @ x.conj()).conj())


def _orders_below_nyquist(frequency_hz: float, sample_rate_hz: float) -> NDArray[np.int64]:
    """Signed orders of the space vector that the sampling resolves: 0, +-1, +-3, ..."""
    usable = [
        k
        for k in HARMONICS_OF_A_SUPPLY
        if k == 1 or k * frequency_hz < MAX_FREQUENCY_OF_RATE * sample_rate_hz
    ]
    return np.array([0, *usable, *(-k for k in usable)], dtype=np.int64)


def _rotating_vectors(theta: NDArray[np.float64], orders: NDArray[np.int64]) -> NDArray[np.complex128]:
    """exp(j k theta) of each order k, shape (orders, n)."""
    once = np.exp(1j * theta)
    vectors = np.empty((orders.size, theta.size), dtype=np.complex128)
    power = np.ones_like(once)
    for order in range(int(orders.max()) + 1):
        for row in np.flatnonzero(np.abs(orders) == order):
            vectors[row] = power.conj() if orders[row] < 0 else power
        power *= once
    return vectors


def _inner_products(step: float, n: int, orders: NDArray[np.int64]) -> NDArray[np.float64]:
    """Gram matrix of the rotating vectors over n samples centred on 0: Dirichlet kernels, hence real."""
    half_angle = (orders[:, None] - orders) * step / 2
    same = half_angle == 0
    sine = np.where(same, 1.0, np.sin(half_angle))
    return np.where(same, float(n), np.sin(n * half_angle) / sine)
