"""Unbalance, derating and distortion as the standards define them."""

from collections.abc import Sequence
from math import hypot, sqrt

import numpy as np

DERATING = ((0.0, 1.0), (0.01, 1.0), (0.02, 0.95), (0.03, 0.88), (0.04, 0.82), (0.05, 0.75))
"""Unbalance and the factor of rated power that it leaves, read off NEMA MG-1, figure 14-1.

The standard prints a curve without numbers. Tables made from it differ by 0.01 from 2.5 % on.
"""
LARGEST_UNBALANCE = DERATING[-1][0]
"""Above it NEMA MG-1, 14.36, advises against running a motor."""
FIRST_ORDER_OF_HVF = 5


def nema_unbalance(line_voltages: Sequence[float]) -> float:
    """Return the unbalance of line voltages (NEMA MG-1, 14.36).

    Parameters
    ----------
    line_voltages : sequence of float
        Rms values of the three line voltages, in any one unit, with a mean above zero.

    Returns
    -------
    float
        Largest deviation from the mean, over the mean.
    """
    mean = sum(line_voltages) / len(line_voltages)
    return max(abs(one - mean) for one in line_voltages) / mean


def unbalance_of_magnitudes(magnitudes: Sequence[float]) -> float:
    """Return negative over positive sequence of three phasors that add up to zero (IEC 61000-4-30, 5.7).

    Line voltages do, and the line currents of a motor, which has no neutral: so three magnitudes tell their
    triangle. Errors of measuring make even ones a little uneven, never more even.

    Parameters
    ----------
    magnitudes : sequence of float
        Rms values, in any one unit, not all zero.

    Returns
    -------
    float
        Unbalance, 0 to 1; 1 also where no triangle has such sides.
    """
    squares = [one**2 for one in magnitudes]
    beta = sum(one**2 for one in squares) / sum(squares) ** 2
    root = sqrt(max(0.0, 3.0 - 6.0 * beta))
    return sqrt(max(0.0, 1.0 - root) / (1.0 + root))


def derating(unbalance: float) -> float | None:
    """Return what unbalance leaves of the rated power (NEMA MG-1, figure 14-1).

    Parameters
    ----------
    unbalance : float
        Unbalance by NEMA's definition.

    Returns
    -------
    float or None
        Factor of the rated power; None above 5 %, where NEMA gives none.
    """
    if unbalance > LARGEST_UNBALANCE:
        return None
    at, factors = zip(*DERATING, strict=True)
    return float(np.interp(unbalance, at, factors))


def total_harmonic_distortion(harmonics: Sequence[float]) -> float:
    """Return the total harmonic distortion (IEC 61000-4-7, 3.3.2), of the orders that are given.

    Parameters
    ----------
    harmonics : sequence of float
        Rms values of orders 1, 2, 3 ..., over that of order 1.

    Returns
    -------
    float
        Root of the sum of squares from order 2 on.
    """
    return hypot(*harmonics[1:])


def harmonic_voltage_factor(harmonics: Sequence[float]) -> float:
    """Return the harmonic voltage factor HVF (NEMA MG-1, 30.1.2.1), of the orders that are given.

    HVF = sqrt(sum of V_n^2 / n) over n = 5, 7, 11, 13 ...: odd orders without multiples of 3.

    Parameters
    ----------
    harmonics : sequence of float
        Rms voltages of orders 1, 2, 3 ..., over that of order 1.

    Returns
    -------
    float
        The factor. IEC 60034-1, 7.2.1.1, which counts even orders too, allows 0.02 (0.03 for design N).
    """
    return sqrt(
        sum(
            share**2 / order
            for order, share in enumerate(harmonics, start=1)
            if order >= FIRST_ORDER_OF_HVF and order % 2 and order % 3
        )
    )
