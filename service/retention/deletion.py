"""Deletes a recording: first its rows, then its folder, so that a crash in between loses track of nothing.

    rows deleted, deletion remembered, folder discarded     one transaction
    folder moved to where everything may be removed         within the next, while nobody can add its content
    folder removed                                          whenever

Whatever is left to do after a crash is done by `remove_discarded_folders`, at the next start or minute.
"""

from threading import Event

import structlog

from service.recording_store.store import RecordingStore
from service.storage.records import SERVICE, Actor, Deletion
from service.storage.repository import Repository

log = structlog.get_logger(__name__)


def delete_recording(
    repository: Repository,
    store: RecordingStore,
    recording_id: str,
    reason: str,
    *,
    by: Actor = SERVICE,
    now_ns: int,
) -> Deletion:
    """Delete a recording for a person who says why. Raises NotFoundError, RecordingInUseError."""
    deletion = repository.delete_recording(recording_id, reason, by=by, now_ns=now_ns)
    repository.settle_start_alarms_of(deletion.motor, now_ns=now_ns)
    repository.settle_motor_condition(deletion.motor, now_ns=now_ns)
    log.info("recording deleted", recording=recording_id, motor=deletion.motor, reason=reason)
    if deletion.digest is not None:
        remove_discarded_folder_if_possible(repository, store, deletion.digest)
    return deletion


def remove_discarded_folder_if_possible(repository: Repository, store: RecordingStore, digest: str) -> None:
    """Remove one folder if it is discarded; what fails is done within a minute.

    A request removes what it has discarded itself. What others have is the background's to remove.
    """
    try:
        _remove_discarded_folder(repository, store, digest)
    except OSError as error:
        log.warning("files that no recording needs are not removed yet", error=str(error))


def remove_discarded_folders(
    repository: Repository, store: RecordingStore, stopping: Event | None = None
) -> None:
    """Remove all folders that no recording needs any more, and what is left of others. Raises OSError.

    stopping: set when that should end after the folder under way.
    """
    for digest in repository.discarded_folders():
        if stopping is not None and stopping.is_set():
            return
        _remove_discarded_folder(repository, store, digest)
    store.remove_set_aside()


def _remove_discarded_folder(repository: Repository, store: RecordingStore, digest: str) -> None:
    repository.release_folder(digest, store.set_aside)
    store.remove_set_aside(digest)
