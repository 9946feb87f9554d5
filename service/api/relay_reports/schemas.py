"""Documents of what became of a relay's text report."""

from pydantic import Field

from core.relay_reports import ReportKind
from service.api.document import Document, Listed
from service.api.times import Time
from service.storage.records import ReportOutcome
from service.storage.states import RelayEventKind


class ImportedStart(Document):
    """A start of a report: `added`, `joined` with the recording of the same start, or `known` already."""

    id: str
    time: Time = Field(validation_alias="time_ns")
    outcome: ReportOutcome


class LeftOutStart(Document):
    """A start of a relay's report that cannot be kept, and why."""

    time: Time = Field(validation_alias="time_ns")
    reason: str


class StartImport(Document):
    """What became of the starts of a relay's report."""

    starts: Listed[ImportedStart]
    left_out: Listed[LeftOutStart]


class LeftOutColumn(Document):
    """A column of a load profile that cannot be kept, and why."""

    column: str
    reason: str


class LoadImport(Document):
    """What became of the rows of a load profile.

    added: rows that became measured values of these quantities.  known: of quarters of an hour that have
    measured values already.  not_over: of one that is not over, to be brought later, or ahead of the time.
    """

    added: int
    known: int
    not_over: int
    quantities: Listed[str]
    left_out: Listed[LeftOutColumn]


class StatisticsImport(Document):
    """Whether the statistics of a motor were kept; they are where they were not known."""

    time: Time = Field(validation_alias="time_ns")
    since_time: Time | None = Field(validation_alias="since_ns")
    added: bool


class EventImport(Document):
    """What became of a sequence of events.

    added: starts, stops and trips that were not known.  ahead: those whose time is yet to come.
    left_out: elements that tell none of these, the first fifty.
    """

    added: int
    known: int
    ahead: int
    left_out: Listed[str]


class RelayEventEntry(Document):
    """A start, stop or trip of a motor, by its relay's sequence of events."""

    kind: RelayEventKind
    time: Time = Field(validation_alias="time_ns")


class ReportImport(Document):
    """What became of a report, by its kind; the other fields are null."""

    kind: ReportKind
    motor_starts: StartImport | None = None
    load_profile: LoadImport | None = None
    motor_statistics: StatisticsImport | None = None
    events: EventImport | None = None
