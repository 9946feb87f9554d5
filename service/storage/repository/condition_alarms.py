"""The alarm of a motor: one stands while its condition is `watch` or `fault`."""

import uuid
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.condition.kinds import State
from service.storage.models import AlarmRow, MotorRow
from service.storage.repository.alarms import clear, forget_cleared
from service.storage.repository.standing_alarm_counts import count_raised
from service.storage.states import AlarmKind
from service.storage.texts import storable

ALARM_OF = {State.WATCH: AlarmKind.CONDITION_WATCH, State.FAULT: AlarmKind.CONDITION_FAULT}


@dataclass(frozen=True, slots=True)
class ConditionInWords:
    """What an alarm says of a condition: its state, the cause, why it is taken for that, and what to do."""

    state: State
    cause: str
    reason: str
    advice: str


def settle_alarm(session: Session, motor: MotorRow, condition: ConditionInWords, *, now_ns: int) -> None:
    """Make the motor's alarm say what its condition says. Whoever calls it has locked the motor's row.

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
    row.subject = storable(condition.cause)
    row.reason = storable(condition.reason)
    row.advice = storable(condition.advice)
    if stands is None:
        session.add(row)
        count_raised(session, motor.ied, kind)
