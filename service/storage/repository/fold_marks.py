"""Marks of what is to be folded again: whoever changes an observation or an event leaves one with it."""

import uuid

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.storage.models import FoldMarkRow, MotorRow, ObservationRow

NEIGHBOURS_WITHIN_NS = 60 * NANOSECONDS_PER_SECOND
"""Records of two motors of a bus that are no further apart see the same supply."""

EARLIEST_NS = -(2**63) + 1
"""Before every record: times are integers of 64 bits in the database."""


def mark(session: Session, motor: str, from_ns: int) -> None:
    """Have a motor folded from a time on."""
    session.add(FoldMarkRow(id=str(uuid.uuid4()), motor=motor, from_ns=from_ns))


def mark_with_bus(session: Session, motor: str, time_ns: int) -> None:
    """Have a motor folded from a record of it on, and the others of its bus from about that time on."""
    mark(session, motor, time_ns)
    of_the_bus = (
        select(MotorRow.bus).where(MotorRow.name == motor, MotorRow.bus.is_not(None)).scalar_subquery()
    )
    neighbours = (
        select(ObservationRow.motor, func.min(ObservationRow.time_ns))
        .join(MotorRow, MotorRow.name == ObservationRow.motor)
        .where(
            MotorRow.bus == of_the_bus,
            MotorRow.name != motor,
            ObservationRow.time_ns.between(time_ns - NEIGHBOURS_WITHIN_NS, time_ns + NEIGHBOURS_WITHIN_NS),
        )
        .group_by(ObservationRow.motor)
    )
    for neighbour, from_ns in session.execute(neighbours).all():
        mark(session, neighbour, from_ns)
