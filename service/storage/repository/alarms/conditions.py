"""The alarm of a motor: one stands while its condition is `watch` or `fault`."""

from collections.abc import Mapping, Sequence

from sqlalchemy import exists, or_, select
from sqlalchemy.orm import Session

from core.condition.kinds import State
from service.storage.models import AlarmRow, ConditionRow, MotorRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec, ConditionEntry
from service.storage.repository.alarms.causes import clear, forget_cleared, raised_at, supersede
from service.storage.repository.alarms.changes import change, locked, urgency
from service.storage.repository.alarms.suppression import suppress_by_design
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import AlarmEvent, AlarmKind, AlarmState

ALARM_OF = {State.WATCH: AlarmKind.CONDITION_WATCH, State.FAULT: AlarmKind.CONDITION_FAULT}


class ConditionAlarmRows(Sessions):
    def settle_alarms(self, *, now_ns: int) -> None:
        """Make the alarms of all motors say what their conditions say.

        For motors that left the plant or came back, of which nothing else tells their alarms.
        """
        stands = exists().where(AlarmRow.motor == ConditionRow.motor, AlarmRow.cleared_ns.is_(None))
        concerned = (
            select(ConditionRow)
            .where(or_(ConditionRow.state.in_(ALARM_OF), stands))
            .order_by(ConditionRow.motor)
            .with_for_update(key_share=True)
        )
        with self._write() as session:
            for row in session.scalars(concerned).all():
                motor = found(session, MotorRow, row.motor, "motor")
                settle_alarm(session, motor, record_of(ConditionEntry, row), now_ns=now_ns)


def settle_alarm(session: Session, motor: MotorRow, condition: ConditionEntry, *, now_ns: int) -> None:
    """Make the motor's alarm say what its condition says. Whoever calls it has locked the condition's row.

    From `watch` to `fault` one alarm is superseded by the other; while the state stays, the alarm stays and
    gets the present words. Those of a motor that left the plant are suppressed and cleared.
    """
    kind = ALARM_OF.get(condition.state) if motor.in_service else None
    of_motor = (AlarmRow.motor == motor.name, is_open())
    rows = locked(session, *of_motor, AlarmRow.kind.in_(ALARM_OF.values()))
    if not motor.in_service:
        for row in rows:
            suppress_by_design(session, row, now_ns=now_ns)
    others = [row for row in rows if row.kind is not kind]
    if kind is None:
        if any(row.cleared_ns is None for row in others):
            clear(session, now_ns, AlarmRow.id.in_([row.id for row in others]))
            forget_cleared(session, AlarmRow.motor == motor.name)
        return
    document = condition.document or {}
    spec = AlarmSpec(
        kind,
        reason="; ".join(_texts(document.get("reasons"))),
        subject=_cause(condition, document),
        one_of_kind=True,
        value=condition.mu_f if condition.change is None else condition.change,
        advice=str(document.get("advice", "")),
    )
    place = AlarmPlace(motor.site, motor.ied, motor.name)
    successor = raised_at(session, place, spec, now_ns=now_ns)
    for row in others:
        if row.cleared_ns is None or row.state is AlarmState.RETURNED_UNACKNOWLEDGED:
            _hand_over(session, row, successor, now_ns)
    if others:
        forget_cleared(session, AlarmRow.motor == motor.name)


def _hand_over(session: Session, row: AlarmRow, successor: AlarmRow, now_ns: int) -> None:
    """End an alarm in favour of another. Who acknowledged a fault need not be called for a mere watch."""
    known = row.state is AlarmState.ACKNOWLEDGED and row.urgency > urgency(row.state, successor.priority)
    by = row.changed_by
    supersede(session, row, successor, now_ns=now_ns)
    if known and successor.state is AlarmState.UNACKNOWLEDGED:
        comment = f"known as {row.kind.value}, alarm {row.id}"
        change(session, successor, AlarmEvent.ACKNOWLEDGED, now_ns=now_ns, by=by, comment=comment)
        successor.seen_value = successor.value


def _cause(condition: ConditionEntry, document: Mapping[str, object]) -> str:
    """Return what has changed, and in which phase; of what is unclear, what it may be."""
    kinds = _texts(document.get("candidates")) or [str(condition.kind)]
    words = " or ".join(kind.replace("-", " ") for kind in kinds)
    return words if condition.phase is None else f"{words} in phase {condition.phase}"


def _texts(found: object) -> Sequence[str]:
    return [str(one) for one in found] if isinstance(found, list) else []
