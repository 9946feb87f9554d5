"""When the motor was switched on: the instant its current leaves zero, and the voltage where it did."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.ndimage import uniform_filter1d

from core.machines.base import Array

RISE_FROM, RISE_TO = 0.12, 0.5
"""Shares of the greatest current between which its first rise is close to a straight line."""
QUIET = 0.12
"""Share of the greatest current below which a motor counts as switched off."""
SMOOTHED_CYCLES, SUSTAINED_CYCLES = 0.04, 0.12
"""Noise is averaged over the one, a rise must last for the other."""
ENERGISED = 0.5
"""Share of the usual voltage above which a terminal is live."""
FEWEST_QUIET_CYCLES = 0.25
"""Cycles of the record before the start that an offset of the current channels is seen in."""


def current_onset(current_ab: Array, samples_per_cycle: float) -> float | None:
    """Find the instant at which the current begins to rise.

    The space vector of a motor at rest rises as |1 - exp(j w t)|: nearly a straight line for a quarter of a
    cycle, continued here back to zero.

    Parameters
    ----------
    current_ab : ndarray, shape (2, n)
        Currents on power-invariant Clarke axes [A].
    samples_per_cycle : float
        Samples in one cycle of the supply.

    Returns
    -------
    float or None
        Instant in samples, fractional; None where the record has none.
    """
    smooth = uniform_filter1d(current_ab, max(1, round(SMOOTHED_CYCLES * samples_per_cycle)), axis=1)
    length = np.hypot(smooth[0], smooth[1])
    greatest = float(np.quantile(length, 1.0 - min(0.5, 2.0 / length.size)))
    if greatest <= 0.0 or length[0] > QUIET * greatest:
        return None
    # The current must stay for a while, so that a spike does not count as a start.
    sustained = max(2, round(SUSTAINED_CYCLES * samples_per_cycle))
    above = sliding_window_view(length >= RISE_FROM * greatest, sustained).all(axis=1)
    begins = np.flatnonzero(above)
    if not begins.size:
        return None
    begin = int(begins[0])
    reach = min(length.size, begin + max(2, int(0.25 * samples_per_cycle)))
    steep = np.flatnonzero(length[begin:reach] > RISE_TO * greatest)
    end = max(begin + 2, begin + int(steep[0]) if steep.size else reach)
    k = np.arange(begin, end)
    slope, intercept = np.polyfit(k, length[begin:end], 1)
    if slope <= 0.0:
        return float(begin)
    return float(np.clip(-intercept / slope, begin - 0.25 * samples_per_cycle, begin))


def voltage_onset(voltage_ab: Array) -> int:
    """Find the first sample at which the terminals are live.

    Parameters
    ----------
    voltage_ab : ndarray, shape (2, n)
        Voltages on power-invariant Clarke axes [V].

    Returns
    -------
    int
        The sample; 0 where they were live from the beginning.
    """
    length = np.hypot(voltage_ab[0], voltage_ab[1])
    usual = float(np.quantile(length, 0.9))
    return int(np.argmax(length >= ENERGISED * usual)) if usual > 0.0 else 0


def quiet_offset(current_abc: Array, onset: float, samples_per_cycle: float) -> Array:
    """Return what the current channels show while no current flows.

    Parameters
    ----------
    current_abc : ndarray, shape (3, n)
        Line currents of terminals a, b, c [A].
    onset : float
        Sample at which the current begins.
    samples_per_cycle : float
        Samples in one cycle of the supply.

    Returns
    -------
    ndarray, shape (3, 1)
        Offsets [A]; zero where that time is too short.
    """
    quiet = int(onset - 0.05 * samples_per_cycle)
    if quiet < FEWEST_QUIET_CYCLES * samples_per_cycle:
        return np.zeros((current_abc.shape[0], 1))
    return np.asarray(current_abc[:, :quiet].mean(axis=1, keepdims=True))
