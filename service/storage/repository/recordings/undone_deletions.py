"""Deletions that who made them undoes: the recording is there again under its id, and is diagnosed anew.

Its files are, because nothing removes a folder so soon after a person deleted its recording.
"""

from sqlalchemy import ColumnElement, and_, select
from sqlalchemy.orm import Session

from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from service.audit.actions import AuditAction
from service.recording_store.recording import StoredRecording
from service.storage.errors import DeletionStaysError
from service.storage.models import DeletedRemoteRecordRow, DeletionRow, MotorRow, RecordingRow
from service.storage.records import Deletion, RecordingEntry, RemoteRecord
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.recordings.folders import require_folder
from service.storage.repository.recordings.recordings import list_files, new_job, recording, stored_before
from service.storage.repository.relays.remote_records import link_remote_record
from service.storage.repository.sessions import Sessions, columns_of, found, record_of
from service.storage.states import DeletedBy, JobPriority, RecordingState


class UndoneDeletionRows(Sessions):
    def deleted_by(self, account: str, *, since_ns: int, limit: int) -> tuple[Deletion, ...]:
        """Return what somebody has deleted since a time and may have back, the latest first."""
        query = (
            select(*columns_of(Deletion, DeletionRow))
            .where(_has_files_since(since_ns), DeletionRow.account == account)
            .order_by(DeletionRow.deleted_ns.desc(), DeletionRow.id)
            .limit(limit)
        )
        with self._read() as session:
            return tuple(Deletion(*row) for row in session.execute(query))

    def deletion_to_undo(self, recording_id: str, *, by: Actor, since_ns: int) -> Deletion:
        """Return a deletion that somebody may undo. Raises NotFoundError, DeletionStaysError."""
        with self._read() as session:
            return record_of(Deletion, _to_undo(session, recording_id, by, since_ns))

    def undo_deletion(
        self, recording_id: str, stored: StoredRecording, *, by: Actor, since_ns: int, now_ns: int
    ) -> RecordingEntry:
        """Add a recording again that the same person has deleted since a time, and queue its diagnosis.

        It has its id, files, times and source again, and what its relay lists is linked to it. A request that
        ended because it was deleted has ended.

        stored: its files. Raises NotFoundError, DeletionStaysError, FolderGoneError.
        """
        with self._write() as session:
            motor = found(session, DeletionRow, recording_id, "deleted recording").motor
            found(session, MotorRow, motor, "motor", lock=True)
            deletion = _to_undo(session, recording_id, by, since_ns)
            there = stored_before(session, motor, deletion.ied, deletion.name, stored)
            if there is not None:
                raise DeletionStaysError(recording_id, f"its motor has it again, as recording {there.id}")
            require_folder(session, stored)
            row = RecordingRow(
                id=deletion.id,
                motor=deletion.motor,
                ied=deletion.ied,
                source=deletion.source,
                name=deletion.name,
                digest=stored.digest,
                size_bytes=deletion.size_bytes,
                remote_modified_ns=deletion.remote_modified_ns,
                state=RecordingState.FETCHED,
                attempts=0,
                announced_ns=deletion.announced_ns,
                fetched_ns=deletion.fetched_ns,
                recorded_ns=deletion.recorded_ns,
                clock_offset_ns=deletion.clock_offset_ns,
                clock_uncertainty_ns=deletion.clock_uncertainty_ns,
                clock_quality=deletion.clock_quality,
                clock_measured_ns=deletion.clock_measured_ns,
                parts=deletion.parts,
                joined_id=deletion.joined_id,
            )
            session.add(row)
            session.flush()
            list_files(session, row, stored)
            _link_again(session, row)
            session.add(new_job(row, DEFAULT_METHOD, DEFAULT_MODEL, JobPriority.UPLOAD, now_ns))
            note_change(
                session,
                by,
                AuditAction.RECORDING_DELETION_UNDONE,
                ("recording", recording_id),
                now_ns=now_ns,
                before={"reason": deletion.reason},
                after={"motor": row.motor, "name": row.name, "digest": row.digest},
            )
            session.delete(deletion)
            return recording(row)


def is_kept_for_undo(session: Session, digest: str, since_ns: int) -> bool:
    """Tell whether somebody may want a folder back: a person has deleted its recording since a time."""
    query = select(DeletionRow.id).where(_has_files_since(since_ns), DeletionRow.digest == digest)
    return session.scalars(query.limit(1)).first() is not None


def _has_files_since(since_ns: int) -> ColumnElement[bool]:
    return and_(
        DeletionRow.deleted_ns >= since_ns,
        DeletionRow.deleted_by == DeletedBy.PERSON,
        DeletionRow.digest.is_not(None),
    )


def _to_undo(session: Session, recording_id: str, by: Actor, since_ns: int) -> DeletionRow:
    deletion = found(session, DeletionRow, recording_id, "deleted recording", lock=True)
    if deletion.deleted_by is not DeletedBy.PERSON:
        cause = "a rule of retention deleted it"
    elif deletion.account != by.name:
        cause = "only who deleted it may have it back"
    elif deletion.deleted_ns < since_ns:
        cause = "it is too long ago, and its files go; upload them again"
    elif deletion.digest is None:
        cause = "its files were never stored"
    else:
        return deletion
    raise DeletionStaysError(recording_id, cause)


def _link_again(session: Session, row: RecordingRow) -> None:
    """Link what the relay lists to the recording again, so that it is not pulled as a new one."""
    deleted = select(DeletedRemoteRecordRow).where(DeletedRemoteRecordRow.deletion_id == row.id)
    for listing in session.scalars(deleted).all():
        link_remote_record(session, listing.ied, record_of(RemoteRecord, listing), row)
        session.delete(listing)
    session.flush()
