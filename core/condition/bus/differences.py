"""How a motor's voltages differ from those of each other motor of its bus, record by record."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import sqrt
from statistics import median
from typing import Final

from core.condition.bus.neighbours import Neighbour
from core.signals.sequence import PhaseSequence

COMMON_RECORDS: Final = 8
"""Common records over which the difference to a motor is averaged before it is held."""
SLOWEST: Final = 1.0 / 256.0
MOST: Final = 24
"""Other motors that are compared with; the first to come are kept."""
SAME: Final = 0.05
MOST_SAME: Final = 0.2
"""Shares of what channels of their class differ by, below which two motors have one voltage transformer: at
least, and at most where the differences are noisy."""


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

    @property
    def is_settled(self) -> bool:
        """Whether it is averaged over enough records."""
        return self.records >= COMMON_RECORDS


@dataclass(frozen=True, slots=True)
class BusMean:
    """How far a motor's V2/V1 lies from the mean of the bus.

    Parameters
    ----------
    difference : complex
        V2/V1 of this motor less the mean of all.
    others : int
        Number of other motors.
    transformers : int
        Number of voltage transformers that they and this motor have.
    """

    difference: complex
    others: int
    transformers: int


@dataclass(slots=True)
class BusDifferences:
    """What a motor's voltages show that those of the bus's other motors do not.

    Each other motor is compared with by itself, so that its absence from a record changes nothing. What is
    returned for a record is how far the differences have moved from where they were when they were settled.
    A motor whose voltages are the same to the noise is behind the same transformer: it tells nothing of it.

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
        self, ratio: complex, sequence: PhaseSequence, neighbours: Sequence[Neighbour], same: float
    ) -> complex | None:
        """Take one record in.

        Parameters
        ----------
        ratio : complex
            V2/V1 of this motor's terminals.
        sequence : PhaseSequence
            Order of the supply's phases at the terminals.
        neighbours : sequence of Neighbour
            What other motors saw at the same time.
        same : float
            Difference below which both motors are behind the same transformer.

        Returns
        -------
        complex or None
            Movement of the differences, by the median of the motors; None where no motor with a transformer
            of its own was recorded.
        """
        moves = []
        found = {
            one.motor: ratio - one.negative_voltage_ratio for one in neighbours if one.sequence is sequence
        }
        for name in sorted(found):
            pair = self.pairs.get(name)
            if pair is not None and pair.is_settled and abs(pair.mean) > same:
                moves.append(found[name] - pair.mean)
        if moves:
            self.moved = self._consensus(moves)
            # As slowly as the filter learns E: both belong to the same records.
            self.records += 1
            self.mean_moved += (self.moved - self.mean_moved) / self.records
        for name in sorted(found):
            self._settle(name, found[name] - self.moved)
        return self.moved if moves else None

    def mean(self, same: float) -> BusMean:
        """Return how far this motor's V2/V1 lies from the mean of all.

        Parameters
        ----------
        same : float
            Difference below which both motors are behind the same transformer.

        Returns
        -------
        BusMean
            The difference; of no motor where none has been compared with for long enough.
        """
        settled = [pair.mean for pair in self.pairs.values() if pair.is_settled]
        own = [mean + self.mean_moved for mean in settled if abs(mean) > same]
        return BusMean(sum(own, 0j) / (len(settled) + 1.0), len(settled), len(own) + 1)

    def restart(self) -> None:
        """Forget all: the motor's own channels are others."""
        self.pairs.clear()
        self.moved, self.mean_moved, self.records = 0j, 0j, 0

    def _settle(self, name: str, difference: complex) -> None:
        pair = self.pairs.get(name)
        if pair is None:
            if len(self.pairs) < MOST:
                self.pairs[name] = Pair(difference, 1)
            return
        # A motor that has moved by itself comes back into line slowly.
        gain = SLOWEST if pair.is_settled else 1.0 / (pair.records + 1)
        pair.records = min(pair.records + 1, COMMON_RECORDS)
        pair.mean += gain * (difference - pair.mean)

    def _consensus(self, moves: Sequence[complex]) -> complex:
        """Return where most differences moved; of two, the one that moved less: the other motor moved."""
        if len(moves) == 2:
            return min(moves, key=lambda move: abs(move - self.moved))
        return complex(median(m.real for m in moves), median(m.imag for m in moves))


def same_transformer(usual: float, variance: float) -> float:
    """Return the difference of two motors' V2/V1 below which it is that of one transformer's noise.

    Parameters
    ----------
    usual : float
        What V2/V1 of two transformers of their class usually differs by.
    variance : float
        Variance of the difference from record to record.

    Returns
    -------
    float
        The difference.
    """
    noise = 3.0 * sqrt(variance / COMMON_RECORDS)
    return min(max(SAME * usual, noise), MOST_SAME * usual)
