"""A motor's past as the repository hands it out: its trend at any scale, and what its records showed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from core.condition.kinds import State
from core.condition.observation import Observation
from service.storage.records.conditions import ConditionFigures, ConditionPoint
from service.storage.records.diagnoses import interval_of


class TrendPoint(NamedTuple):
    """One record's figure (core.quantities); `value` is None where the record does not tell it.

    ci95: 95 % interval from all causes.  scatter95: from the record's own scatter.  detection_limit: what
    nine of ten such records show.  verdict: the value of a Verdict, beside figures of the winding.  state: of
    the stator from this record on, beside figures of its condition, with kind and phase; of the rotor, beside
    figures of that.  reasons: what limits figures of rotor, air gap, load and supply.
    A page has a thousand points: a named tuple is made in a third of the time of a dataclass.
    """

    time_ns: int
    recording_id: str
    value: float | None
    ci95_low: float | None
    ci95_high: float | None
    scatter95_low: float | None
    scatter95_high: float | None
    detection_limit: float | None
    verdict: str | None
    state: str | None
    kind: str | None
    phase: str | None
    reasons: Sequence[str] | None

    @property
    def ci95(self) -> tuple[float, float] | None:
        """Return the 95 % interval from all causes."""
        return interval_of(self.ci95_low, self.ci95_high)

    @property
    def scatter95(self) -> tuple[float, float] | None:
        """Return the 95 % interval from the record's own scatter."""
        return interval_of(self.scatter95_low, self.scatter95_high)


class SubjectPoint(NamedTuple):
    """All figures of a subject of one record, in the order of the catalogue (core.quantities.of_subject)."""

    time_ns: int
    recording_id: str
    values: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class TrendPiece:
    """What the records of a piece of time say together, from_ns <= time < to_ns.

    lowest, highest: of the fault levels.  ci95_low, ci95_high: the ends of all their intervals together.
    state: the worst of them.
    """

    from_ns: int
    to_ns: int
    records: int
    lowest: float | None
    highest: float | None
    ci95_low: float | None
    ci95_high: float | None
    state: State


@dataclass(frozen=True, slots=True)
class ThinnedTrend:
    """The trend of a motor over a time, with no more points than a screen can show.

    records: how many there are in that time.  points: all of them, where they are few.  pieces: what they say
    piece by piece, where they are many; no outlier is lost.
    """

    from_ns: int
    to_ns: int
    records: int
    points: tuple[ConditionPoint, ...] = ()
    pieces: tuple[TrendPiece, ...] = ()


@dataclass(frozen=True, slots=True)
class SeenRecord:
    """The phasors of a record, and what was said of its motor from it on; None while it is not folded."""

    recording_id: str
    observation: Observation
    figures: ConditionFigures | None
