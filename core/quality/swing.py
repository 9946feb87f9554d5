"""A load that swings regularly: a line at each side of the supply's, and no change of the operation.

Belts, compressors and broken rotor bars move the current about a mean that stays. A load that is switched, or
that rises, moves the mean.
"""

from math import ceil

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array

Course = NDArray[np.complex128]

FEWEST_TURNS = 1.5
"""Least number of periods of a swing; fewer cannot be told from a load that changes."""
FASTEST_OVER_SUPPLY = 0.7
"""Highest frequency of a swing, over the supply's: means over a cycle leave nothing of one as fast."""
MOST_LEFT = 0.7
"""Most that a swing leaves of the deviations from the mean, rms: it leaves more of a step or a ramp."""
POINTS_A_TURN = 16


def without_swing(course: Course | Array, step_s: float, frequency_hz: float) -> Course:
    """Take the strongest regular swing off the course of a current.

    Its frequency is that of the strongest pair of lines. These are fitted by least squares, with a constant.

    Parameters
    ----------
    course : ndarray, shape (n,)
        Space vector in the frame of the supply, or its magnitude.
    step_s : float
        Time between two of its values [s].
    frequency_hz : float
        Supply frequency [Hz].

    Returns
    -------
    ndarray of complex, shape (n,)
        The course without the swing; as it is where there is none, or it is too short for one.
    """
    n = course.size
    fastest = FASTEST_OVER_SUPPLY * frequency_hz * n * step_s  # in turns, as FEWEST_TURNS
    turns = np.arange(ceil(POINTS_A_TURN * FEWEST_TURNS), int(POINTS_A_TURN * fastest) + 1)
    if turns.size == 0:
        return np.asarray(course, dtype=np.complex128)
    spectrum = np.abs(np.fft.fft(course - course.mean(), POINTS_A_TURN * n)) ** 2
    strongest = turns[np.argmax(spectrum[turns] + spectrum[-turns])] / POINTS_A_TURN
    line = np.exp(2j * np.pi * strongest / n * np.arange(n))
    basis = np.stack([np.ones(n), line, line.conj()], axis=1)
    fitted = np.linalg.lstsq(basis, course.astype(np.complex128))[0]
    left = course - basis[:, 1:] @ fitted[1:]
    is_swing = left.std() <= MOST_LEFT * course.std()
    return np.asarray(left if is_swing else course, dtype=np.complex128)


def swing_period_s(course: Course | Array, step_s: float, frequency_hz: float) -> float | None:
    """Return the period of the strongest swing, where the course turns back at all.

    Parameters
    ----------
    course : ndarray, shape (n,)
        Space vector in the frame of the supply, or its magnitude.
    step_s : float
        Time between two of its values [s].
    frequency_hz : float
        Supply frequency [Hz].

    Returns
    -------
    float or None
        The period, twice the record's length at most [s]; None of a course that only rises or falls.
    """
    size = np.abs(course - course.mean())
    ends = abs(complex(course[-1]) - complex(course[0]))
    if ends > size.max():
        return None
    n = course.size
    spectrum = np.abs(np.fft.fft(course - course.mean(), POINTS_A_TURN * n)) ** 2
    turns = np.arange(
        POINTS_A_TURN // 2, max(int(POINTS_A_TURN * FASTEST_OVER_SUPPLY * frequency_hz * n * step_s), 9)
    )
    strongest = turns[np.argmax(spectrum[turns] + spectrum[-turns])] / POINTS_A_TURN
    return float(n * step_s / strongest)
