"""Marks of what is to be folded again: whoever changes an observation or an event leaves one with it."""

import uuid

from sqlalchemy import ColumnElement, Select, func, select, update
from sqlalchemy.orm import Session, aliased

from core.condition.observation import SAME_SUPPLY_WITHIN_NS
from service.storage.models import FoldMarkRow, MotorRow, ObservationRow

EARLIEST_NS = -(2**63) + 1
"""Before every record: times are integers of 64 bits in the database."""


def mark(session: Session, motor: str, from_ns: int) -> None:
    """Have a motor folded from a time on."""
    session.add(FoldMarkRow(id=str(uuid.uuid4()), motor=motor, from_ns=from_ns))


def mark_with_bus(session: Session, motor: str, time_ns: int) -> None:
    """Have a motor folded from a record of it on, and the others of its bus from about that time on."""
    mark(session, motor, time_ns)
    neighbours = (
        select(ObservationRow.motor, func.min(ObservationRow.time_ns))
        .where(
            ObservationRow.motor.in_(others_of_bus(motor)),
            ObservationRow.time_ns.between(time_ns - SAME_SUPPLY_WITHIN_NS, time_ns + SAME_SUPPLY_WITHIN_NS),
        )
        .group_by(ObservationRow.motor)
    )
    for neighbour, from_ns in session.execute(neighbours).all():
        mark(session, neighbour, from_ns)


def resume(session: Session, *of: ColumnElement[bool]) -> None:
    """Have motors folded that were set aside, all or some."""
    session.execute(update(FoldMarkRow).where(FoldMarkRow.set_aside, *of).values(set_aside=False))


def others_of_bus(motor: str) -> Select[str]:
    """Return the query of the other motors of a motor's bus; of none where it has no bus."""
    own = aliased(MotorRow)
    return (
        select(MotorRow.name)
        .join(own, own.bus == MotorRow.bus)
        .where(own.name == motor, MotorRow.name != motor)
    )
