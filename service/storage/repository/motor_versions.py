"""What the motors file says of each motor over time. An edit of it is an event of the motor's condition."""

import uuid
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from core.condition.events import EventKind
from service.audit.actions import AuditAction
from service.storage.engine import one_at_a_time
from service.storage.models import ConditionEventRow, ConditionRow, MotorVersionRow, ObservationRow
from service.storage.records import SERVICE, MotorVersion
from service.storage.repository.audit.entries import note_change
from service.storage.repository.audit.values import changed
from service.storage.repository.conditions.fold_marks import EARLIEST_NS, mark
from service.storage.repository.sessions import Sessions, found, record_of

MACHINE = ("nameplate", "parameters", "tolerances", "wound_rotor")
"""Tables of the motors file that tell which machine it is: an edit counts from then on."""
TYPICAL = "typical"
"""Source of parameters that were never measured. Those that replace them have always been the motor's."""

MOTORS_FILE = "motors file"
"""Who tells of an edit."""


class MotorVersionRows(Sessions):
    def motor_versions(self, motor: str) -> tuple[MotorVersion, ...]:
        """Return what the motors file said of a motor, oldest first."""
        with self._read() as session:
            return tuple(record_of(MotorVersion, row) for row in _rows(session, motor))

    def note_motors(self, documents: Mapping[str, Mapping[str, Any]], *, now_ns: int) -> None:
        """Compare what the motors file says with what it said, and have conditions follow where it differs.

        documents: of each motor, a table of figures by the name of the table in the file.

        Other figures of the machine count from now on, and are an event. Another class of the sensors, and
        another stator winding, have always been so: all is folded again. So have parameters that take the
        place of typical ones. Another limit counts from the latest record on.
        Raises NotFoundError.
        """
        with self._write() as session:
            one_at_a_time(session.connection(), "sync plant")
            for motor, document in sorted(documents.items()):
                found(session, ConditionRow, motor, "motor")
                _note(session, motor, document, now_ns)


def _note(session: Session, motor: str, document: Mapping[str, Any], now_ns: int) -> None:
    versions = _rows(session, motor)
    if not versions:
        session.add(MotorVersionRow(motor=motor, from_ns=EARLIEST_NS, document=document))
        return
    latest = versions[-1]
    before: Mapping[str, Any] = latest.document
    if before == document:
        return
    was, now = changed(_figures(before), _figures(document))
    action = AuditAction.PARAMETERS_CHANGED
    note_change(session, SERVICE, action, ("motor", motor), now_ns=now_ns, before=was, after=now)
    for version in versions:
        others = {table: figures for table, figures in document.items() if table not in MACHINE}
        of_machine = {table: figures for table, figures in version.document.items() if table in MACHINE}
        version.document = {**of_machine, **others}
    if any(before.get(table) != document.get(table) for table in ("sensors", "winding")):
        mark(session, motor, EARLIEST_NS)
    latest_ns = session.scalar(select(func.max(ObservationRow.time_ns)).where(ObservationRow.motor == motor))
    if latest_ns is not None and before.get("limits") != document["limits"]:
        mark(session, motor, latest_ns)
    edits = list(_edits(before, document))
    if edits and _source(before) == TYPICAL and before["nameplate"] == document["nameplate"]:
        for version in versions:
            if _source(version.document) == TYPICAL:
                version.document = document
        if latest_ns is not None:
            mark(session, motor, EARLIEST_NS)
        return
    if not edits:
        latest.document = document  # the table of a rotor's winding may have come or gone
        return
    if latest_ns is None or latest.from_ns == now_ns:  # no record has seen the machine as it was
        latest.document = document
        return
    session.add(MotorVersionRow(motor=motor, from_ns=now_ns, document=document))
    session.add(
        ConditionEventRow(
            id=str(uuid.uuid4()),
            motor=motor,
            time_ns=now_ns,
            kind=EventKind.PARAMETERS_EDITED,
            reason=", ".join(edits),
            account=SERVICE.name,
            by=MOTORS_FILE,
            made_ns=now_ns,
        )
    )
    mark(session, motor, now_ns)


def _figures(document: Mapping[str, Any]) -> dict[str, object]:
    """Return all figures of all tables, by the names of both."""
    return {
        f"{table}.{name}": value for table, figures in document.items() for name, value in figures.items()
    }


def _edits(before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[str]:
    for table in MACHINE:
        if table not in before:
            continue
        for name, value in after.get(table, {}).items():
            old = before[table].get(name)
            if old != value:
                yield f"{name} {value} instead of {old}"


def _source(document: Mapping[str, Any]) -> str:
    return str(document["tolerances"]["source"])


def _rows(session: Session, motor: str) -> Sequence[MotorVersionRow]:
    query = select(MotorVersionRow).where(MotorVersionRow.motor == motor).order_by(MotorVersionRow.from_ns)
    return session.scalars(query).all()
