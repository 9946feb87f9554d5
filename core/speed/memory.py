"""What the records of one motor have told of its rotor's lines: how many bars, and which lines are there.

The bars follow from the evidence of the latest records together. With the bars known, each record in which
the speed is seen tells which of the comb's lines stand out at that speed (expectation and maximisation, a
step a record): from then on those count, and the others do not.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import Any, Final, Self

import numpy as np

from core.machines.base import Array
from core.speed.bars import BARS
from core.speed.comb import STRENGTH, Comb
from core.speed.residue import Residue

LONGEST: Final = 24
"""Records whose evidence is kept; more would not move it."""
FORGETTING: Final = 400.0
"""Pieces after which what was learnt of the lines counts half at most."""
APART: Final = 15.0
"""By how much the evidence for the bars has to beat that for others [nats]."""
APART_DEVIATIONS: Final = 3.0
"""The same over its own scatter from record to record."""
PRIOR_PIECES: Final = 2.0
"""Pieces that the untrained comb counts as."""
LEAST_PRESENT, MOST_PRESENT = 1e-3, 0.99
LEAST_STRENGTH, MOST_STRENGTH = 1.0, 1000.0


@dataclass(slots=True, eq=False)
class LineMemory:
    """What is known of the lines of one motor.

    Parameters
    ----------
    given_bars : int or None, optional
        Number of bars that the motor's file gives; the evidence is not needed then.
    evidence : list of ndarray
        Log likelihood ratio of each of `BARS` in the latest records.
    bars : int or None, optional
        Number of bars that the lines below are of.
    shown, present, power : ndarray, shape (lines,)
        Pieces in which each line could be seen, sum of the probabilities that it was there, and of those
        times its power over the noise.
    """

    given_bars: int | None = None
    evidence: list[Array] = field(default_factory=list)
    bars: int | None = None
    shown: Array = field(default_factory=lambda: np.zeros(0))
    present: Array = field(default_factory=lambda: np.zeros(0))
    power: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def candidates(self) -> tuple[int, ...]:
        """Numbers of bars that are not excluded, the likeliest first; none before the first record."""
        if self.given_bars is not None:
            return (self.given_bars,)
        if not self.evidence:
            return ()
        records = np.array(self.evidence)
        total = records.sum(axis=0)
        behind = records[:, [int(np.argmax(total))]] - records
        lead = behind.sum(axis=0)
        scatter = behind.std(axis=0, ddof=1) * sqrt(len(records)) if len(records) > 1 else 0.0
        open_still = (lead < APART) | (lead < APART_DEVIATIONS * scatter)
        order = np.argsort(-total)
        return tuple(BARS[order[open_still[order]]].tolist())

    @property
    def known_bars(self) -> int | None:
        """The number of bars, where no other is possible."""
        candidates = self.candidates
        return candidates[0] if len(candidates) == 1 else None

    def comb(self, bars: int) -> Comb:
        """Return the lines of a number of bars, as far as they were learnt.

        Parameters
        ----------
        bars : int
            Number of bars.

        Returns
        -------
        Comb
            The lines.
        """
        plain = Comb.untrained(bars)
        if bars != self.bars:
            return plain
        power = self.power + (1.0 + STRENGTH)
        present = (self.present + PRIOR_PIECES * plain.present) / (self.shown + PRIOR_PIECES)
        return Comb(
            bars,
            plain.order,
            plain.turns,
            np.clip(present, LEAST_PRESENT, MOST_PRESENT),
            np.clip(power / (self.present + 1.0) - 1.0, LEAST_STRENGTH, MOST_STRENGTH),
        )

    def weigh(self, evidence: Array) -> None:
        """Take in what a record says of the number of bars.

        Parameters
        ----------
        evidence : ndarray, shape (bars,)
            What `core.speed.bars.evidence_of_bars` returned.
        """
        self.evidence = [*self.evidence, evidence][-LONGEST:]

    def learn(self, residue: Residue, bars: int, rotation_hz: float) -> None:
        """Take in which lines a piece shows.

        Parameters
        ----------
        residue : Residue
            The piece.
        bars : int
            Number of bars; with another one than before, learning begins anew.
        rotation_hz : float
            Speed at which its lines were seen [turns/s].
        """
        if bars != self.bars:
            size = Comb.untrained(bars).order.size
            self.bars = bars
            self.shown, self.present, self.power = np.zeros(size), np.zeros(size), np.zeros(size)
        comb = self.comb(bars)
        frequency_hz = comb.frequency_hz(residue, np.array([rotation_hz]))[:, 0]
        shows, excess = residue.shows(frequency_hz), residue.at(frequency_hz)
        there = comb.present / (1.0 + comb.strength)
        there = there * np.exp(excess * comb.strength / (1.0 + comb.strength))
        probability = np.where(shows, there / (1.0 - comb.present + there), 0.0)
        kept = 1.0 - 1.0 / FORGETTING
        self.shown = kept * self.shown + shows
        self.present = kept * self.present + probability
        self.power = kept * self.power + probability * excess

    def as_dict(self) -> dict[str, object]:
        """Return the memory as JSON takes it.

        Returns
        -------
        dict of str to object
            All of it but the bars that the motor's file gives.
        """
        return {
            "evidence": [one.round(1).tolist() for one in self.evidence],
            "bars": self.bars,
            "shown": self.shown.round(4).tolist(),
            "present": self.present.round(4).tolist(),
            "power": self.power.round(2).tolist(),
        }

    @classmethod
    def from_dict(cls, document: Mapping[str, Any], given_bars: int | None = None) -> Self:
        """Return the memory that a document is of.

        Parameters
        ----------
        document : mapping of str to object
            What `as_dict` returned.
        given_bars : int or None, optional
            Number of bars that the motor's file gives.

        Returns
        -------
        LineMemory
            The memory.
        """

        def numbers(rows: Sequence[float]) -> Array:
            return np.array(rows, dtype=np.float64)

        return cls(
            given_bars,
            [numbers(one) for one in document["evidence"]],
            document["bars"],
            numbers(document["shown"]),
            numbers(document["present"]),
            numbers(document["power"]),
        )
