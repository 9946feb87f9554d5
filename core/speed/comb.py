"""The lines that a turning rotor puts into the stator current, and how likely each is to be seen.

With R bars, p pole pairs, the supply at f and the shaft at f_r = f (1 - s) / p turns a second, lines stand at

    h f + k f_r,   h odd,   k = +-1, +-R, +-(R +- 1)

those of R from the slots, those of R +- 1 the same moved by a turning eccentricity, those of 1 from the
eccentricity alone [1]_. Even h would move the speed by f / R. A line is present with a probability, and its
power is then exponential with a larger mean than the noise has.

References
----------
.. [1] Nandi, Toliyat, Li, "Condition monitoring and fault diagnosis of electrical motors - a review",
   IEEE Trans. Energy Convers. 20 (2005) 719-729.
"""

from dataclasses import dataclass
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.speed.residue import Residue

HIGHEST_ORDER: Final = 7
"""Highest h of the lines of slots."""
HIGHEST_ORDER_OF_ECCENTRICITY: Final = 9
SLOT_PRESENT, ECCENTRIC_PRESENT, TURNING_PRESENT = 0.3, 0.15, 0.02
"""Probabilities of lines of R, of 1 and of R +- 1, of which nothing is known. Those of R are the likeliest:
otherwise a comb would lock on them with its neighbours, some 40 rpm beside."""
STRENGTH: Final = 20.0
"""Power of a line over the noise where nothing is known of it."""


@dataclass(frozen=True, slots=True, eq=False)
class Comb:
    """Lines of one number of bars.

    Parameters
    ----------
    bars : int
        Number of rotor bars, R.
    order, turns : ndarray of int, shape (lines,)
        h and k of each line.
    present : ndarray, shape (lines,)
        Probability that it is there.
    strength : ndarray, shape (lines,)
        Its mean power over the noise where it is.
    """

    bars: int
    order: NDArray[np.int64]
    turns: NDArray[np.int64]
    present: Array
    strength: Array

    @classmethod
    def untrained(cls, bars: int) -> Self:
        """Return the comb of a motor of which nothing but its bars is known.

        Parameters
        ----------
        bars : int
            Number of rotor bars.

        Returns
        -------
        Comb
            All lines, each as likely as those of its kind.
        """
        pairs = [
            (h, k)
            for k in (-bars - 1, -bars, 1 - bars, -1, 1, bars - 1, bars, bars + 1)
            for h in orders(HIGHEST_ORDER if abs(k) > 1 else HIGHEST_ORDER_OF_ECCENTRICITY)
        ]
        order, turns = np.array(pairs).T
        of_slots, of_shaft = np.abs(turns) == bars, np.abs(turns) == 1
        present = np.where(of_slots, SLOT_PRESENT, np.where(of_shaft, ECCENTRIC_PRESENT, TURNING_PRESENT))
        return cls(bars, order, turns, present, np.full(order.size, STRENGTH))

    @property
    def most_turns(self) -> int:
        """Largest k."""
        return self.bars + 1

    def frequency_hz(self, residue: Residue, rotation_hz: Array) -> Array:
        """Return where the lines stand at speeds of the shaft.

        Parameters
        ----------
        residue : Residue
            The piece, with the supply's frequency.
        rotation_hz : ndarray, shape (speeds,)
            Speeds [turns/s].

        Returns
        -------
        ndarray, shape (lines, speeds)
            Frequencies [Hz].
        """
        return np.asarray(
            self.order[:, np.newaxis] * residue.frequency_hz + self.turns[:, np.newaxis] * rotation_hz
        )

    def share_shown(self, residue: Residue, rotation_hz: float) -> float:
        """Return how many of the slots' lines that are expected lie where they could be seen.

        Parameters
        ----------
        residue : Residue
            The piece.
        rotation_hz : float
            Speed [turns/s].

        Returns
        -------
        float
            Share, each line counting by its probability.
        """
        expected = np.where(np.abs(self.turns) > 1, self.present, 0.0)
        shown = residue.shows(self.frequency_hz(residue, np.array([rotation_hz]))[:, 0])
        # Of one current the lines below zero repeat others.
        whole = expected.sum() * (0.5 if residue.is_one_current else 1.0)
        return float(expected[shown].sum() / whole)

    def score(self, residue: Residue, rotation_hz: Array, *, shown_at_hz: float | None = None) -> Array:
        """Return how much better than noise alone the comb explains a piece.

        Parameters
        ----------
        residue : Residue
            The piece.
        rotation_hz : ndarray, shape (speeds,)
            Speeds [turns/s].
        shown_at_hz : float or None, optional
            A speed; the lines that could be seen there count, and no others. Otherwise lines come and go with
            the speed, as they leave or meet a harmonic of the supply [turns/s].

        Returns
        -------
        ndarray, shape (speeds,)
            Log likelihood ratio [nats].
        """
        frequency_hz = self.frequency_hz(residue, rotation_hz)
        excess = residue.at(frequency_hz)
        gained = gain(excess, self.present[:, np.newaxis], self.strength[:, np.newaxis])
        at_one = np.array([shown_at_hz or 0.0])
        shown = residue.shows(frequency_hz if shown_at_hz is None else self.frequency_hz(residue, at_one))
        return np.asarray(np.where(shown, gained, 0.0).sum(axis=0))


def orders(highest: int) -> range:
    """Return the odd orders up to one, of both sequences.

    Parameters
    ----------
    highest : int
        The highest order, odd.

    Returns
    -------
    range
        The orders.
    """
    return range(-highest, highest + 1, 2)


def gain(excess: Array, present: Array | float, strength: Array | float = STRENGTH) -> Array:
    """Return how much better than noise a line explains what stands at its place.

    Parameters
    ----------
    excess : ndarray
        Power over the noise.
    present, strength : ndarray or float
        Probability of the line, and its mean power over the noise.

    Returns
    -------
    ndarray
        Log likelihood ratio [nats].
    """
    there = present / (1.0 + strength) * np.exp(excess * strength / (1.0 + strength))
    return np.asarray(np.log(1.0 - present + there))
