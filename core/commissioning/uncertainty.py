"""Covariance of the estimates, from the spectrum of the residuals.

    cov = inv(J'J) (J' G J) inv(J'J),   G the covariance of the noise

G is taken from the smoothed spectrum of the residuals (Whittle's likelihood; White, Econometrica 48(4), 1980,
for the form), because noise of the voltages reaches the residuals through the machine and is far from white.
The sums over cycles of core.diagnosis.refinement are no alternative, because a few cycles of a start hold
nearly all its information.
"""

from collections.abc import Sequence
from math import sqrt

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.stats import t as student_t

from core.commissioning.fit import Fit, Records
from core.commissioning.start import Start
from core.machines.base import Array

CONFIDENCE = 0.95
SMOOTHED_HZ = 2.0
FEWEST_BINS = 3
"""Least number of bins on either side of a frequency over which the spectrum is averaged."""
LEAST_INFORMATION = 1e-14
"""Share of the largest eigenvalue of the information below which an eigenvalue is rounding error."""
MISFIT_CYCLES, BESIDE_CYCLES = 0.3, 0.9
"""Distances from the supply's frequency, over it, within which errors of the model are, and noise alone."""
MEDIAN_OF_POWER = 0.84
"""Median over mean of the power of noise in two channels at a frequency: of chi squared with four degrees."""
MOST_OF_NOISE = 3.0
"""Power that noise may have near the supply's frequency, over that beside it: noise of voltages is uneven."""
COHERENT_ERROR = 0.005
"""Error of model and channels that repeats every cycle, as a share of the current."""


def information_inverse(fit: Fit) -> Array:
    """Return inv(J'J) of the free entries; finite even where it is singular.

    Parameters
    ----------
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    ndarray, shape (free, free)
        The inverse.
    """
    free = int(fit.free.sum())
    flat = [one[fit.free].reshape(free, one[0].size) for one in fit.jacobians]
    information = sum((one @ one.T for one in flat), np.zeros((free, free)))
    values, vectors = np.linalg.eigh(information)
    kept = np.maximum(values, max(LEAST_INFORMATION * float(values.max(initial=0.0)), 1e-300))
    return np.asarray((vectors / kept) @ vectors.T)


def noise_covariance(records: Records, fit: Fit) -> Array:
    """Return the covariance of the free entries by the residuals' own spectrum.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    ndarray, shape (free, free)
        The covariance.
    """
    bread = information_inverse(fit)
    filling = np.zeros_like(bread)
    for start, residual, whole in zip(records.starts, fit.residuals, fit.jacobians, strict=True):
        slope = np.fft.rfft(whole[fit.free], axis=2)
        # The fit of p unknowns to 2 n values removes the leverage from white noise at each frequency.
        n = residual.shape[1]
        leverage = np.einsum("iak,ij,jak->k", slope.conj(), bread, slope).real / n
        spectrum = _spectrum(residual, leverage, start.sample_rate_hz)
        filling += np.einsum("iak,jak,k->ij", slope, slope.conj(), _sides(n) * spectrum).real / n
    return bread @ filling @ bread


def preference(records: Records, first: Fit, second: Fit) -> float:
    """Return by how many standard deviations one fit's residuals are less than another's [1]_.

    The noise is taken to be as coloured as the first fit's residuals.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    first, second : Fit
        The fits.

    Returns
    -------
    float
        Standard deviations.

    References
    ----------
    .. [1] Vuong's test of models that do not contain each other, Econometrica 57(2), 1989.
    """
    gain, variance = 0.0, 0.0
    for start, ours, theirs in zip(records.starts, first.residuals, second.residuals, strict=True):
        n = ours.shape[1]
        gain += float((theirs**2).sum() - (ours**2).sum())
        apart = (np.abs(np.fft.rfft(ours - theirs, axis=1)) ** 2).sum(axis=0) / n
        spectrum = _spectrum(ours, np.zeros(apart.size), start.sample_rate_hz)
        variance += 4.0 * float((_sides(n) * spectrum * apart).sum())
    return gain / sqrt(variance) if variance > 0.0 else 0.0


def _spectrum(residual: Array, leverage: Array, sample_rate_hz: float) -> Array:
    """Power of one axis of the noise at each frequency of its transform, smoothed, (n / 2 + 1,)."""
    n = residual.shape[1]
    power = (np.abs(np.fft.rfft(residual, axis=1)) ** 2).sum(axis=0) / n
    size = min(2 * _bins(n, sample_rate_hz) + 1, power.size)
    left = uniform_filter1d(2.0 - leverage, size, mode="reflect")
    return np.asarray(uniform_filter1d(power, size, mode="reflect") / np.maximum(left, 0.1))


def _sides(n: int) -> Array:
    """How often each frequency of a real transform stands in the whole one, (n / 2 + 1,)."""
    sides = np.full(n // 2 + 1, 2.0)
    sides[0] = 1.0
    if n % 2 == 0:
        sides[-1] = 1.0
    return sides


def _bins(n: int, sample_rate_hz: float) -> int:
    return max(FEWEST_BINS, round(SMOOTHED_HZ * n / sample_rate_hz))


def inherited_covariance(records: Records, fit: Fit) -> Array:
    """Return the covariance of the free entries from doubt about those that are held.

    This is Schmidt's consider analysis.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    ndarray, shape (free, free)
        The covariance.
    """
    doubt = records.coordinates.doubts()
    bread = information_inverse(fit)
    held = ~fit.free
    mixed = np.zeros((len(bread), int(held.sum())))
    for whole in fit.jacobians:
        mixed += np.einsum("iak,jak->ij", whole[fit.free], whole[held])
    sensitivity = bread @ mixed
    return np.asarray((sensitivity * doubt[held] ** 2) @ sensitivity.T)


def coherent_covariance(records: Records, fit: Fit) -> Array:
    """Return the covariance of the free entries if the model were off alike through every cycle.

    The model is taken to be off by COHERENT_ERROR of the current. This decides whether a record tells a
    parameter, however little noise it has.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    ndarray, shape (free, free)
        The covariance.
    """
    return _covariance(
        fit,
        [
            COHERENT_ERROR**2 * float(np.mean(start.measured_ab**2)) * start.sample_rate_hz * start.cycle_s
            for start in records.starts
        ],
    )


def misfit_covariance(records: Records, fit: Fit) -> Array:
    """Return the covariance of the free entries from what the model leaves of the currents beyond noise.

    An error of the model changes slowly beside the supply, so that it stands near the supply's frequency, and
    noise does not. What of it the unknowns took up is not seen; as much is taken for each of them as is left.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    ndarray, shape (free, free)
        The covariance.
    """
    pairs = zip(records.starts, fit.residuals, strict=True)
    return _covariance(fit, [misfit(start, residual) for start, residual in pairs])


def _covariance(fit: Fit, variances: Sequence[float]) -> Array:
    """Return the covariance of the free entries by errors of the currents, each start's with its variance."""
    bread = information_inverse(fit)
    filling = np.zeros_like(bread)
    for variance, whole in zip(variances, fit.jacobians, strict=True):
        jacobian = whole[fit.free].reshape(len(bread), whole[0].size)  # none may be free
        filling += variance * (jacobian @ jacobian.T)
    return bread @ filling @ bread


def misfit(start: Start, residual: Array) -> float:
    """Return what the model leaves of the currents beyond noise, near the supply's frequency.

    Parameters
    ----------
    start : Start
        The start.
    residual : ndarray, shape (2, compared)
        What the model leaves of its currents [A].

    Returns
    -------
    float
        Its sum of squares [A^2].
    """
    n = residual.shape[1]
    power = (np.abs(np.fft.rfft(residual, axis=1)) ** 2).sum(axis=0) * _sides(n) / n
    away = np.abs(np.fft.rfftfreq(n, 1.0 / start.sample_rate_hz) - start.frequency_hz)
    near = away <= MISFIT_CYCLES * start.frequency_hz
    beside = ~near & (away <= BESIDE_CYCLES * start.frequency_hz)
    noise = float(np.median(power[beside])) / MEDIAN_OF_POWER
    return max(float(power[near].sum()) - MOST_OF_NOISE * noise * float(near.sum()), 0.0)


def quantile(records: Records, fit: Fit) -> float:
    """Return the half width of a 95 % interval in standard errors.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    fit : Fit
        Coordinates at their best.

    Returns
    -------
    float
        Standard errors.
    """
    bins = min(
        _bins(residual.shape[1], start.sample_rate_hz)
        for start, residual in zip(records.starts, fit.residuals, strict=True)
    )
    freedom = max(4 * (2 * bins + 1) - int(fit.free.sum()), 4)
    return float(student_t.ppf(0.5 + CONFIDENCE / 2.0, freedom))
