"""The alarm of a motor: one stands while its condition is `watch` or `fault`."""

import uuid
from collections.abc import Mapping, Sequence

from sqlalchemy import exists, or_, select
from sqlalchemy.orm import Session

from core.condition.kinds import State
from service.storage.models import AlarmRow, ConditionRow, MotorRow
from service.storage.records import ConditionEntry
from service.storage.repository.alarms import clear, forget_cleared
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.repository.standing_alarm_counts import count_raised
from service.storage.states import AlarmKind
from service.storage.texts import storable

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

    From `watch` to `fault` one alarm is cleared and the other raised; while the state stays, the alarm stays
    and gets the present words. A motor that left the plant has none.
    """
    kind = ALARM_OF.get(condition.state) if motor.in_service else None
    standing = (
        select(AlarmRow)
        .where(AlarmRow.motor == motor.name, AlarmRow.cleared_ns.is_(None))
        .order_by(AlarmRow.raised_ns, AlarmRow.id)
    )
    rows = session.scalars(standing).all()
    others = [row.id for row in rows if row.kind is not kind]
    if others:
        clear(session, now_ns, AlarmRow.id.in_(others))
        forget_cleared(session, AlarmRow.motor == motor.name)
    if kind is None:
        return
    stands = next((row for row in rows if row.kind is kind), None)
    row = stands or AlarmRow(
        id=str(uuid.uuid4()), ied=motor.ied, kind=kind, motor=motor.name, raised_ns=now_ns
    )
    document = condition.document or {}
    row.subject = storable(_cause(condition, document))
    row.reason = storable("; ".join(_texts(document.get("reasons"))))
    row.advice = storable(str(document.get("advice", "")))
    if stands is None:
        session.add(row)
        count_raised(session, motor.ied, kind)


def _cause(condition: ConditionEntry, document: Mapping[str, object]) -> str:
    """Return what has changed, and in which phase; of what is unclear, what it may be."""
    kinds = _texts(document.get("candidates")) or [str(condition.kind)]
    words = " or ".join(kind.replace("-", " ") for kind in kinds)
    return words if condition.phase is None else f"{words} in phase {condition.phase}"


def _texts(found: object) -> Sequence[str]:
    return [str(one) for one in found] if isinstance(found, list) else []
