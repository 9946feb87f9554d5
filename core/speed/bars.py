"""How well each number of bars explains a piece of a current: the evidence from which the bars are learnt.

The slot lines +-R and the eccentricity lines +-1 alone are weighed. Those of R +- 1 would speak for R + 1 and
R - 1 as well, whose combs they are in the middle of. All numbers of bars share the speeds that are looked at,
so that a search over all of them costs little.

R and R +- 2p place their slot lines on the same frequencies with the slip scaled. Only the eccentricity lines
tell them apart, by a few hundredths of a hertz: that takes long pieces, and many.
"""

from typing import Final

import numpy as np

from core.machines.base import Array
from core.speed.comb import (
    ECCENTRIC_PRESENT,
    HIGHEST_ORDER,
    HIGHEST_ORDER_OF_ECCENTRICITY,
    SLOT_PRESENT,
    gain,
    orders,
)
from core.speed.residue import Residue
from core.speed.search import speeds

FEWEST_BARS, MOST_BARS = 16, 120
"""Numbers of bars that are looked at where the motor's file gives none."""
BARS: Final = np.arange(FEWEST_BARS, MOST_BARS + 1)


def evidence_of_bars(residue: Residue, pole_pairs: int) -> Array:
    """Weigh all numbers of bars by one piece, over all speeds.

    Parameters
    ----------
    residue : Residue
        The piece.
    pole_pairs : int
        Pole pairs of the motor.

    Returns
    -------
    ndarray, shape (bars,)
        Log of the mean likelihood ratio over the speeds, for each of `BARS` [nats].
    """
    rotation_hz = speeds(residue, pole_pairs, MOST_BARS)
    eccentric = _of_turns(
        residue, rotation_hz, 1, HIGHEST_ORDER_OF_ECCENTRICITY, gain(residue.excess, ECCENTRIC_PRESENT)
    )
    gains = gain(residue.excess, SLOT_PRESENT)
    evidence = np.empty(BARS.size)
    for number, bars in enumerate(BARS.tolist()):
        score = eccentric + _of_turns(residue, rotation_hz, bars, HIGHEST_ORDER, gains)
        most = float(score.max())
        evidence[number] = most + np.log(np.exp(score - most).mean())
    return evidence


def _of_turns(residue: Residue, rotation_hz: Array, turns: int, highest_order: int, gains: Array) -> Array:
    """Return what the lines of +-k gain at each speed; the spectrum's nearest point stands for the place."""
    order = np.array(orders(highest_order))[:, np.newaxis] * residue.frequency_hz
    frequency_hz = np.concatenate([order + turns * rotation_hz, order - turns * rotation_hz])
    place = np.rint(frequency_hz / residue.step_hz).astype(np.int64) % gains.size
    return np.asarray(np.where(residue.shows(frequency_hz), gains[place], 0.0).sum(axis=0))
