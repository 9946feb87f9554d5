"""What became of a relay's text report."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.relay_reports import ReportKind
from service.storage.records import ImportedStart


@dataclass(frozen=True, slots=True)
class LeftOutStart:
    """A start of a relay's report that cannot be kept, and why."""

    time_ns: int
    reason: str


@dataclass(frozen=True, slots=True)
class KeptStarts:
    """What became of the starts of a report."""

    starts: Sequence[ImportedStart]
    left_out: Sequence[LeftOutStart]


@dataclass(frozen=True, slots=True)
class LeftOutColumn:
    """A column of a load profile that cannot be kept, and why."""

    column: str
    reason: str


@dataclass(frozen=True, slots=True)
class KeptLoad:
    """What became of the rows of a load profile.

    added: rows that became measured values of these quantities.  known: of quarters of an hour that have
    measured values already.  not_over: of one that is not over, to be brought later, or ahead of the time.
    """

    added: int
    known: int
    not_over: int
    quantities: Sequence[str]
    left_out: Sequence[LeftOutColumn]


@dataclass(frozen=True, slots=True)
class KeptStatistics:
    """The time of statistics, and whether they were kept; they are where they were not known."""

    time_ns: int
    since_ns: int | None
    added: bool


@dataclass(frozen=True, slots=True)
class KeptEvents:
    """What became of a sequence of events.

    added: starts, stops and trips that were not known.  ahead: those whose time is yet to come.
    left_out: elements that tell none of these, the first ones.
    """

    added: int
    known: int
    ahead: int
    left_out: Sequence[str]


@dataclass(frozen=True, slots=True)
class KeptReport:
    """What became of a report, by its kind; the other fields are None."""

    kind: ReportKind
    motor_starts: KeptStarts | None = None
    load_profile: KeptLoad | None = None
    motor_statistics: KeptStatistics | None = None
    events: KeptEvents | None = None
