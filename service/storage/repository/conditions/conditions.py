"""The conditions of motors, and how they came to be."""

from collections.abc import Collection, Mapping
from dataclasses import fields

from sqlalchemy import bindparam, or_, select, update
from sqlalchemy.orm import Session

from core.condition.kinds import Kind, State
from service.storage.models import ConditionChangeRow, ConditionRow, MotorRow
from service.storage.records import ConditionChange, ConditionEntry, Cursor, Page
from service.storage.repository.sessions import Order, Sessions, columns_of, found, page_of, record_of


class ConditionRows(Sessions):
    def condition(self, motor: str) -> ConditionEntry:
        """Return a motor's condition. Raises NotFoundError."""
        with self._read() as session:
            return record_of(ConditionEntry, found(session, ConditionRow, motor, "motor"))

    def conditions(self, motors: Collection[str] | None = None) -> Mapping[str, ConditionEntry]:
        """Return the conditions of these motors, or of all in service, by name."""
        with self._read() as session:
            return conditions_of(session, motors)

    def condition_history(
        self, motor: str, *, limit: int, after: Cursor | None = None
    ) -> Page[ConditionChange]:
        """Return a page of the changes of a motor's condition, latest first. Raises NotFoundError."""
        query = select(ConditionChangeRow).where(ConditionChangeRow.motor == motor)
        order: Order = [ConditionChangeRow.time_ns, ConditionChangeRow.id]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(
                session,
                query,
                order,
                lambda row, *_: record_of(ConditionChange, row),
                limit=limit,
                after=after,
                descending=True,
            )


_CONDITIONS = select(*columns_of(ConditionEntry, ConditionRow)).order_by(ConditionRow.motor)
_CONDITIONS_IN_SERVICE = _CONDITIONS.join(MotorRow, MotorRow.name == ConditionRow.motor).where(
    MotorRow.in_service
)
_CONDITIONS_OF_MOTORS = _CONDITIONS.where(ConditionRow.motor.in_(bindparam("of_motors", expanding=True)))
_NAMES = tuple(field.name for field in fields(ConditionEntry))


def conditions_of(session: Session, motors: Collection[str] | None = None) -> Mapping[str, ConditionEntry]:
    """Return the conditions of these motors, or of all in service, by name."""
    if motors is None:
        rows = session.execute(_CONDITIONS_IN_SERVICE)
    else:
        rows = session.execute(_CONDITIONS_OF_MOTORS, {"of_motors": list(motors)})
    return {row.motor: ConditionEntry(**dict(zip(_NAMES, row, strict=True))) for row in rows}


def note_standstill(session: Session, motor: str, time_ns: int) -> None:
    """Note that a motor was seen to stand still: that it makes no records is no wonder then."""
    session.execute(
        update(ConditionRow)
        .where(
            ConditionRow.motor == motor,
            or_(ConditionRow.stood_ns.is_(None), ConditionRow.stood_ns < time_ns),
        )
        .values(stood_ns=time_ns)
    )


def new_condition(motor: str) -> ConditionRow:
    """Return the condition of a motor of which nothing is known."""
    return ConditionRow(motor=motor, version=0, state=State.UNKNOWN, kind=Kind.NONE)
