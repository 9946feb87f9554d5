"""How a motor's voltages differ from those of each other motor of its bus, record by record."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from core.condition.bus.neighbours import Neighbour
from core.signals.sequence import PhaseSequence

SETTLED: Final = 8
"""Common records over which the difference to a motor is averaged before it is held."""
MOST: Final = 24
"""Other motors that are compared with; the first to come are kept."""


@dataclass(slots=True)
class Pair:
    """Difference of the voltages of two motors, averaged over their first common records.

    Parameters
    ----------
    mean : complex
        V2/V1 of this motor less that of the other.
    records : int
        Number of common records in it.
    """

    mean: complex
    records: int


@dataclass(slots=True)
class BusDifferences:
    """What a motor's voltages show that those of the bus's other motors do not.

    Each other motor is compared with by itself, so that its absence from a record changes nothing. What is
    returned for a record is how far the differences have moved from where they were when they were settled.

    Parameters
    ----------
    pairs : dict of str to Pair
        Differences by the other motor's name.
    moved : complex
        Latest movement.
    mean_moved : complex
        Mean movement over the records of the reference.
    records : int
        Number of those records.
    """

    pairs: dict[str, Pair] = field(default_factory=dict)
    moved: complex = 0j
    mean_moved: complex = 0j
    records: int = 0

    def fold(
        self, ratio: complex, sequence: PhaseSequence, neighbours: Sequence[Neighbour]
    ) -> tuple[complex | None, int]:
        """Take one record in.

        Parameters
        ----------
        ratio : complex
            V2/V1 of this motor's terminals.
        sequence : PhaseSequence
            Order of the supply's phases at the terminals.
        neighbours : sequence of Neighbour
            What other motors saw at the same time.

        Returns
        -------
        moved : complex or None
            Movement of the differences, by the median of the motors; None where there is no common record.
        motors : int
            Number of motors it is taken from.
        """
        moves, joining = [], []
        for neighbour in sorted(neighbours, key=lambda one: one.motor):
            if neighbour.sequence is not sequence:
                continue
            difference = ratio - neighbour.negative_voltage_ratio
            pair = self.pairs.get(neighbour.motor)
            if pair is None or pair.records < SETTLED:
                joining.append((neighbour.motor, difference))
            if pair is not None:
                moves.append(difference - pair.mean)
        if not moves and not joining:
            return None, 0
        if moves:
            self.moved = self._consensus(moves)
        for name, difference in joining:
            self._settle(name, difference - self.moved)
        # As slowly as the filter learns E: both belong to the same records.
        self.records += 1
        self.mean_moved += (self.moved - self.mean_moved) / self.records
        return self.moved, max(len(moves), 1)

    def mean(self) -> tuple[complex, int]:
        """Return how far this motor's V2/V1 lies from the mean of all.

        Returns
        -------
        difference : complex
            V2/V1 of this motor less the mean.
        others : int
            Number of other motors.
        """
        settled = [pair.mean for pair in self.pairs.values() if pair.records >= SETTLED]
        if not settled:
            return 0j, 0
        return (self.mean_moved + _mean(settled)) * len(settled) / (len(settled) + 1.0), len(settled)

    def restart(self) -> None:
        """Let the movement be averaged anew: the motor's own channels are others."""
        self.records = 0

    def _settle(self, name: str, difference: complex) -> None:
        pair = self.pairs.get(name)
        if pair is None:
            if len(self.pairs) < MOST:
                self.pairs[name] = Pair(difference, 1)
            return
        pair.records += 1
        pair.mean += (difference - pair.mean) / pair.records

    def _consensus(self, moves: Sequence[complex]) -> complex:
        """Return where most differences moved; of two, the one that moved less: the other motor moved."""
        if len(moves) == 2:
            return min(moves, key=lambda move: abs(move - self.moved))
        return complex(np.median([m.real for m in moves]), np.median([m.imag for m in moves]))


def _mean(values: Iterable[complex]) -> complex:
    found = list(values)
    return sum(found, 0j) / len(found)
