"""Deletes a recording: first its rows, then its folder, so that a crash in between loses track of nothing.

    rows deleted, deletion remembered, folder discarded     one transaction
    folder moved to where everything may be removed         within another, while nobody can add its content
    folder removed                                          whenever

The folder of what a person deleted waits until that can no longer be undone. `remove_discarded_folders` does
the rest at each start and minute, so a crash loses nothing.
"""

from threading import Event

import structlog

from service.recording_store.store import RecordingStore
from service.storage.records import SERVICE, Actor, Deletion, RecordingEntry
from service.storage.repository import Repository
from service.timing.undo_time import UNDO_NS

log = structlog.get_logger(__name__)


def delete_recording(
    repository: Repository, recording_id: str, reason: str, *, by: Actor = SERVICE, now_ns: int
) -> Deletion:
    """Delete a recording for a person who says why, and may undo it: its folder stays meanwhile.

    Raises NotFoundError, RecordingInUseError.
    """
    deletion = repository.delete_recording(recording_id, reason, by=by, now_ns=now_ns)
    repository.settle_start_alarms_of(deletion.motor, now_ns=now_ns)
    repository.settle_motor_condition(deletion.motor, now_ns=now_ns)
    log.info("recording deleted", recording=recording_id, motor=deletion.motor, reason=reason)
    return deletion


def undo_deletion(
    repository: Repository, store: RecordingStore, recording_id: str, *, by: Actor, now_ns: int
) -> RecordingEntry:
    """Have a recording back that the same person has deleted in the last minutes; its diagnosis is queued.

    Raises NotFoundError, DeletionStaysError, RecordingStoreError, FolderGoneError, OSError.
    """
    since_ns = now_ns - UNDO_NS
    deletion = repository.deletion_to_undo(recording_id, by=by, since_ns=since_ns)
    stored = store.find(deletion.digest or "")
    entry = repository.undo_deletion(recording_id, stored, by=by, since_ns=since_ns, now_ns=now_ns)
    log.info("deletion undone", recording=recording_id, motor=entry.motor)
    return entry


def remove_discarded_folder_if_possible(
    repository: Repository, store: RecordingStore, digest: str, now_ns: int
) -> None:
    """Remove one folder if it is discarded; what fails is done within a minute.

    A request removes what it has discarded itself. What others have is the background's to remove.
    """
    try:
        _remove_discarded_folder(repository, store, digest, now_ns)
    except OSError as error:
        log.warning("files that no recording needs are not removed yet", error=str(error))


def remove_discarded_folders(
    repository: Repository, store: RecordingStore, now_ns: int, stopping: Event | None = None
) -> None:
    """Remove all folders that no recording needs any more, and what is left of others. Raises OSError.

    Those stay whose recordings a person may have back.

    stopping: set when that should end after the folder under way.
    """
    for digest in repository.discarded_folders():
        if stopping is not None and stopping.is_set():
            return
        _remove_discarded_folder(repository, store, digest, now_ns)
    store.remove_set_aside()


def _remove_discarded_folder(repository: Repository, store: RecordingStore, digest: str, now_ns: int) -> None:
    repository.release_folder(digest, store.set_aside, undo_since_ns=now_ns - UNDO_NS)
    store.remove_set_aside(digest)
