"""Recordings: stored records of relays and uploads, queued for diagnosis in the same transaction."""

import uuid
from dataclasses import dataclass
from functools import partial

from sqlalchemy import ColumnElement, bindparam, delete, func, literal_column, select
from sqlalchemy.orm import Session

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.operation import Operation
from service.audit.actions import AuditAction
from service.recording_store.recording import StoredRecording
from service.storage.errors import TooManyWaitingError
from service.storage.models import (
    IedRow,
    JobRow,
    MotorRow,
    RecordingFileRow,
    RecordingRequestRow,
    RecordingRow,
)
from service.storage.records import Cursor, Page, RecordingEntry, RecordingFile, RemoteRecord
from service.storage.records.actors import SERVICE, Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.recordings.folders import discard_folder, require_folder
from service.storage.repository.recordings.requests import KIND, diagnose_rows, fail_rows, fetch_row
from service.storage.repository.relays.clocks import give_clock
from service.storage.repository.relays.remote_records import link_remote_record, recording_to_fill
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
from service.storage.states import JobPriority, JobState, RecordingSource, RecordingState

# Nearly every record is new: one look says so.
_HAS_CONTENT = (
    select(RecordingFileRow.recording_id)
    .where(RecordingFileRow.sha256.in_(bindparam("contents", expanding=True)))
    .limit(1)
)


@dataclass(frozen=True, slots=True)
class AddedRecording:
    """`created` is False when the same record was stored before: nothing was doubled."""

    recording: RecordingEntry
    created: bool


class RecordingRows(Sessions):
    def add_recording(
        self,
        stored: StoredRecording,
        *,
        motor: str,
        by: Actor = SERVICE,
        now_ns: int,
        relay: str | None = None,
        remote: RemoteRecord | None = None,
        recording_request_id: str | None = None,
        method: str = DEFAULT_METHOD,
        model: str = DEFAULT_MODEL,
        most_queued: int | None = None,
    ) -> AddedRecording:
        """Add a record whose files are stored: its row, its first job and its request, all or nothing.

        A recording from a relay needs `relay` and `remote`; an uploaded one needs neither. Two recordings of
        a relay are the same if their names and waveforms are: a file that only describes the waveform may
        come late and is then added. If one of two recordings of a motor was uploaded, the waveform is enough.
        The request gets what its relay had not sent before: a record that is listed again, under another
        time, is none that a trigger made. A folder that nothing needs after all is discarded.

        by: who uploads it. most_queued: so many diagnoses of the motor may be queued; beyond that nothing new
        is added. Raises NotFoundError, StateConflictError, TooManyWaitingError, FolderGoneError.
        """
        if (relay is None) != (remote is None):
            raise ValueError("a recording comes from a relay (relay and remote) or is uploaded (neither)")
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            row = stored_before(session, motor, relay, remote.name if remote else stored.name, stored)
            created = row is None
            sent_before = row is not None and row.ied is not None
            if row is None:
                require_folder(session, stored)
                if most_queued is not None:
                    require_room(session, motor, most_queued)
                if relay is None or remote is None:
                    row = brought(session, motor, stored.name, RecordingSource.UPLOAD, now_ns)
                    _fill(session, row, stored, now_ns)
                else:
                    filling = partial(_fill, session, stored=stored, now_ns=now_ns)
                    row = recording_to_fill(session, relay, motor, remote, now_ns, filling)
                session.flush()
                list_files(session, row, stored)
                priority = JobPriority.UPLOAD if relay is None else JobPriority.RELAY_RECORD
                session.add(new_job(row, method, model, priority, now_ns))
                if relay is None:
                    _note_upload(session, by, row, now_ns)
            elif relay is not None and remote is not None:
                link_remote_record(session, relay, remote, row)
                if row.ied == relay:
                    _complete(session, row, stored, now_ns)
            if not created:
                discard_folder(session, stored.digest, now_ns)
            if recording_request_id is not None and not sent_before:
                _attach(session, recording_request_id, row, now_ns)
            return AddedRecording(recording(row), created)

    def recording(self, recording_id: str) -> RecordingEntry:
        """Return a recording by its id. Raises NotFoundError."""
        with self._read() as session:
            return recording(found(session, RecordingRow, recording_id, "recording"))

    def recording_files(self, recording_id: str) -> tuple[RecordingFile, ...]:
        query = (
            select(RecordingFileRow)
            .where(RecordingFileRow.recording_id == recording_id)
            .order_by(RecordingFileRow.name)
        )
        with self._read() as session:
            return tuple(record_of(RecordingFile, row) for row in session.scalars(query))

    def recordings(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        motor: str | None = None,
        state: RecordingState | None = None,
        operation: Operation | None = None,
    ) -> Page[RecordingEntry]:
        """Return a page of recordings, of one motor or all, in one state or any, latest first.

        operation: only those in which the motor does this.
        """
        query = select(*columns_of(RecordingEntry, RecordingRow))
        if motor is not None:
            query = query.where(RecordingRow.motor == motor)
        if state is not None:
            query = query.where(RecordingRow.state == state)
        if operation is not None:
            query = query.where(RecordingRow.operation == operation)
        order: Order = [RecordingRow.announced_ns, RecordingRow.id]
        with self._read() as session:
            return page_of(session, query, order, RecordingEntry, limit=limit, after=after, descending=True)


def _note_upload(session: Session, by: Actor, row: RecordingRow, now_ns: int) -> None:
    after = {"motor": row.motor, "name": row.name, "digest": row.digest, "size_bytes": row.size_bytes}
    action = AuditAction.RECORDING_UPLOADED
    note_change(session, by, action, ("recording", row.id), now_ns=now_ns, after=after)


def require_room(session: Session, motor: str, most_queued: int) -> None:
    """Raise TooManyWaitingError where so many diagnoses of the motor are queued."""
    found(session, MotorRow, motor, "motor", lock=True)
    # The state as a literal: SQLite takes the index of the queued jobs for no parameter.
    queued = select(JobRow.id).where(
        JobRow.state == literal_column(f"'{JobState.QUEUED}'"), JobRow.motor == motor
    )
    if has_as_many(session, queued, most_queued):
        raise TooManyWaitingError(motor, "queued diagnoses", most_queued, "max_queued_diagnoses")


def new_job(row: RecordingRow, method: str, model: str, priority: JobPriority, now_ns: int) -> JobRow:
    return JobRow(
        id=str(uuid.uuid4()),
        recording_id=row.id,
        motor=row.motor,
        method=method,
        model=model,
        state=JobState.QUEUED,
        priority=priority,
        attempts=0,
        not_before_ns=now_ns,
        created_ns=now_ns,
    )


def stored_before(
    session: Session, motor: str, relay: str | None, name: str, stored: StoredRecording
) -> RecordingRow | None:
    if session.scalar(_HAS_CONTENT, {"contents": [file.sha256 for file in stored.waveform_files]}) is None:
        return None
    if relay is None:
        return _of_the_same_waveform(session, motor, stored)
    same_name = (RecordingRow.ied == relay, RecordingRow.name == name)
    same = select(RecordingRow).where(*same_name, RecordingRow.digest == stored.digest)
    return (
        only(session, same)
        or _of_the_same_waveform(session, motor, stored, *same_name)
        or _of_the_same_waveform(session, motor, stored, RecordingRow.ied.is_(None))
    )


def _of_the_same_waveform(
    session: Session, motor: str, stored: StoredRecording, *further: ColumnElement[bool]
) -> RecordingRow | None:
    """Return the recording of the motor with the same waveform, whatever its files are called.

    Whoever fetches a record on site may rename its files, and leave out those that only describe it.
    """
    contents = {file.sha256 for file in stored.waveform_files}
    holders = (
        select(RecordingFileRow.recording_id)
        .where(RecordingFileRow.sha256.in_(contents))
        .group_by(RecordingFileRow.recording_id)
        .having(func.count(RecordingFileRow.sha256.distinct()) == len(contents))
    )
    query = select(RecordingRow).where(RecordingRow.motor == motor, RecordingRow.id.in_(holders), *further)
    return only(session, query.order_by(RecordingRow.announced_ns, RecordingRow.id))


def brought(session: Session, motor: str, name: str, source: RecordingSource, now_ns: int) -> RecordingRow:
    """Add the row of a recording that comes from no relay, still without its files."""
    row = RecordingRow(
        id=str(uuid.uuid4()),
        motor=motor,
        source=source,
        name=name,
        size_bytes=0,
        state=RecordingState.ANNOUNCED,
        attempts=0,
        announced_ns=now_ns,
    )
    session.add(row)
    return row


def fill(session: Session, row: RecordingRow, stored: StoredRecording, now_ns: int) -> None:
    """Give a recording its files."""
    _fill(session, row, stored, now_ns)
    session.flush()
    list_files(session, row, stored)


def _fill(session: Session, row: RecordingRow, stored: StoredRecording, now_ns: int) -> None:
    row.digest = stored.digest
    row.size_bytes = stored.size_bytes
    row.state = RecordingState.FETCHED
    row.reason = None
    row.fetched_ns = now_ns
    if row.ied is not None:
        give_clock(row, found(session, IedRow, row.ied, "relay"))


def _complete(session: Session, row: RecordingRow, stored: StoredRecording, now_ns: int) -> None:
    """Add the files that had not come yet with the same waveform."""
    listed = select(RecordingFileRow.name).where(RecordingFileRow.recording_id == row.id)
    if not {file.name for file in stored.files} > set(session.scalars(listed)):
        return
    require_folder(session, stored)
    session.execute(delete(RecordingFileRow).where(RecordingFileRow.recording_id == row.id))
    before = row.digest
    row.digest = stored.digest
    row.size_bytes = stored.size_bytes
    list_files(session, row, stored)
    if before is not None:
        discard_folder(session, before, now_ns)


def list_files(session: Session, row: RecordingRow, stored: StoredRecording) -> None:
    for file in stored.files:
        session.add(
            RecordingFileRow(
                recording_id=row.id, name=file.name, size_bytes=file.size_bytes, sha256=file.sha256
            )
        )
    session.flush()


def _attach(session: Session, recording_request_id: str, row: RecordingRow, now_ns: int) -> None:
    """Give the request its recording, and its end where the recording has come to one already."""
    fetch_row(found(session, RecordingRequestRow, recording_request_id, KIND, lock=True), row.id, now_ns)
    session.flush()
    if row.state is RecordingState.DIAGNOSED:
        diagnose_rows(session, row.id, now_ns)
    elif row.state in (RecordingState.REJECTED, RecordingState.FAILED):
        fail_rows(session, row.id, row.reason or str(row.state), now_ns)


def recording(row: RecordingRow) -> RecordingEntry:
    return record_of(RecordingEntry, row)
