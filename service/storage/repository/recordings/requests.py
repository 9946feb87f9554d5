"""Recording requests: what somebody asked a relay to record, followed to its end.

The REST API calls them event reports, and so do the messages of errors. In this code an event report is a
file that a relay writes.
"""

import uuid

from sqlalchemy import Exists, exists, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.errors import OutOfServiceError, StateConflictError, TooManyWaitingError
from service.storage.models import (
    IedRow,
    LeaseRow,
    MotorRow,
    RecordingRequestRow,
    RecordingRow,
    StateCountRow,
)
from service.storage.records import Cursor, Page, RecordingRequest
from service.storage.records.actors import SERVICE, Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.conditions import note_standstill
from service.storage.repository.relays.leases import require_lease
from service.storage.repository.sessions import (
    Order,
    Sessions,
    columns_of,
    found,
    has_as_many,
    only,
    page_of,
    record_of,
)
from service.storage.states import IN_THE_RELAY, RecordingRequestOrigin, RecordingRequestState
from service.storage.texts import storable

OPEN = (RecordingRequestState.REQUESTED, *IN_THE_RELAY)
ENDED = (
    RecordingRequestState.DIAGNOSED,
    RecordingRequestState.FAILED,
    RecordingRequestState.SKIPPED,
)

KIND = "event report"
"""Error messages call a recording request by this name."""

# Every gateway looks a few times a second: nearly always the count that is kept says that there is nothing.
_REQUESTED = select(StateCountRow.number).where(
    StateCountRow.counted_table == RecordingRequestRow.__tablename__,
    StateCountRow.state == RecordingRequestState.REQUESTED,
)


def _has_requests(*states: RecordingRequestState) -> Exists:
    """Take one look into the index: what was asked for in all those years does not matter."""
    return exists().where(RecordingRequestRow.ied == IedRow.name, RecordingRequestRow.state.in_(states))


_TO_BE_TRIGGERED = (
    select(IedRow.name)
    .where(_has_requests(RecordingRequestState.REQUESTED), ~_has_requests(*IN_THE_RELAY))
    .order_by(IedRow.name)
)


class RecordingRequestRows(Sessions):
    def request_recording(
        self,
        motor: str,
        *,
        by: Actor = SERVICE,
        now_ns: int,
        idempotency_key: str | None = None,
        most_open: int | None = None,
        seconds: float | None = None,
    ) -> RecordingRequest:
        """Request an event recording of a motor; the same key again gives the first one's request.

        seconds: request a series of recordings that make up so much time; None for one of the usual length.
        most_open: so many requests of the motor may wait for their record.

        Raises NotFoundError, OutOfServiceError for a motor that left the plant, TooManyWaitingError.
        """
        with self._write() as session:
            where = found(session, MotorRow, motor, "motor", lock=True)
            if idempotency_key is not None:
                earlier = _of_key(session, motor, RecordingRequestOrigin.REQUEST, idempotency_key)
                if earlier is not None:
                    return recording_request(earlier)
            if not where.in_service:
                raise OutOfServiceError("motor", motor)
            if most_open is not None:
                _require_room(session, where, most_open)
            origin = RecordingRequestOrigin.REQUEST
            made = _request(session, where, origin, idempotency_key, now_ns, seconds=seconds)
            note_change(
                session,
                by,
                AuditAction.RECORDING_REQUESTED,
                ("motor", motor),
                now_ns=now_ns,
                after={"request": made.id, "relay": where.ied}
                | ({} if seconds is None else {"seconds": seconds}),
            )
            return made

    def schedule_recording(
        self, motor: str, *, due_ns: int, now_ns: int, seconds: float | None = None
    ) -> RecordingRequest | None:
        """Request what a motor's schedule asks for at `due_ns`; asked again, it gives the same request.

        seconds: request a series that makes up so much time, which is due apart from the schedule.
        None, and no new request, while an earlier one waits for its record: triggers must not pile up at a
        relay that makes none. Nor is there one for a motor that left the plant. Raises NotFoundError.
        """
        key = f"schedule {due_ns}" if seconds is None else f"long record {due_ns}"
        with self._write() as session:
            where = found(session, MotorRow, motor, "motor", lock=True)
            earlier = _of_key(session, motor, RecordingRequestOrigin.SCHEDULE, key)
            if earlier is not None:
                return recording_request(earlier)
            is_open = select(RecordingRequestRow).where(
                RecordingRequestRow.motor == motor, RecordingRequestRow.state.in_(OPEN)
            )
            if not where.in_service or only(session, is_open) is not None:
                return None
            return _request(session, where, RecordingRequestOrigin.SCHEDULE, key, now_ns, seconds=seconds)

    def skip_recording(self, motor: str, reason: str, *, due_ns: int, now_ns: int) -> bool:
        """Note that what a motor's schedule asks for at `due_ns` is not recorded, since the motor stands.

        Returns False, and changes nothing, where that time was dealt with before or the motor left the plant.
        Raises NotFoundError.
        """
        key = f"schedule {due_ns}"
        with self._write() as session:
            where = found(session, MotorRow, motor, "motor", lock=True)
            if (
                not where.in_service
                or _of_key(session, motor, RecordingRequestOrigin.SCHEDULE, key) is not None
            ):
                return False
            _request(
                session,
                where,
                RecordingRequestOrigin.SCHEDULE,
                key,
                now_ns,
                state=RecordingRequestState.SKIPPED,
                reason=storable(reason),
            )
            note_standstill(session, motor, now_ns)
            return True

    def recording_request(self, request_id: str) -> RecordingRequest:
        """Return a recording request by its id. Raises NotFoundError."""
        with self._read() as session:
            return recording_request(found(session, RecordingRequestRow, request_id, KIND))

    def recording_requests(
        self, *, limit: int, after: Cursor | None = None, motor: str | None = None
    ) -> Page[RecordingRequest]:
        """Return a page of recording requests, of one motor or of all, latest first."""
        query = select(*columns_of(RecordingRequest, RecordingRequestRow))
        if motor is not None:
            query = query.where(RecordingRequestRow.motor == motor)
        order: Order = [RecordingRequestRow.requested_ns, RecordingRequestRow.id]
        with self._read() as session:
            return page_of(session, query, order, RecordingRequest, limit=limit, after=after, descending=True)

    def relays_with_requests(self) -> tuple[str, ...]:
        """Return the relays to be triggered now: none that still owes the record of an earlier trigger."""
        with self._read() as session:
            if not session.scalar(_REQUESTED):
                return ()
            return tuple(session.scalars(_TO_BE_TRIGGERED))

    def open_recording_requests(self, relay: str) -> tuple[RecordingRequest, ...]:
        """Return the requests to a relay that have no recording yet, oldest first.

        They are the work left after a restart.
        """
        query = (
            select(RecordingRequestRow)
            .where(RecordingRequestRow.ied == relay, RecordingRequestRow.state.in_(OPEN))
            .order_by(RecordingRequestRow.requested_ns, RecordingRequestRow.id)
        )
        with self._read() as session:
            return tuple(recording_request(row) for row in session.scalars(query))

    def all_open_recording_requests(self) -> tuple[RecordingRequest, ...]:
        """Return the requests without a recording, also those to relays that left the plant."""
        # By relay, which the index begins with: those long ended do not matter.
        query = select(RecordingRequestRow).where(
            RecordingRequestRow.ied.in_(select(IedRow.name)), RecordingRequestRow.state.in_(OPEN)
        )
        with self._read() as session:
            return tuple(recording_request(row) for row in session.scalars(query))

    def fail_orphaned_request(self, request: RecordingRequest, reason: str, *, now_ns: int) -> bool:
        """Fail a request that is still as it was seen. Raises NotFoundError.

        Returns False, and changes nothing, where its state is another by now or a gateway holds its relay.
        """
        with self._write() as session:
            row = found(session, RecordingRequestRow, request.id, KIND, lock=True)
            if row.state is not request.state or session.get(LeaseRow, row.ied) is not None:
                return False
            fail_row(row, reason, now_ns)
            return True

    def mark_triggered(
        self, request_id: str, *, now_ns: int, gateway: str | None = None, triggers: int | None = None
    ) -> RecordingRequest:
        """Note that the gateway that holds the relay's lease is about to trigger it.

        triggers: how often it will do so for a series.
        Raises NotFoundError, StateConflictError, LeaseLostError where that gateway does not hold it.
        """
        with self._write() as session:
            row = found(session, RecordingRequestRow, request_id, KIND, lock=True)
            if gateway is not None:
                require_lease(session, row.ied, gateway)
            if _advances(row, {RecordingRequestState.REQUESTED}, RecordingRequestState.TRIGGERED):
                row.triggered_ns = now_ns
                row.triggers = triggers
            return recording_request(row)

    def preceding_offset_ns(self, relay: str, triggered_ns: int) -> int | None:
        """Return how far the time of the relay's record was from its trigger, the time before [ns].

        relay: its name.  triggered_ns: trigger of the present record.  None where there is no earlier one.
        """
        offset = RecordingRow.recorded_ns - RecordingRequestRow.triggered_ns
        query = (
            select(offset)
            .select_from(RecordingRequestRow)
            .join(RecordingRow, RecordingRow.id == RecordingRequestRow.recording_id)
            .where(
                RecordingRequestRow.ied == relay,
                RecordingRequestRow.state == RecordingRequestState.DIAGNOSED,
                RecordingRequestRow.triggered_ns < triggered_ns,
                offset.is_not(None),
            )
            .order_by(RecordingRequestRow.requested_ns.desc())
            .limit(1)
        )
        with self._read() as session:
            return session.scalar(query)

    def mark_recorded(self, request_id: str, *, now_ns: int) -> RecordingRequest:
        """Note that the relay reported the record. Raises NotFoundError, StateConflictError."""
        with self._write() as session:
            row = found(session, RecordingRequestRow, request_id, KIND, lock=True)
            before = {RecordingRequestState.REQUESTED, RecordingRequestState.TRIGGERED}
            if _advances(row, before, RecordingRequestState.RECORDED):
                row.recorded_ns = now_ns
            return recording_request(row)

    def fail_recording_request(self, request_id: str, reason: str, *, now_ns: int) -> RecordingRequest:
        """Give a request up, with the reason. Raises NotFoundError, StateConflictError (has ended)."""
        with self._write() as session:
            row = found(session, RecordingRequestRow, request_id, KIND, lock=True)
            fail_row(row, reason, now_ns)
            return recording_request(row)


def _require_room(session: Session, motor: MotorRow, most_open: int) -> None:
    """Raise TooManyWaitingError where so many of the motor's requests wait for their record."""
    is_open = select(RecordingRequestRow.id).where(
        RecordingRequestRow.ied == motor.ied,
        RecordingRequestRow.motor == motor.name,
        RecordingRequestRow.state.in_(OPEN),
    )
    if has_as_many(session, is_open, most_open):
        what = "recording requests that wait for their record"
        raise TooManyWaitingError(motor.name, what, most_open, "max_open_requests")


def _of_key(
    session: Session, motor: str, origin: RecordingRequestOrigin, key: str
) -> RecordingRequestRow | None:
    """Return the motor's request of this key; a key of a client is never one of a schedule."""
    query = select(RecordingRequestRow).where(
        RecordingRequestRow.motor == motor,
        RecordingRequestRow.origin == origin,
        RecordingRequestRow.idempotency_key == key,
    )
    return only(session, query)


def _request(
    session: Session,
    motor: MotorRow,
    origin: RecordingRequestOrigin,
    key: str | None,
    now_ns: int,
    *,
    state: RecordingRequestState = RecordingRequestState.REQUESTED,
    reason: str | None = None,
    seconds: float | None = None,
) -> RecordingRequest:
    row = RecordingRequestRow(
        id=str(uuid.uuid4()),
        motor=motor.name,
        ied=motor.ied,
        origin=origin,
        state=state,
        reason=reason,
        idempotency_key=key,
        requested_ns=now_ns,
        seconds=seconds,
    )
    session.add(row)
    session.flush()
    return recording_request(row)


def _advances(
    row: RecordingRequestRow, before: set[RecordingRequestState], wanted: RecordingRequestState
) -> bool:
    """Move a request on; False when it is there already, so that a repeated step changes nothing."""
    if row.state is wanted:
        return False
    if row.state not in before:
        raise StateConflictError(KIND, row.id, present=row.state, wanted=wanted)
    row.state = wanted
    return True


def fetch_row(row: RecordingRequestRow, recording_id: str, now_ns: int) -> None:
    """Note that the requested recording is stored. Raises StateConflictError."""
    if row.recording_id == recording_id:
        return
    if _advances(row, set(OPEN), RecordingRequestState.FETCHED):
        row.recording_id = recording_id
        row.fetched_ns = now_ns


def diagnose_rows(session: Session, recording_id: str, now_ns: int) -> None:
    """End the requests that waited for this recording's diagnosis."""
    for row in _waiting_for(session, recording_id):
        row.state = RecordingRequestState.DIAGNOSED
        row.diagnosed_ns = now_ns


def fail_rows(session: Session, recording_id: str, reason: str, now_ns: int) -> None:
    """End the requests that waited for this recording, with the reason it has no diagnosis."""
    for row in _waiting_for(session, recording_id):
        fail_row(row, reason, now_ns)


def fail_row(row: RecordingRequestRow, reason: str, now_ns: int) -> None:
    before = set(RecordingRequestState) - set(ENDED)
    if _advances(row, before, RecordingRequestState.FAILED):
        row.reason = storable(reason)
        row.failed_ns = now_ns


def _waiting_for(session: Session, recording_id: str) -> list[RecordingRequestRow]:
    query = (
        select(RecordingRequestRow)
        .where(RecordingRequestRow.recording_id == recording_id, RecordingRequestRow.state.not_in(ENDED))
        .order_by(RecordingRequestRow.id)
        .with_for_update(key_share=True)
    )
    return list(session.scalars(query))


def recording_request(row: RecordingRequestRow) -> RecordingRequest:
    return record_of(RecordingRequest, row)
