"""What the starts of a motor are compared with, and its latest ones."""

from collections.abc import Sequence
from typing import Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.condition.events import EventKind
from core.starts.changes import REFERENCE_STARTS
from service.storage.models import ConditionEventRow, MotorRow, StartRow
from service.storage.records import ConditionEvent, StartEntry, StartReference
from service.storage.repository.history.start_documents import start_entry
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import StartSource

LOOKED_AT: Final = 10 * REFERENCE_STARTS
"""Starts among which the first whole ones are looked for."""
MOST_EVENTS: Final = 1000
"""Latest events of a motor among which one that begins the reference anew is looked for."""
RENEWING: Final = (EventKind.REWOUND, EventKind.REFERENCE_RESTARTED, EventKind.RECORDER_CHANGED)
"""After these a start is compared with the first ones that come then."""


class StartReferenceRows(Sessions):
    def first_whole_starts(
        self, motor: str, *, from_ns: int, source: StartSource = StartSource.RECORDING
    ) -> Sequence[StartEntry]:
        """Return the first few starts of a motor from a time on that are told from rest to speed.

        They are looked for among the first `LOOKED_AT` of that source, however many a motor has.
        """
        with self._read() as session:
            return first_whole(session, motor, from_ns=from_ns, source=source)

    def start_reference(self, motor: str) -> StartReference:
        """Return what the starts of a motor are compared with. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return reference_of(session, motor)


def reference_of(session: Session, motor: str) -> StartReference:
    """Return what the starts of a motor are compared with."""
    # No index has the kinds of events. The limit keeps a motor with many notes from holding up others.
    latest = (
        select(ConditionEventRow.id, ConditionEventRow.kind, ConditionEventRow.withdrawn_ns)
        .where(ConditionEventRow.motor == motor)
        .order_by(ConditionEventRow.time_ns.desc(), ConditionEventRow.id.desc())
        .limit(MOST_EVENTS)
    )
    renewing = (
        one.id for one in session.execute(latest) if one.kind in RENEWING and one.withdrawn_ns is None
    )
    event_id = next(renewing, None)
    row = None if event_id is None else session.get(ConditionEventRow, event_id)
    renewed = None if row is None else record_of(ConditionEvent, row)
    from_ns = 0 if renewed is None else renewed.time_ns
    first = first_whole(session, motor, from_ns=from_ns, source=StartSource.RECORDING) or first_whole(
        session, motor, from_ns=from_ns, source=StartSource.REPORT
    )
    return StartReference(first, renewed)


def first_whole(session: Session, motor: str, *, from_ns: int, source: StartSource) -> Sequence[StartEntry]:
    """Return the first few starts from a time on that are told from rest to speed, by what tells of them."""
    query = (
        select(StartRow)
        .where(StartRow.motor == motor, StartRow.time_ns >= from_ns, StartRow.source == source)
        .order_by(StartRow.time_ns, StartRow.recording_id)
        .limit(LOOKED_AT)
    )
    rows = session.scalars(query).all()
    whole = [row for row in rows if row.is_from_rest and row.acceleration_s is not None]
    return [start_entry(row) for row in whole[:REFERENCE_STARTS]]


def latest_starts(session: Session, motor: str, limit: int) -> Sequence[StartEntry]:
    """Return the latest starts of a motor, latest first."""
    order = (StartRow.time_ns.desc(), StartRow.recording_id.desc())
    query = select(StartRow).where(StartRow.motor == motor).order_by(*order).limit(limit)
    return [start_entry(row) for row in session.scalars(query)]
