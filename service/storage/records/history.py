"""A motor's past as the repository hands it out: its trend at any scale, and what its records showed."""

from dataclasses import dataclass

from core.condition.kinds import State
from core.condition.observation import Observation
from service.storage.records.conditions import ConditionFigures, ConditionPoint


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
