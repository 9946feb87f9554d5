"""Records that relays list: announced the first time, and linked to the recordings that they become."""

import uuid
from collections.abc import Callable, Collection, Iterator
from dataclasses import astuple
from typing import TypeVar

from sqlalchemy import ColumnElement, Select, and_, select, tuple_
from sqlalchemy.orm import Session

from service.storage.models import (
    DeletedRemoteRecordRow,
    IedRow,
    MotorRow,
    RecordingRequestRow,
    RecordingRow,
    RemoteRecordRow,
)
from service.storage.records import RecordingEntry, RemoteRecord
from service.storage.repository.recordings.requests import KIND, fail_row
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import RecordingSource, RecordingState
from service.storage.texts import storable

Listed = TypeVar("Listed")
Held = TypeVar("Held")

RECORDS_A_QUERY = 500
"""Databases limit how many values a query may hold."""


class RemoteRecordRows(Sessions):
    def remote_recordings(
        self, relay: str, remotes: Collection[RemoteRecord]
    ) -> dict[RemoteRecord, RecordingEntry]:
        """Return the recordings of those of a relay's records that were seen before.

        What is read grows with the records asked for, not with what the relay listed in all its years.
        """
        query = select(RemoteRecordRow, RecordingRow).join(
            RecordingRow, RecordingRow.id == RemoteRecordRow.recording_id
        )
        with self._read() as session:
            return {
                record_of(RemoteRecord, row): record_of(RecordingEntry, held)
                for row, held in of_records(session, query, RemoteRecordRow, relay, remotes)
            }

    def announced_remote_records(self, relay: str) -> frozenset[RemoteRecord]:
        """Return a relay's records that were seen and are neither stored nor refused."""
        query = (
            select(RemoteRecordRow)
            .join(RecordingRow, RecordingRow.id == RemoteRecordRow.recording_id)
            .where(RemoteRecordRow.ied == relay, RecordingRow.state == RecordingState.ANNOUNCED)
        )
        with self._read() as session:
            return frozenset(record_of(RemoteRecord, row) for row in session.scalars(query))

    def unfetched_names(self, relay: str, *, seen_before_ns: int) -> frozenset[str]:
        """Return the names of records seen before a time that are neither stored nor refused yet."""
        query = (
            select(RemoteRecordRow.name)
            .join(RecordingRow, RecordingRow.id == RemoteRecordRow.recording_id)
            .where(
                RemoteRecordRow.ied == relay,
                RecordingRow.state == RecordingState.ANNOUNCED,
                RecordingRow.announced_ns < seen_before_ns,
            )
        )
        with self._read() as session:
            return frozenset(session.scalars(query))

    def give_up_remote_record(self, relay: str, remote: RemoteRecord, reason: str) -> None:
        """Reject an announced record that its relay no longer lists; it is new if listed again."""
        with self._write() as session:
            link = remote_link(session, relay, remote)
            if link is None:
                return
            row = found(session, RecordingRow, link.recording_id, "recording")
            if row.state is RecordingState.ANNOUNCED:
                row.state = RecordingState.REJECTED
                row.reason = storable(reason)
                session.delete(link)

    def announce_recording(
        self, relay: str, motor: str, remote: RemoteRecord, *, now_ns: int
    ) -> RecordingEntry:
        """Return the recording of what a relay lists, announced unless known. Raises NotFoundError."""
        with self._write() as session:
            return record_of(RecordingEntry, recording_of(session, relay, motor, remote, now_ns))

    def note_failed_pull(
        self, relay: str, motor: str, remote: RemoteRecord, reason: str, *, now_ns: int
    ) -> int:
        """Count a pull that failed and will be tried again; return how many there were."""
        with self._write() as session:
            row = recording_of(session, relay, motor, remote, now_ns)
            if row.state is RecordingState.ANNOUNCED:
                row.attempts += 1
                row.reason = storable(reason)
            return row.attempts

    def reject_remote_record(
        self,
        relay: str,
        motor: str,
        remote: RemoteRecord,
        reason: str,
        *,
        now_ns: int,
        recording_request_id: str | None = None,
    ) -> RecordingEntry:
        """Refuse a record for good without storing it (too large, incomplete): it is not pulled again.

        The request that waited for it fails with the same reason.
        """
        with self._write() as session:
            row = recording_of(session, relay, motor, remote, now_ns)
            if row.state is RecordingState.ANNOUNCED:
                row.state = RecordingState.REJECTED
                row.reason = storable(reason)
            if recording_request_id is not None:
                fail_row(
                    found(session, RecordingRequestRow, recording_request_id, KIND, lock=True), reason, now_ns
                )
            return record_of(RecordingEntry, row)


def of_records(
    session: Session,
    query: Select[Listed, Held],
    table: type[RemoteRecordRow | DeletedRemoteRecordRow],
    relay: str,
    remotes: Collection[RemoteRecord],
) -> Iterator[tuple[Listed, Held]]:
    """Yield what the query finds where a row of the table is one of these records of the relay."""
    asked = list(remotes)
    for first in range(0, len(asked), RECORDS_A_QUERY):
        some = asked[first : first + RECORDS_A_QUERY]
        yield from session.execute(query.where(_listed_in(table, relay, some)))


def _listed_in(
    table: type[RemoteRecordRow | DeletedRemoteRecordRow], relay: str, remotes: Collection[RemoteRecord]
) -> ColumnElement[bool]:
    """Return the condition that a row of the table is one of these records of the relay."""
    # The names let the primary key be searched; the whole key keeps out others of these names.
    return and_(
        table.ied == relay,
        table.name.in_({remote.name for remote in remotes}),
        tuple_(table.name, table.size_bytes, table.modified_ns).in_([astuple(remote) for remote in remotes]),
    )


def remote_link(session: Session, relay: str, remote: RemoteRecord) -> RemoteRecordRow | None:
    return session.get(RemoteRecordRow, (relay, remote.name, remote.size_bytes, remote.modified_ns))


def recording_of(session: Session, relay: str, motor: str, remote: RemoteRecord, now_ns: int) -> RecordingRow:
    """Return the recording of what the relay lists, whatever became of it; announce it the first time."""
    found(session, MotorRow, motor, "motor", lock=True)
    link = remote_link(session, relay, remote)
    if link is None:
        return _announce(session, relay, motor, remote, now_ns)
    return found(session, RecordingRow, link.recording_id, "recording")


def recording_to_fill(
    session: Session,
    relay: str,
    motor: str,
    remote: RemoteRecord,
    now_ns: int,
    fill: Callable[[RecordingRow], None],
) -> RecordingRow:
    """Return the recording that new content belongs to, filled: not one that holds other content already."""
    found(session, MotorRow, motor, "motor", lock=True)
    link = remote_link(session, relay, remote)
    row = None if link is None else found(session, RecordingRow, link.recording_id, "recording")
    if row is None or row.digest is not None:
        return _announce(session, relay, motor, remote, now_ns, link, fill)
    fill(row)
    return row


def _announce(
    session: Session,
    relay: str,
    motor: str,
    remote: RemoteRecord,
    now_ns: int,
    link: RemoteRecordRow | None = None,
    fill: Callable[[RecordingRow], None] = lambda _row: None,
) -> RecordingRow:
    found(session, IedRow, relay, "relay")
    row = RecordingRow(
        id=str(uuid.uuid4()),
        motor=motor,
        ied=relay,
        source=RecordingSource.RELAY,
        name=remote.name,
        size_bytes=remote.size_bytes,
        remote_modified_ns=remote.modified_ns,
        state=RecordingState.ANNOUNCED,
        attempts=0,
        announced_ns=now_ns,
    )
    fill(row)
    session.add(row)
    session.flush()
    _link(session, relay, remote, row, link)
    deleted = session.get(DeletedRemoteRecordRow, (relay, *astuple(remote)))
    if deleted is not None:  # a relay without times: this record only looks like the one that was deleted
        session.delete(deleted)
    return row


def link_remote_record(session: Session, relay: str, remote: RemoteRecord, row: RecordingRow) -> None:
    """Link what the relay lists to the recording; an announcement that this replaces is deleted."""
    _link(session, relay, remote, row, remote_link(session, relay, remote))


def _link(
    session: Session, relay: str, remote: RemoteRecord, row: RecordingRow, link: RemoteRecordRow | None
) -> None:
    if link is None:
        session.add(
            RemoteRecordRow(
                ied=relay,
                name=remote.name,
                size_bytes=remote.size_bytes,
                modified_ns=remote.modified_ns,
                recording_id=row.id,
            )
        )
    elif link.recording_id != row.id:
        replaced = found(session, RecordingRow, link.recording_id, "recording")
        link.recording_id = row.id
        session.flush()
        if replaced.state is RecordingState.ANNOUNCED:
            session.delete(replaced)
    session.flush()
