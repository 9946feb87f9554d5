"""Recordings deleted on purpose: their rows go, what they were is remembered, their folders go afterwards.

The rows go first, in one transaction that also notes the folder as discarded. The background removes it,
after the time in which a person may undo what they deleted. Whoever adds a recording looks, under the same
lock, whether its folder is still there.
"""

from collections.abc import Callable, Collection

from sqlalchemy import Select, delete, select
from sqlalchemy.orm import Session

from core.diagnosis.verdict import Verdict
from service.audit.actions import AuditAction
from service.recording_store.contents import StoredFile, waveform_digest
from service.recording_store.recording import StoredRecording
from service.storage.errors import RecordingInUseError
from service.storage.models import (
    BaselineRecordingRow,
    DeletedRemoteRecordRow,
    DeletionRow,
    DiagnosisRow,
    DiscardedFolderRow,
    IedRow,
    JobRow,
    LeaseRow,
    MotorRow,
    RecordingFileRow,
    RecordingRequestRow,
    RecordingRow,
    RemoteRecordRow,
)
from service.storage.records import Cursor, Deletion, Page, RemoteRecord
from service.storage.records.actors import SERVICE, Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.observations import forget_observation
from service.storage.repository.history.record_figures import forget_record_figures
from service.storage.repository.history.rotor import forget_rotor_finding
from service.storage.repository.history.starts import forget_start
from service.storage.repository.recordings.copies import forget_outline, release_copies
from service.storage.repository.recordings.folders import discard_folder, lock_folder
from service.storage.repository.recordings.recordings import stored_before
from service.storage.repository.recordings.requests import KIND, fail_row, fail_rows
from service.storage.repository.recordings.undone_deletions import is_kept_for_undo
from service.storage.repository.relays.remote_records import of_records, remote_link
from service.storage.repository.sessions import Order, Sessions, columns_of, found, only, page_of, record_of
from service.storage.states import DeletedBy, JobState, RecordingState


class DeletionRows(Sessions):
    def delete_recording(
        self,
        recording_id: str,
        reason: str,
        *,
        by: Actor = SERVICE,
        now_ns: int,
        deleted_by: DeletedBy = DeletedBy.PERSON,
    ) -> Deletion:
        """Delete a recording with its diagnoses and jobs; remember what it was, and why it was deleted.

        Its folder is discarded, if no other recording has it. Recording requests stay, without a recording.
        Raises NotFoundError, RecordingInUseError.
        """
        with self._write() as session:
            motor = found(session, RecordingRow, recording_id, "recording").motor
            row = to_delete(session, motor, recording_id)
            if row is None:
                found(session, RecordingRow, recording_id, "recording")
                raise RecordingInUseError(recording_id, "it is of another motor now")
            cause = in_use(session, row)
            if cause is not None:
                raise RecordingInUseError(recording_id, cause)
            account = by.name if deleted_by is DeletedBy.PERSON else None
            deletion = delete_row(session, row, reason, deleted_by, now_ns, account=account)
            before = {
                "motor": deletion.motor,
                "name": deletion.name,
                "digest": deletion.digest,
                "state": deletion.state,
                "verdict": deletion.verdict,
            }
            note_change(
                session,
                by,
                AuditAction.RECORDING_DELETED,
                ("recording", recording_id),
                now_ns=now_ns,
                before=before,
                after={"reason": reason},
            )
            return deletion

    def deletion(self, recording_id: str) -> Deletion:
        """Return what is remembered of a deleted recording. Raises NotFoundError."""
        with self._read() as session:
            return record_of(Deletion, found(session, DeletionRow, recording_id, "deleted recording"))

    def deletions(
        self, *, limit: int, after: Cursor | None = None, motor: str | None = None
    ) -> Page[Deletion]:
        """Return a page of deleted recordings, of one motor or of all, latest first."""
        query = select(*columns_of(Deletion, DeletionRow))
        if motor is not None:
            query = query.where(DeletionRow.motor == motor)
        order: Order = [DeletionRow.deleted_ns, DeletionRow.id]
        with self._read() as session:
            return page_of(session, query, order, Deletion, limit=limit, after=after, descending=True)

    def deleted_remote_records(
        self, relay: str, remotes: Collection[RemoteRecord]
    ) -> dict[RemoteRecord, Deletion]:
        """Return which of a relay's records were deleted here: they are not pulled again."""
        query = select(DeletedRemoteRecordRow, DeletionRow).join(
            DeletionRow, DeletionRow.id == DeletedRemoteRecordRow.deletion_id
        )
        with self._read() as session:
            return {
                record_of(RemoteRecord, row): record_of(Deletion, deletion)
                for row, deletion in of_records(session, query, DeletedRemoteRecordRow, relay, remotes)
            }

    def keep_deleted(
        self,
        stored: StoredRecording,
        *,
        motor: str,
        relay: str,
        remote: RemoteRecord,
        now_ns: int,
        recording_request_id: str | None = None,
    ) -> Deletion | None:
        """Note that a relay's record, pulled under another listing, is one that was deleted: it stays so.

        None, and no change, where no record of this name and content was deleted, or somebody has brought it
        back since. The request that waited for it fails.
        """
        same = select(DeletionRow).where(
            DeletionRow.ied == relay,
            DeletionRow.name == remote.name,
            DeletionRow.waveform == waveform_digest(stored.files),
        )
        with self._read() as session:
            if only(session, same) is None:
                return None
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            deletion = only(session, same)
            if deletion is None or stored_before(session, motor, relay, remote.name, stored) is not None:
                return None
            announced = remote_link(session, relay, remote)
            if announced is not None:
                row = found(session, RecordingRow, announced.recording_id, "recording")
                session.delete(announced)
                session.flush()
                if row.state is RecordingState.ANNOUNCED:
                    session.delete(row)
            _remember_listing(session, relay, remote, deletion.id)
            discard_folder(session, stored.digest, now_ns)
            if recording_request_id is not None:
                request = found(session, RecordingRequestRow, recording_request_id, KIND, lock=True)
                fail_row(request, f"the relay's record was deleted here: {deletion.reason}", now_ns)
            return record_of(Deletion, deletion)

    def discard_stored(self, digest: str, *, now_ns: int) -> None:
        """Note that the folder of a record that was not added is to be removed, if nothing else needs it."""
        with self._write() as session:
            discard_folder(session, digest, now_ns)

    def discarded_folders(self) -> tuple[str, ...]:
        """Return the digests of the folders that are to be removed."""
        with self._read() as session:
            return tuple(session.scalars(select(DiscardedFolderRow.digest)))

    def release_folder(self, digest: str, set_aside: Callable[[str], None], *, undo_since_ns: int) -> None:
        """Have a discarded folder set aside, unless a recording needs it again.

        One whose recording a person has deleted since a time stays as it is: the deletion may be undone.
        Nobody adds a recording of this content meanwhile.
        """
        with self._write() as session:
            lock_folder(session, digest)
            discarded = session.get(DiscardedFolderRow, digest)
            if discarded is None or is_kept_for_undo(session, digest, undo_since_ns):
                return
            if only(session, select(RecordingRow).where(RecordingRow.digest == digest)) is None:
                set_aside(digest)
            session.delete(discarded)


def to_delete(session: Session, motor: str, recording_id: str) -> RecordingRow | None:
    """Lock a recording of the motor and all that hangs on it, and return it; None where it is gone."""
    found(session, MotorRow, motor, "motor", lock=True)
    # Jobs before the recording, as whoever finishes a job does: no two wait for each other.
    session.scalars(_jobs_of(recording_id)).all()
    row = session.get(RecordingRow, recording_id, with_for_update=True, populate_existing=True)
    return row if row is not None and row.motor == motor else None


def in_use(session: Session, row: RecordingRow) -> str | None:
    """Return what keeps a locked recording from being deleted; None where nothing does."""
    if row.state is RecordingState.ANNOUNCED and _is_followed(session, row.ied):
        return "it is announced, and its relay still has its files; wait until they are pulled or refused"
    baseline = select(BaselineRecordingRow).where(BaselineRecordingRow.recording_id == row.id)
    if only(session, baseline) is not None:
        return f"it is part of the baseline of motor {row.motor}; replace or delete that baseline first"
    running = next((job for job in session.scalars(_jobs_of(row.id)) if job.state is JobState.RUNNING), None)
    if running is not None:
        return f"diagnosis {running.id} of it is running; ask again when it has ended"
    return None


def delete_row(
    session: Session,
    row: RecordingRow,
    reason: str,
    deleted_by: DeletedBy,
    now_ns: int,
    *,
    account: str | None = None,
) -> Deletion:
    """Delete a locked recording that nothing uses, and return what is remembered of it.

    What it tells of its motor's condition goes where a person deletes it. Where a rule does, it stays: what
    later recordings are compared with rests on it.

    account: of the person, who may undo it.
    """
    files = session.scalars(select(RecordingFileRow).where(RecordingFileRow.recording_id == row.id)).all()
    deletion = DeletionRow(
        id=row.id,
        motor=row.motor,
        ied=row.ied,
        source=row.source,
        name=row.name,
        digest=row.digest,
        waveform=waveform_digest(record_of(StoredFile, file) for file in files) if files else None,
        size_bytes=row.size_bytes if row.digest is not None else 0,
        state=row.state,
        verdict=_verdict(session, row.id),
        announced_ns=row.announced_ns,
        recorded_ns=row.recorded_ns,
        deleted_ns=now_ns,
        deleted_by=deleted_by,
        account=account,
        reason=reason,
        remote_modified_ns=row.remote_modified_ns,
        fetched_ns=row.fetched_ns,
        clock_offset_ns=row.clock_offset_ns,
        clock_uncertainty_ns=row.clock_uncertainty_ns,
        clock_quality=row.clock_quality,
        clock_measured_ns=row.clock_measured_ns,
        parts=row.parts,
        joined_id=row.joined_id,
    )
    session.add(deletion)
    session.flush()
    _free_requests(session, row.id, reason, now_ns)
    for link in session.scalars(select(RemoteRecordRow).where(RemoteRecordRow.recording_id == row.id)):
        _remember_listing(session, link.ied, record_of(RemoteRecord, link), deletion.id)
        session.delete(link)
    if deleted_by is DeletedBy.PERSON:
        forget_observation(session, row.id)
        forget_start(session, row.id)
        forget_rotor_finding(session, row.id)
        forget_record_figures(session, row.id)
        release_copies(session, row, now_ns)
    if deleted_by is DeletedBy.PERSON or row.copy_of is not None:
        forget_outline(session, row.id)
    session.execute(delete(DiagnosisRow).where(DiagnosisRow.recording_id == row.id))
    session.execute(delete(RecordingFileRow).where(RecordingFileRow.recording_id == row.id))
    for job in session.scalars(_jobs_of(row.id)):
        session.delete(job)
    session.flush()
    digest = row.digest
    session.delete(row)
    session.flush()
    if digest is not None:
        discard_folder(session, digest, now_ns)
    return record_of(Deletion, deletion)


def _jobs_of(recording_id: str) -> Select[JobRow]:
    return select(JobRow).where(JobRow.recording_id == recording_id).order_by(JobRow.id).with_for_update()


def _is_followed(session: Session, relay: str | None) -> bool:
    """Tell whether a gateway visits the relay, or will: it is in the plant, or held by one still."""
    row = None if relay is None else session.get(IedRow, relay)
    return row is not None and (row.in_service or session.get(LeaseRow, row.name) is not None)


def _verdict(session: Session, recording_id: str) -> Verdict | None:
    query = select(DiagnosisRow.verdict).where(
        DiagnosisRow.recording_id == recording_id, DiagnosisRow.current
    )
    return session.scalar(query)


def _free_requests(session: Session, recording_id: str, reason: str, now_ns: int) -> None:
    """End the requests that wait for the recording's diagnosis, and let none of them point to it."""
    told = f"recording {recording_id} was deleted: {reason}"
    fail_rows(session, recording_id, told, now_ns)
    query = select(RecordingRequestRow).where(RecordingRequestRow.recording_id == recording_id)
    for request in session.scalars(query):
        request.recording_id = None
        request.reason = request.reason or told
    session.flush()


def _remember_listing(session: Session, relay: str, remote: RemoteRecord, deletion_id: str) -> None:
    session.merge(
        DeletedRemoteRecordRow(
            ied=relay,
            name=remote.name,
            size_bytes=remote.size_bytes,
            modified_ns=remote.modified_ns,
            deletion_id=deletion_id,
        )
    )
