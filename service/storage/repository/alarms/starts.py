"""The alarms of a motor's starts: they follow its latest ones, and those that these are compared with."""

from collections.abc import Mapping, Sequence
from typing import Final

from sqlalchemy import Select, exists, or_, select
from sqlalchemy.orm import Session

from core.starts.stress import HOUR_NS, starts_within_hour
from core.units import NANOSECONDS_PER_DAY
from service.alarms.kinds import AlarmKind
from service.alarms.start_rules import LATEST, StartSeen, ToldChange, hard_starts, told_change
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


def _has_alarm(motor: str) -> Select[tuple[bool]]:
    return select(exists().where(AlarmRow.motor == motor, AlarmRow.kind.in_(tuple(OVER)), is_open()))


def _specs(session: Session, motor: str) -> Specs:
    """Return what is to be told of a motor's starts."""
    latest = latest_starts(session, motor, LOOKED_BACK)
    if not latest:
        return {}
    specs = (_hard(session, latest[:LATEST]), _changed(latest, reference_of(session, motor)))
    return {spec.kind: spec for spec in specs if spec is not None}


def _hard(session: Session, latest: Sequence[StartEntry]) -> AlarmSpec | None:
    from_ns, to_ns = latest[-1].time_ns - HOUR_NS, latest[0].time_ns
    within = (StartRow.motor == latest[0].motor, StartRow.time_ns.between(from_ns, to_ns))
    times = session.scalars(select(StartRow.time_ns).where(*within).order_by(StartRow.time_ns)).all()
    hard = hard_starts([_seen(one, times) for one in latest])
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


def _changed(latest: Sequence[StartEntry], reference: StartReference) -> AlarmSpec | None:
    later = [one for one in latest if reference.is_like(one) and not reference.holds(one)]
    together = later[:LATEST]
    told = told_change(reference.compared(together), len(together))
    if told is None:
        return None
    since_ns, is_certain = _since(told, later, reference)
    is_all = len(latest) < LOOKED_BACK or any(map(reference.holds, latest))
    return AlarmSpec(
        AlarmKind.CHANGED_STARTS,
        reason=told.reason(since_ns, or_earlier=not (is_certain or is_all)),
        subject=SUBJECT,
        one_of_kind=True,
        advice=told.advice,
        recording_id=together[0].recording,
    )


def _since(told: ToldChange, later: Sequence[StartEntry], reference: StartReference) -> tuple[int, bool]:
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
