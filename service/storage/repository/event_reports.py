"""Event reports: what somebody asked a relay to record, followed to its end."""

import uuid

from sqlalchemy import exists, select
from sqlalchemy.orm import Session

from service.storage.errors import OutOfServiceError, StateConflictError
from service.storage.models import EventReportRow, IedRow, LeaseRow, MotorRow
from service.storage.records import Cursor, EventReport, Page
from service.storage.repository.leases import require_lease
from service.storage.repository.sessions import Order, Sessions, found, only, page_of, record_of
from service.storage.states import IN_THE_RELAY, EventReportOrigin, EventReportState

OPEN = (EventReportState.REQUESTED, *IN_THE_RELAY)
ENDED = (EventReportState.DIAGNOSED, EventReportState.FAILED)


class EventReportRows(Sessions):
    def request_event_report(
        self, motor: str, *, now_ns: int, idempotency_key: str | None = None
    ) -> EventReport:
        """A new wish for an event recording of a motor; the same key again gives the first one's report.

        Raises NotFoundError, OutOfServiceError for a motor that left the plant.
        """
        with self._write() as session:
            where = found(session, MotorRow, motor, "motor")
            if idempotency_key is not None:
                same = select(EventReportRow).where(
                    EventReportRow.motor == motor, EventReportRow.idempotency_key == idempotency_key
                )
                earlier = only(session, same)
                if earlier is not None:
                    return event_report(earlier)
            if not where.in_service:
                raise OutOfServiceError("motor", motor)
            return _request(session, where, EventReportOrigin.REQUEST, idempotency_key, now_ns)

    def schedule_event_report(self, motor: str, *, due_ns: int, now_ns: int) -> EventReport | None:
        """The report a motor's schedule asks for at `due_ns`, however often that is told.

        None, and no report, while an earlier one waits for its record: triggers must not pile up at a relay
        that makes none. Nor for a motor that left the plant. Raises NotFoundError.
        """
        key = f"schedule {due_ns}"
        of_motor = select(EventReportRow).where(EventReportRow.motor == motor)
        with self._write() as session:
            where = found(session, MotorRow, motor, "motor")
            earlier = only(session, of_motor.where(EventReportRow.idempotency_key == key))
            if earlier is not None:
                return event_report(earlier)
            is_open = of_motor.where(EventReportRow.state.in_(OPEN))
            if not where.in_service or only(session, is_open) is not None:
                return None
            return _request(session, where, EventReportOrigin.SCHEDULE, key, now_ns)

    def event_report(self, report_id: str) -> EventReport:
        """Raises NotFoundError."""
        with self._read() as session:
            return event_report(found(session, EventReportRow, report_id, "event report"))

    def event_reports(
        self, *, limit: int, after: Cursor | None = None, motor: str | None = None
    ) -> Page[EventReport]:
        """Latest first; of one motor or of all."""
        query = select(EventReportRow)
        if motor is not None:
            query = query.where(EventReportRow.motor == motor)
        order: Order = [EventReportRow.requested_ns, EventReportRow.id]
        with self._read() as session:
            return page_of(session, query, order, event_report, limit=limit, after=after, descending=True)

    def ieds_with_requests(self) -> tuple[str, ...]:
        """Relays that have a trigger to be given now: none that still owe the record of an earlier one."""
        # Two looks into the index a relay: what was asked for in all those years does not matter.
        waiting, outstanding = (
            exists().where(EventReportRow.ied == IedRow.name, EventReportRow.state.in_(states))
            for states in ((EventReportState.REQUESTED,), IN_THE_RELAY)
        )
        query = select(IedRow.name).where(waiting, ~outstanding).order_by(IedRow.name)
        with self._read() as session:
            return tuple(session.scalars(query))

    def open_event_reports(self, ied: str) -> tuple[EventReport, ...]:
        """Reports of a relay that have no recording yet, oldest first: what to go on with after a restart."""
        query = (
            select(EventReportRow)
            .where(EventReportRow.ied == ied, EventReportRow.state.in_(OPEN))
            .order_by(EventReportRow.requested_ns, EventReportRow.id)
        )
        with self._read() as session:
            return tuple(event_report(row) for row in session.scalars(query))

    def all_open_event_reports(self) -> tuple[EventReport, ...]:
        """Of every relay, one that left the plant included."""
        # By relay, which the index begins with: those long ended do not matter.
        query = select(EventReportRow).where(
            EventReportRow.ied.in_(select(IedRow.name)), EventReportRow.state.in_(OPEN)
        )
        with self._read() as session:
            return tuple(event_report(row) for row in session.scalars(query))

    def give_up_unvisited(self, report: EventReport, reason: str, *, now_ns: int) -> bool:
        """Fails a report that is as it was seen. Raises NotFoundError.

        False, and nothing is changed, where its state is another by now or a gateway holds its relay.
        """
        with self._write() as session:
            row = found(session, EventReportRow, report.id, "event report")
            if row.state is not report.state or session.get(LeaseRow, row.ied) is not None:
                return False
            fail_row(row, reason, now_ns)
            return True

    def mark_triggered(self, report_id: str, *, now_ns: int, gateway: str | None = None) -> EventReport:
        """The relay is about to be triggered, by the gateway that holds its lease.

        Raises NotFoundError, StateConflictError, LeaseLostError where that gateway does not hold it.
        """
        with self._write() as session:
            row = found(session, EventReportRow, report_id, "event report")
            if gateway is not None:
                require_lease(session, row.ied, gateway)
            if _advances(row, {EventReportState.REQUESTED}, EventReportState.TRIGGERED):
                row.triggered_ns = now_ns
            return event_report(row)

    def mark_recorded(self, report_id: str, *, now_ns: int) -> EventReport:
        """The relay reported the record. Raises NotFoundError, StateConflictError."""
        with self._write() as session:
            row = found(session, EventReportRow, report_id, "event report")
            before = {EventReportState.REQUESTED, EventReportState.TRIGGERED}
            if _advances(row, before, EventReportState.RECORDED):
                row.recorded_ns = now_ns
            return event_report(row)

    def fail_event_report(self, report_id: str, reason: str, *, now_ns: int) -> EventReport:
        """Gives a report up, with the reason. Raises NotFoundError, StateConflictError (has ended)."""
        with self._write() as session:
            row = found(session, EventReportRow, report_id, "event report")
            fail_row(row, reason, now_ns)
            return event_report(row)


def _request(
    session: Session, motor: MotorRow, origin: EventReportOrigin, key: str | None, now_ns: int
) -> EventReport:
    row = EventReportRow(
        id=str(uuid.uuid4()),
        motor=motor.name,
        ied=motor.ied,
        origin=origin,
        state=EventReportState.REQUESTED,
        idempotency_key=key,
        requested_ns=now_ns,
    )
    session.add(row)
    session.flush()
    return event_report(row)


def _advances(row: EventReportRow, before: set[EventReportState], wanted: EventReportState) -> bool:
    """Moves a report on; False when it is there already, so that a repeated step changes nothing."""
    if row.state is wanted:
        return False
    if row.state not in before:
        raise StateConflictError("event report", row.id, present=row.state, wanted=wanted)
    row.state = wanted
    return True


def fetch_row(row: EventReportRow, recording_id: str, now_ns: int) -> None:
    """The report's recording is stored. Raises StateConflictError."""
    if row.recording_id == recording_id:
        return
    if _advances(row, set(OPEN), EventReportState.FETCHED):
        row.recording_id = recording_id
        row.fetched_ns = now_ns


def diagnose_rows(session: Session, recording_id: str, now_ns: int) -> None:
    """Ends the reports that waited for this recording's diagnosis."""
    for row in _waiting_for(session, recording_id):
        row.state = EventReportState.DIAGNOSED
        row.diagnosed_ns = now_ns


def fail_rows(session: Session, recording_id: str, reason: str, now_ns: int) -> None:
    """Ends the reports that waited for this recording, with the reason it has no diagnosis."""
    for row in _waiting_for(session, recording_id):
        fail_row(row, reason, now_ns)


def fail_row(row: EventReportRow, reason: str, now_ns: int) -> None:
    before = set(EventReportState) - set(ENDED)
    if _advances(row, before, EventReportState.FAILED):
        row.reason = reason
        row.failed_ns = now_ns


def _waiting_for(session: Session, recording_id: str) -> list[EventReportRow]:
    query = select(EventReportRow).where(
        EventReportRow.recording_id == recording_id, EventReportRow.state.not_in(ENDED)
    )
    return list(session.scalars(query))


def event_report(row: EventReportRow) -> EventReport:
    return record_of(EventReport, row)
