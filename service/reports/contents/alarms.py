"""The report of all alarms of a month: each call, and what became of it until the month's end."""

from collections import Counter
from collections.abc import Collection, Sequence

from core.terms import phrase
from core.time_words import clock, duration
from core.units import NANOSECONDS_PER_SECOND
from service.reports.document import Block, Cell, Column, ColumnKind, Facts, ReportDocument, Table
from service.reports.source import ReportSource
from service.reports.times import Period
from service.storage import Repository
from service.storage.records import AlarmCall
from service.storage.states import AlarmPriority

MOST_CALLS = 20_000
"""The latest calls of a month; more than that are a flood, which nobody reads."""

MOST_CAUSES = 15

CALLS = (
    Column("time", ColumnKind.TIME, width=1.5),
    Column("priority", width=0.9),
    Column("about", width=1.6),
    Column("alarm", width=3.4),
    Column("acknowledged", ColumnKind.TIME, width=1.5),
    Column("by", width=1.0),
    Column("gone", ColumnKind.TIME, width=1.5),
)
COMMENT = (Column("comment", width=1.8), Column("state at the end", width=1.6))
CAUSES = (Column("alarm", width=2.0), Column("about", width=1.5), Column("calls", ColumnKind.WHOLE, 0.5))


def alarms_document(
    source: ReportSource,
    period: Period,
    month: str,
    sites: Collection[str] | None = None,
) -> ReportDocument:
    """Return what the report of a month says. Raises SQLAlchemyError."""
    repository, zone = source.repository, source.time_zone
    calls = repository.alarm_calls(from_ns=period.from_ns, to_ns=period.to_ns, limit=MOST_CALLS, sites=sites)
    number = repository.number_of_alarm_calls(from_ns=period.from_ns, to_ns=period.to_ns, sites=sites)
    where = f", {', '.join(sorted(sites))}" if sites is not None else ""
    return ReportDocument(
        title=f"Alarms of {month}",
        subject=f"{clock(period.from_ns, zone)} to {clock(period.to_ns, zone)}{where}",
        until_ns=period.to_ns,
        time_zone=zone,
        blocks=[
            Block("Summary", [_summary(calls, number)]),
            Block("What called most often", [_causes(calls)]),
            Block("All calls", [_table(calls, number - len(calls), with_comments=True)]),
        ],
    )


def alarm_table(
    repository: Repository,
    period: Period,
    *,
    sites: Collection[str] | None,
    most: int,
    with_comments: bool,
) -> Table:
    """Return the table of the calls in a time, of so many at most. Raises SQLAlchemyError."""
    calls = repository.alarm_calls(from_ns=period.from_ns, to_ns=period.to_ns, limit=most, sites=sites)
    number = repository.number_of_alarm_calls(from_ns=period.from_ns, to_ns=period.to_ns, sites=sites)
    return _table(calls, number - len(calls), with_comments=with_comments)


def _summary(calls: Sequence[AlarmCall], number: int) -> Facts:
    priorities = Counter(call.alarm.priority for call in calls)
    by_priority = ", ".join(f"{priorities[one]} {one.value}" for one in AlarmPriority if priorities[one])
    taken = sorted(
        call.acknowledged_ns - call.called_ns for call in calls if call.acknowledged_ns is not None
    )
    half = ""
    if taken:
        half = f"; half of them within {duration(taken[len(taken) // 2] / NANOSECONDS_PER_SECOND)}"
    standing = sum(call.gone_ns is None for call in calls)
    return Facts(
        [
            ("calls", f"{number}: {by_priority}" if calls else "none"),
            ("acknowledged", f"{len(taken)} of {len(calls)}{half}"),
            ("cause not gone by the end", str(standing)),
        ]
    )


def _causes(calls: Sequence[AlarmCall]) -> Table:
    causes = Counter((phrase(call.alarm.kind), call.alarm.place) for call in calls)
    often = sorted(causes.items(), key=lambda one: (-one[1], one[0]))
    rows = [(*cause, number) for cause, number in often[:MOST_CAUSES]]
    return Table("causes", CAUSES, rows, left_out=max(len(often) - MOST_CAUSES, 0))


def _table(calls: Sequence[AlarmCall], left_out: int, *, with_comments: bool) -> Table:
    columns = (*CALLS, *COMMENT) if with_comments else CALLS
    rows = [_row(call)[: len(columns)] for call in calls]
    return Table("alarms", columns, rows, left_out=max(left_out, 0))


def _row(call: AlarmCall) -> Sequence[Cell]:
    alarm = call.alarm
    return (
        call.called_ns,
        alarm.priority.value,
        call.alarm.place,
        f"{phrase(alarm.kind)}: {alarm.reason}",
        call.acknowledged_ns,
        call.acknowledged_by,
        call.gone_ns,
        call.comment,
        phrase(call.state),
    )
