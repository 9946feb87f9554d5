"""The alarms of a motor's starts: they follow its latest ones, and those that these are compared with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from sqlalchemy import Select, exists, or_, select
from sqlalchemy.orm import Session

from core.starts.compared import StartChanges
from core.starts.notable import LATEST, NotableChange, StartSeen, hard_starts, notable_change
from core.starts.stress import HOUR_NS, starts_within_hour
from core.units import NANOSECONDS_PER_DAY
from service.alarms.kinds import AlarmKind
from service.storage.models import AlarmRow, MotorRow, StartRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec, StartEntry, StartReference
from service.storage.repository.alarms.causes import LEFT_THE_PLANT, end_of_motor, locked_place, raised_at
from service.storage.repository.alarms.changes import locked
from service.storage.repository.history.start_reference import latest_starts, reference_of
from service.storage.repository.sessions import Sessions, found

LOOKED_BACK: Final = 20
"""Starts among which the first one that has changed is looked for."""
RECENT_NS: Final = 7 * NANOSECONDS_PER_DAY
SUBJECT: Final = "starts"
OVER: Final[Mapping[AlarmKind, str]] = {
    AlarmKind.HARD_STARTS: "none of the latest starts was too soon or too hot",
    AlarmKind.CHANGED_STARTS: "the latest starts are as the first ones, or have another reference",
}
"""The kinds, and why each is over."""

Specs = Mapping[AlarmKind, AlarmSpec]


@dataclass(frozen=True, slots=True)
class NotableStarts:
    """The latest starts of a motor, latest first, how they compare, what has changed, and since when."""

    latest: Sequence[StartSeen]
    compared: StartChanges | None
    change: NotableChange | None
    since_ns: int | None


class StartAlarmRows(Sessions):
    def settle_start_alarms_of(self, motor: str, *, now_ns: int) -> None:
        """Make the alarms of a motor's starts say what these show. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            if not _specs(session, motor) and not session.scalar(_has_alarm(motor)):
                return
        with self._write() as session:
            settle_start_alarms(session, found(session, MotorRow, motor, "motor", lock=True), now_ns=now_ns)

    def settle_start_alarms(self, *, now_ns: int) -> None:
        """Make the alarms of starts say what these show, as a service does when it starts.

        Of motors with such an alarm, or that were started within a week.
        """
        stands = exists().where(
            AlarmRow.motor == MotorRow.name, AlarmRow.kind.in_(tuple(OVER)), AlarmRow.cleared_ns.is_(None)
        )
        started = exists().where(StartRow.motor == MotorRow.name, StartRow.time_ns >= now_ns - RECENT_NS)
        query = select(MotorRow.name).where(or_(stands, started)).order_by(MotorRow.name)
        with self._read() as session:
            motors = session.scalars(query).all()
        for motor in motors:
            self.settle_start_alarms_of(motor, now_ns=now_ns)


def settle_start_alarms(session: Session, motor: MotorRow, *, now_ns: int) -> None:
    """Make the alarms of a locked motor's starts say what these show."""
    specs = _specs(session, motor.name) if motor.in_service else {}
    place = locked_place(session, AlarmPlace(motor=motor.name))
    for kind, over in OVER.items():
        spec = specs.get(kind)
        if spec is not None:
            raised_at(session, place, spec, now_ns=now_ns)
            continue
        rows = locked(session, AlarmRow.motor == motor.name, AlarmRow.kind == kind, is_open())
        why = over if motor.in_service else LEFT_THE_PLANT
        end_of_motor(session, motor.name, rows, why, now_ns=now_ns)


def notable_starts(session: Session, motor: str) -> NotableStarts:
    """Return what somebody has to look after in a motor's starts."""
    latest = latest_starts(session, motor, LOOKED_BACK)
    if not latest:
        return NotableStarts((), None, None, None)
    reference = reference_of(session, motor)
    changed = _change(latest, reference)
    return NotableStarts(
        _all_seen(session, latest[:LATEST]),
        reference.compared(latest[:LATEST]),
        None if changed is None else changed.change,
        None if changed is None else changed.since_ns,
    )


def _has_alarm(motor: str) -> Select[tuple[bool]]:
    return select(exists().where(AlarmRow.motor == motor, AlarmRow.kind.in_(tuple(OVER)), is_open()))


def _specs(session: Session, motor: str) -> Specs:
    """Return what is to be told of a motor's starts."""
    latest = latest_starts(session, motor, LOOKED_BACK)
    if not latest:
        return {}
    specs = (_hard(session, latest[:LATEST]), _changed(latest, reference_of(session, motor)))
    return {spec.kind: spec for spec in specs if spec is not None}


def _all_seen(session: Session, latest: Sequence[StartEntry]) -> Sequence[StartSeen]:
    from_ns, to_ns = latest[-1].time_ns - HOUR_NS, latest[0].time_ns
    within = (StartRow.motor == latest[0].motor, StartRow.time_ns.between(from_ns, to_ns))
    times = session.scalars(select(StartRow.time_ns).where(*within).order_by(StartRow.time_ns)).all()
    return [_seen(one, times) for one in latest]


def _hard(session: Session, latest: Sequence[StartEntry]) -> AlarmSpec | None:
    hard = hard_starts(_all_seen(session, latest))
    if not hard:
        return None
    worst = next(one for one in latest if one.time_ns == hard[0].time_ns)
    return AlarmSpec(
        AlarmKind.HARD_STARTS,
        reason="; ".join(reason for one in hard for reason in one.reasons),
        subject=SUBJECT,
        one_of_kind=True,
        recording_id=worst.recording,
    )


def _seen(entry: StartEntry, times: Sequence[int]) -> StartSeen:
    within, stress = starts_within_hour(times, entry.time_ns), entry.filled.stress
    if stress is None:
        return StartSeen(entry.time_ns, within, None, None)
    heat = stress.share_of_cold if stress.share_of_hot is None else stress.share_of_hot
    return StartSeen(entry.time_ns, within, stress.starts_per_hour, heat, stress.source)


@dataclass(frozen=True, slots=True)
class _Changed:
    """A change of the latest starts, since when, maybe earlier, and the latest recording that shows it."""

    change: NotableChange
    since_ns: int
    or_earlier: bool
    recording_id: str | None


def _change(latest: Sequence[StartEntry], reference: StartReference) -> _Changed | None:
    later = [one for one in latest if reference.is_like(one) and not reference.holds(one)]
    together = later[:LATEST]
    change = notable_change(reference.compared(together), len(together))
    if change is None:
        return None
    since_ns, is_certain = _since(change, later, reference)
    is_all = len(latest) < LOOKED_BACK or any(map(reference.holds, latest))
    return _Changed(change, since_ns, not (is_certain or is_all), together[0].recording)


def _changed(latest: Sequence[StartEntry], reference: StartReference) -> AlarmSpec | None:
    found = _change(latest, reference)
    if found is None:
        return None
    return AlarmSpec(
        AlarmKind.CHANGED_STARTS,
        reason=found.change.reason(found.since_ns, or_earlier=found.or_earlier),
        subject=SUBJECT,
        one_of_kind=True,
        advice=found.change.advice,
        recording_id=found.recording_id,
    )


def _since(told: NotableChange, later: Sequence[StartEntry], reference: StartReference) -> tuple[int, bool]:
    """Return when the first of the starts in a row was that show a change, and whether one before does not.

    later: latest first.
    """
    first = later[:LATEST][-1]
    for number, entry in enumerate(later):
        single = reference.compared([entry])
        if single is not None and told.is_seen_in(single):
            first = entry
        elif number >= LATEST:
            return first.time_ns, True
    return first.time_ns, False
