"""Whether shorted turns that were named have vanished: repaired, or a contact that comes and goes."""

from dataclasses import dataclass
from typing import Final

from core.condition.assessment import Change
from core.condition.filter.kalman import TEMPERATURE
from core.condition.filter.state import FilterState

SURE: Final = 12.0
"""Log of the likelihood ratio at which it is certain that they have vanished."""
OF_ONE_RECORD: Final = 3.0
"""What one record counts at most: an odd one does not decide."""
SHAPE: Final = 0.15
"""Relative standard deviation of what shorted turns show from record to record beside the noise."""
NEAR: Final = 0.3
"""Share of what they showed that may be left: errors of what was before, but no other change."""
MAY_BE_LEFT: Final = 0.7
"""Share of it in the mean of few records beyond which it is another change that hides them."""
LONGEST: Final = 32
"""Records for which a change is told as it was while they show little of it.

After that what is left is followed again. That they have vanished may become certain later too."""


@dataclass(slots=True)
class Vanishing:
    """What shorted turns showed, and how surely the latest records show nothing of it.

    Parameters
    ----------
    change : Change
        The change while it was there.
    reference : list of float
        State of the filter before the change.
    shown_real, shown_imaginary : float
        What the turns add to y.
    last_ns : int
        Time of the latest record that showed them, UTC [ns].
    evidence : float
        Log of the likelihood ratio of none to all of it, over the latest records; 0 where they show it.
    records : int
        Number of these records.
    rest_real, rest_imaginary : float
        Sum over them of what y has beyond the state before the change.
    """

    change: Change
    reference: list[float]
    shown_real: float
    shown_imaginary: float
    last_ns: int
    evidence: float = 0.0
    records: int = 0
    rest_real: float = 0.0
    rest_imaginary: float = 0.0

    @classmethod
    def of(cls, change: Change, shown: complex, reference: list[float], time_ns: int) -> "Vanishing":
        """Return what a change shows that is there.

        Parameters
        ----------
        change : Change
            The change.
        shown : complex
            What it adds to y.
        reference : list of float
            State of the filter before it.
        time_ns : int
            Time of the latest record, UTC [ns].

        Returns
        -------
        Vanishing
            Nothing has vanished of it.
        """
        return cls(change, reference, shown.real, shown.imag, time_ns)

    def look(self, state: FilterState, y: complex, j1: complex, time_ns: int) -> None:
        """See whether a record shows the turns.

        Parameters
        ----------
        state : FilterState
            The filter after the record.
        y, j1 : complex
            The record.
        time_ns : int
            Its time, UTC [ns].
        """
        shown = complex(self.shown_real, self.shown_imaginary)
        x = self.reference
        rest = y - complex(x[0], x[1]) - complex(x[2], x[3]) * j1 - complex(x[4], x[5]) * complex(state.w)
        square = abs(shown) ** 2
        share = (shown.conjugate() * rest).real / square
        warm = TEMPERATURE * (shown.conjugate() * complex(state.w)).real / square
        variance = float(state.R) / square + warm * warm + SHAPE * SHAPE
        tells = (0.5 - share) / variance
        self.evidence += min(max(tells, -OF_ONE_RECORD), OF_ONE_RECORD)
        if self.evidence <= 0.0:
            self.evidence, self.records, self.rest_real, self.rest_imaginary = 0.0, 0, 0.0, 0.0
            self.last_ns = time_ns
            return
        self.records += 1
        self.rest_real += rest.real
        self.rest_imaginary += rest.imag

    @property
    def is_open(self) -> bool:
        """Whether the latest records show less than half of the turns, and more have to tell."""
        return 0 < self.records <= LONGEST and self._left < MAY_BE_LEFT

    @property
    def is_certain(self) -> bool:
        """Whether the turns have vanished."""
        return self.evidence >= SURE and self._left < NEAR

    @property
    def _left(self) -> float:
        """What is left in the latest records, in any direction, as a share of what the turns showed."""
        rest = abs(complex(self.rest_real, self.rest_imaginary)) / self.records
        return rest / abs(complex(self.shown_real, self.shown_imaginary))
