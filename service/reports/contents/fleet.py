"""The report of the fleet over a day or a week: how the motors are, what changed, what called."""

from collections import Counter
from collections.abc import Collection, Sequence

from core.condition.kinds import State
from core.time_words import clock
from service.condition.wording import cause
from service.reports.contents.alarms import alarm_table
from service.reports.document import Block, Column, ColumnKind, Facts, ReportDocument, Table, Words
from service.reports.figures import interval, state_words
from service.reports.motors import STALE, ReportedMotor, reported_motors
from service.reports.source import ReportSource
from service.reports.times import Period
from service.storage import Repository
from service.storage.records import ConditionChange
from service.storage.states import LinkState

MOST_CHANGES = 300
MOST_CALLS = 300
MOST_ADVISED = 30

MOTORS = (
    Column("motor", width=2.0),
    Column("site", width=1.4),
    Column("state", width=1.1),
    Column("what stands out", width=2.4),
    Column("level", ColumnKind.SHARE),
    Column("from", ColumnKind.SHARE),
    Column("to", ColumnKind.SHARE),
    Column("change", ColumnKind.SHARE),
    Column("detection limit", ColumnKind.SHARE),
    Column("latest record", ColumnKind.TIME, width=1.8),
    Column("data", width=1.5),
)
CHANGES = (
    Column("time", ColumnKind.TIME, width=1.6),
    Column("motor", width=1.6),
    Column("state", width=1.0),
    Column("what stands out", width=2.6),
    Column("level", ColumnKind.SHARE),
)


def fleet_document(
    source: ReportSource,
    period: Period,
    title: str,
    sites: Collection[str] | None = None,
) -> ReportDocument:
    """Return what the report of a day or a week says. Raises SQLAlchemyError."""
    repository, zone = source.repository, source.time_zone
    motors = reported_motors(source, period.to_ns, sites)
    where = f", {', '.join(sorted(sites))}" if sites is not None else ""
    return ReportDocument(
        title=title,
        subject=f"{clock(period.from_ns, zone)} to {clock(period.to_ns, zone)}{where}",
        until_ns=period.to_ns,
        time_zone=zone,
        blocks=[
            Block("Summary", [_summary(repository, motors, period, sites)]),
            Block("What needs attention", _attention(motors, zone)),
            Block("Motors", [_motors(motors)]),
            Block("What changed in stators", [_changes(repository, motors, period)]),
            Block(
                "Alarms raised",
                [alarm_table(repository, period, sites=sites, most=MOST_CALLS, with_comments=False)],
            ),
        ],
    )


def _summary(
    repository: Repository,
    motors: Sequence[ReportedMotor],
    period: Period,
    sites: Collection[str] | None,
) -> Facts:
    states = Counter(motor.said.state for motor in motors)
    counted = ", ".join(f"{states[state]} {state.value}" for state in State if states[state]) or "none"
    data = Counter(motor.data for motor in motors if motor.data)
    without = ", ".join(f"{number} {words}" for words, number in sorted(data.items())) or "none"
    calls = repository.number_of_alarm_calls(from_ns=period.from_ns, to_ns=period.to_ns, sites=sites)
    down = {motor.health.ied.name for motor in motors if motor.health.ied.link_state is not LinkState.UP}
    return Facts(
        [
            ("motors", f"{len(motors)}: {counted}" if motors else "none"),
            ("without a recent record, or not running", without),
            ("calls of alarms", str(calls)),
            ("relays that do not answer now", ", ".join(sorted(down)) or "none"),
        ]
    )


def _attention(motors: Sequence[ReportedMotor], zone: str) -> Sequence[Words]:
    calling = [motor for motor in motors if motor.said.state in (State.FAULT, State.WATCH)]
    told = [Words(_sentence(motor, zone), motor.said.state.value) for motor in calling[:MOST_ADVISED]]
    if len(calling) > MOST_ADVISED:
        told.append(Words(f"{len(calling) - MOST_ADVISED} further motors are in the table below."))
    stale = sum(motor.data == STALE for motor in motors)
    if stale:
        number = "1 motor has" if stale == 1 else f"{stale} motors have"
        words = f"{number} no recent record: what is told of them may have changed since."
        told.append(Words(words, "unknown"))
    return told or [Words("Nothing stands out.", "healthy")]


def _sentence(motor: ReportedMotor, zone: str) -> str:
    """Return a motor in a sentence or some: what, since when, how bad, how sure, what to do."""
    said = motor.said
    told = f"{motor.name} ({motor.health.motor.site}): {state_words(said)}"
    if motor.since_ns is not None:
        told += f", {motor.since(zone)}"
    if said.mu_f is not None:
        told += f", level {interval(said.mu_f, said.mu_f_ci95)}"
    told += "."
    if motor.data:
        told += f" {motor.data.capitalize()}."
    return f"{told} {motor.advice}" if motor.advice else told


def _motors(motors: Sequence[ReportedMotor]) -> Table:
    rows = [
        (
            motor.name,
            motor.health.motor.site,
            motor.said.state.value,
            cause(motor.said),
            motor.said.mu_f,
            motor.said.mu_f_ci95_low,
            motor.said.mu_f_ci95_high,
            motor.said.change,
            motor.detectable,
            motor.as_of_ns,
            motor.data,
        )
        for motor in motors
    ]
    return Table("motors", MOTORS, rows, empty="no motor")


def _changes(repository: Repository, motors: Sequence[ReportedMotor], period: Period) -> Table:
    names = {motor.name for motor in motors}
    found = repository.condition_changes_between(period.from_ns, period.to_ns, limit=10 * MOST_CHANGES)
    changes = [change for change in found if change.motor in names]
    shown = changes[-MOST_CHANGES:]
    return Table(
        "changes",
        CHANGES,
        [_change(one) for one in shown],
        left_out=len(changes) - len(shown),
        empty="nothing",
    )


def _change(change: ConditionChange) -> Sequence[str | int | float | None]:
    return change.time_ns, change.motor, change.state.value, cause(change), change.mu_f
