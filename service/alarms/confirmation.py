"""When a cause is taken for real, and when it is taken for over: nothing chatters.

Each rule answers with a decision from what is seen and from whether the alarm stands. It remembers nothing,
so the same stored data lead to the same alarms in every service that shares a database, and after a restart.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum


class Decision(StrEnum):
    """What becomes of an alarm."""

    RAISE = "raise"
    CLEAR = "clear"
    KEEP = "keep"
    """As it is: raised where it stands, and not raised where it does not."""


@dataclass(frozen=True, slots=True)
class Confirmation:
    """N of M: an alarm is raised when `needed` of the latest `of` looks were bad, the latest one too.

    It is cleared after `good` good looks in a row. These are so many that the looks which remain cannot raise
    it again by themselves.
    """

    needed: int
    of: int
    good: int

    def __post_init__(self) -> None:
        """Raise ValueError where the figures contradict each other."""
        if not 1 <= self.needed <= self.of:
            raise ValueError(f"expected 1 to {self.of} of {self.of} looks, found {self.needed}")
        if self.good < self.least_good(self.needed, self.of):
            raise ValueError(
                f"expected at least {self.least_good(self.needed, self.of)} good looks, found {self.good}"
            )

    @staticmethod
    def least_good(needed: int, of: int) -> int:
        """Return after how many good looks an alarm may be cleared at the earliest."""
        return of - needed + 1

    @property
    def looks(self) -> int:
        """Return how many of the latest looks matter."""
        return max(self.of, self.good)

    def decide(self, bad: Sequence[bool], *, stands: bool) -> Decision:
        """Decide by the looks so far, oldest first."""
        if not bad:
            return Decision.KEEP
        if not stands:
            is_confirmed = bad[-1] and sum(bad[-self.of :]) >= self.needed
            return Decision.RAISE if is_confirmed else Decision.KEEP
        is_over = len(bad) >= self.good and not any(bad[-self.good :])
        return Decision.CLEAR if is_over else Decision.KEEP


@dataclass(frozen=True, slots=True)
class DeadBand:
    """An alarm is raised where a figure has reached `raise_at`, and cleared where it is back at `clear_at`.

    Between the two, everything stays as it is. Where `raise_at` is the smaller one, small figures are bad.
    """

    raise_at: float
    clear_at: float

    def __post_init__(self) -> None:
        """Raise ValueError where there is no band between the two."""
        if self.raise_at == self.clear_at:
            raise ValueError(f"expected two figures, found {self.raise_at:g} twice")

    def decide(self, figure: float, *, stands: bool) -> Decision:
        """Decide by a figure."""
        return self.decide_between(figure, figure, stands=stands)

    def decide_between(self, low: float, high: float, *, stands: bool) -> Decision:
        """Decide by a figure that lies between `low` and `high`: only what is sure counts."""
        if self.raise_at > self.clear_at:
            is_bad, is_good = low >= self.raise_at, high <= self.clear_at
        else:
            is_bad, is_good = high <= self.raise_at, low >= self.clear_at
        if is_bad and not stands:
            return Decision.RAISE
        return Decision.CLEAR if is_good and stands else Decision.KEEP


@dataclass(frozen=True, slots=True)
class Delays:
    """An alarm is raised when its cause has lasted for `on_s` [s], and cleared once over for `off_s`."""

    on_s: float
    off_s: float

    def decide(self, for_s: float, *, is_bad: bool, stands: bool) -> Decision:
        """Decide by how long it has been as it is now [s]."""
        if is_bad and not stands and for_s >= self.on_s:
            return Decision.RAISE
        return Decision.CLEAR if stands and not is_bad and for_s >= self.off_s else Decision.KEEP
