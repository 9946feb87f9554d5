"""The speed at which a comb of lines fits a piece of a current, how sure it is, and whether it is seen."""

from dataclasses import dataclass
from math import hypot, inf, sqrt
from typing import Final

import numpy as np

from core.machines.base import Array
from core.speed.comb import Comb
from core.speed.residue import Residue

HIGHEST_SLIP: Final = 0.08
"""Greatest slip that is looked at; cage motors of some hundred watts reach it at full load."""
ALL_SLIPS: Final = (-inf, inf)
STEPS_A_BIN: Final = 8
"""Steps of the search in which the fastest line moves by a bin."""
SEPARATE_BINS: Final = 2.0
"""Bins by which the fastest line moves from one peak to a separate one."""
SEEN_MARGIN: Final = 15.0
"""By how much the best speed beats every separate one where the speed counts as seen [nats]."""
UNEVEN: Final = 5e-5
"""Standard deviation of what a speed that moves within a piece adds, over the speed."""


@dataclass(frozen=True, slots=True)
class Peak:
    """The best speed of one piece.

    Parameters
    ----------
    rotation_hz : float
        Speed of the shaft [turns/s].
    deviation_hz : float
        Its standard deviation [turns/s]; infinite where the score has no peak.
    margin : float
        By how much it beats every separate speed [nats].
    """

    rotation_hz: float
    deviation_hz: float
    margin: float

    @property
    def is_seen(self) -> bool:
        """Whether the speed is seen, given the number of bars."""
        return self.margin >= SEEN_MARGIN and self.deviation_hz < inf


def speeds(residue: Residue, pole_pairs: int, most_turns: int) -> Array:
    """Return the speeds that are looked at.

    Parameters
    ----------
    residue : Residue
        The piece.
    pole_pairs : int
        Pole pairs of the motor.
    most_turns : int
        Largest k of the lines.

    Returns
    -------
    ndarray, shape (speeds,)
        Speeds [turns/s].
    """
    synchronous_hz = residue.frequency_hz / pole_pairs
    step_hz = 1.0 / (STEPS_A_BIN * residue.duration_s * most_turns)
    return np.arange((1.0 - HIGHEST_SLIP) * synchronous_hz, synchronous_hz + step_hz, step_hz)


def find_peak(
    residue: Residue, comb: Comb, pole_pairs: int, possible_slips: tuple[float, float] = ALL_SLIPS
) -> Peak:
    """Look for the speed of a piece.

    Parameters
    ----------
    residue : Residue
        The piece.
    comb : Comb
        Lines of the motor.
    pole_pairs : int
        Its pole pairs.
    possible_slips : tuple of float, optional
        Least and largest slip that the motor may have. The best speed is looked for among all; where it is a
        possible one, it has to beat the possible ones alone.

    Returns
    -------
    Peak
        The best speed. Whether the number of bars is right it cannot tell: R and R +- 2p place their slot
        lines on the same frequencies with the slip scaled by R over the other.
    """
    rotation_hz = speeds(residue, pole_pairs, comb.most_turns)
    score = comb.score(residue, rotation_hz)
    best = int(np.argmax(score))
    separate_hz = SEPARATE_BINS / (residue.duration_s * comb.most_turns)
    slips = 1.0 - pole_pairs * rotation_hz / residue.frequency_hz
    apart = np.abs(rotation_hz - rotation_hz[best]) > separate_hz
    rivals = apart & (slips >= possible_slips[0]) & (slips <= possible_slips[1])
    margin = float(score[best] - score[rivals if rivals.any() else apart].max())
    # A line that a harmonic hides at its true place shows beside it, and would hold the speed there.
    near_hz = rotation_hz[np.abs(rotation_hz - rotation_hz[best]) <= separate_hz]
    near = comb.score(residue, near_hz, shown_at_hz=float(rotation_hz[best]))
    top = min(max(int(np.argmax(near)), 1), near.size - 2)
    before, at, after = near[top - 1 : top + 2].tolist()
    bend = before - 2.0 * at + after
    if bend >= 0.0:
        return Peak(float(rotation_hz[best]), inf, margin)
    step_hz = float(rotation_hz[1] - rotation_hz[0])
    found_hz = float(near_hz[top]) + min(max(0.5 * (before - after) / bend, -1.0), 1.0) * step_hz
    return Peak(found_hz, hypot(step_hz / sqrt(-bend), UNEVEN * found_hz), margin)
