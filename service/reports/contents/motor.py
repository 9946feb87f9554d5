"""The report of one motor: how it is, how it came to be so, and what it is."""

from collections.abc import Sequence
from functools import partial
from typing import Protocol, TypeVar

from core.machines.parameters import Motor
from core.terms import phrase
from core.time_words import clock
from service.condition.motor_data import motor_known
from service.condition.wording import cause
from service.reports.contents.motor_pictures import motor_pictures
from service.reports.contents.nameplate import nameplate_facts
from service.reports.document import Block, Column, ColumnKind, Content, Facts, ReportDocument, Table, Words
from service.reports.figures import NOTHING, interval, number, share
from service.reports.motors import ReportedMotor, reported
from service.reports.source import ReportSource
from service.storage import Repository
from service.storage.records import Alarm, MotorVersion, Page, StartEntry
from service.storage.records.history import SeenRecord

MOST_RECORDS = 5000
"""The latest records that the pictures show."""

MOST_LISTED = 15
"""Of starts, alarms, notes and changes, each."""

LOOKED_THROUGH = 500
"""So many of the latest are looked through for those until the report's time."""

MOST_REASONS = 12

STARTS = (
    Column("time", ColumnKind.TIME, 1.5),
    Column("acceleration [s]", ColumnKind.NUMBER),
    Column("peak current [A]", ColumnKind.NUMBER),
    Column("lowest voltage [V]", ColumnKind.NUMBER),
    Column("I2t [A²s]", ColumnKind.NUMBER),
    Column("recorded", width=1.2),
)
ALARMS = (
    Column("raised", ColumnKind.TIME, 1.5),
    Column("priority", width=0.9),
    Column("alarm", width=4.0),
    Column("state now", width=1.3),
)
NOTES = (
    Column("time", ColumnKind.TIME, 1.5),
    Column("kind", width=1.3),
    Column("what was told", width=4.0),
    Column("by", width=1.2),
)
CHANGES = (
    Column("time", ColumnKind.TIME, 1.5),
    Column("state", width=1.0),
    Column("what stands out", width=3.0),
    Column("level", ColumnKind.SHARE),
    Column("change", ColumnKind.SHARE),
)


class _Timed(Protocol):
    @property
    def time_ns(self) -> int: ...


Item = TypeVar("Item", bound=_Timed)


class _Pages(Protocol[Item]):
    """Pages of a list, latest first."""

    def __call__(self, *, limit: int) -> Page[Item]: ...


def motor_document(source: ReportSource, name: str, until_ns: int) -> ReportDocument:
    """Return what the report of a motor says. Raises NotFoundError, SQLAlchemyError."""
    repository, zone = source.repository, source.time_zone
    health = repository.health(name)
    seen = repository.latest_records(name, limit=MOST_RECORDS, before_ns=until_ns + 1)
    point = repository.conditions_at(until_ns).get(name)
    motor = reported(health, point, until_ns, source.stale_after_days)
    versions = [one for one in repository.motor_versions(name) if one.from_ns <= until_ns]
    data = motor_known(name, versions[-1].document) if versions else None
    described = health.motor.description
    return ReportDocument(
        title=f"Motor {name}",
        subject=", ".join(filter(None, [described, health.motor.site, f"relay {health.motor.ied}"])),
        until_ns=until_ns,
        time_zone=zone,
        blocks=[
            Block("Condition", _verdict(motor, data, until_ns, zone)),
            Block("Figures", [_figures(motor, zone)]),
            *_pictures(repository, motor, seen, data, until_ns, zone),
            Block("Condition history of the stator", [_changes(repository, name, until_ns)]),
            Block("Starts", [_starts(repository, name, until_ns)]),
            Block("Alarms", [_alarms(repository, name, until_ns)]),
            Block("Logbook", [_notes(repository, name, until_ns)]),
            Block("Nameplate and parameters", _nameplate(data, versions, zone)),
        ],
    )


def _verdict(motor: ReportedMotor, data: Motor | None, until_ns: int, zone: str) -> Sequence[Content]:
    said = motor.said
    limit = None if data is None else data.limits.fault_level
    told = f"{motor.name}: {said.state.value}. {motor.finding}"
    told += f", {motor.since(zone)}." if motor.since_ns is not None else "."
    contents: list[Content] = [
        Words(f"{told} {motor.expected(until_ns, zone, limit)}".rstrip(), said.state.value)
    ]
    if motor.data:
        contents.append(Words(f"{motor.data.capitalize()}.", "unknown"))
    if motor.advice:
        contents.append(Words(f"What to do: {motor.advice}"))
    reasons = motor.document.get("reasons")
    if isinstance(reasons, list):
        contents += [Words(f"Why: {reason}") for reason in reasons[:MOST_REASONS] if isinstance(reason, str)]
    return contents


def _figures(motor: ReportedMotor, zone: str) -> Facts:
    said, document = motor.said, motor.document
    reference = motor.reference
    growth = document.get("growth_per_day")
    facts = [
        ("fault level in all, with its 95 % interval", interval(said.mu_f, said.mu_f_ci95)),
        ("change since the reference", interval(said.change, said.change_ci95)),
        ("detection limit of a change", share(motor.detectable)),
        (
            "standing asymmetry judged from all records, as a fault level",
            share(number(reference.get("standing"))),
        ),
        ("records of the reference", str(reference.get("records", NOTHING))),
        ("growth", NOTHING if not isinstance(growth, float) else f"{100 * growth:.4f} % a day"),
        ("next level of the forecast", share(motor.ahead)),
        ("latest record", NOTHING if motor.as_of_ns is None else clock(motor.as_of_ns, zone)),
    ]
    return Facts(facts)


def _pictures(
    repository: Repository,
    motor: ReportedMotor,
    seen: Sequence[SeenRecord],
    data: Motor | None,
    until_ns: int,
    zone: str,
) -> Sequence[Block]:
    events = repository.events(motor.name, limit=MOST_LISTED).items
    starts = repository.starts(motor.name, limit=MOST_LISTED).items
    marks = sorted(
        [
            *((one.time_ns, f"{phrase(one.kind)}: {one.reason}") for one in events),
            *((one.time_ns, "start") for one in starts),
        ]
    )
    return motor_pictures(motor, seen, data, marks, until_ns, zone)


def _changes(repository: Repository, name: str, until_ns: int) -> Table:
    page = partial(repository.condition_history, name)
    rows = [
        (one.time_ns, one.state.value, cause(one), one.mu_f, one.change) for one in _until(page, until_ns)
    ]
    return Table("changes", CHANGES, rows, empty="nothing has changed")


def _starts(repository: Repository, name: str, until_ns: int) -> Table:
    rows = [_start(one) for one in _until(partial(repository.starts, name), until_ns)]
    return Table("starts", STARTS, rows, empty="no start was recorded")


def _start(entry: StartEntry) -> Sequence[str | int | float | None]:
    start = entry.filled.figures
    if entry.recording is None:
        recorded = "report alone"
    else:
        is_whole = entry.start.is_from_rest and entry.start.acceleration_s is not None
        recorded = "in full" if is_whole else "in part"
    return (
        entry.time_ns,
        start.acceleration_s,
        start.peak_current_A,
        start.lowest_voltage_V,
        start.i2t_A2s,
        recorded,
    )


def _alarms(repository: Repository, name: str, until_ns: int) -> Table:
    found = repository.alarms(motor=name, limit=10 * MOST_LISTED).items
    shown = [one for one in found if one.raised_ns <= until_ns][:MOST_LISTED]
    return Table("alarms", ALARMS, [_alarm(one) for one in shown])


def _alarm(alarm: Alarm) -> Sequence[str | int]:
    words = f"{phrase(alarm.kind)}: {alarm.reason}"
    return alarm.raised_ns, alarm.priority.value, words, phrase(alarm.state)


def _notes(repository: Repository, name: str, until_ns: int) -> Table:
    page = partial(repository.events, name)
    rows = [
        (
            one.time_ns,
            phrase(one.kind),
            one.reason if one.withdrawn_ns is None else f"withdrawn by {one.who_withdrew}: {one.reason}",
            one.who,
        )
        for one in _until(page, until_ns)
    ]
    return Table("logbook", NOTES, rows)


def _nameplate(data: Motor | None, versions: Sequence[MotorVersion], zone: str) -> Sequence[Content]:
    if data is None:
        return [Words("The motors file has not told its figures yet.", "unknown")]
    from_ns = versions[-1].from_ns
    since = f" since {clock(from_ns, zone)}" if from_ns > 0 else ""  # before the first record otherwise
    return [Facts(nameplate_facts(data)), Words(f"As the motors file says{since}.")]


def _until(pages: _Pages[Item], until_ns: int) -> Sequence[Item]:
    """Return the latest items of a list until a time, latest first."""
    found = [one for one in pages(limit=LOOKED_THROUGH).items if one.time_ns <= until_ns]
    return found[:MOST_LISTED]
