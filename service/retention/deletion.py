"""Deletes a recording: first its rows, then its folder, so that a crash in between loses track of nothing.

    rows deleted, deletion remembered, folder discarded     one transaction
    folder moved to where everything may be removed         within the next, while nobody can add its content
    folder removed                                          whenever

Whatever is left to do after a crash is done by `remove_discarded_folders`, at the next start or minute.
"""

import structlog

from service.recording_store.store import RecordingStore
from service.storage.records import Deletion
from service.storage.repository import Repository

log = structlog.get_logger(__name__)


def delete_recording(
    repository: Repository, store: RecordingStore, recording_id: str, reason: str, *, now_ns: int
) -> Deletion:
    """Delete a recording for a person who says why. Raises NotFoundError, RecordingInUseError."""
    deletion = repository.delete_recording(recording_id, reason, now_ns=now_ns)
    log.info("recording deleted", recording=recording_id, motor=deletion.motor, reason=reason)
    remove_discarded_folders_if_possible(repository, store)
    return deletion


def remove_discarded_folders_if_possible(repository: Repository, store: RecordingStore) -> None:
    """Remove the folders that no recording needs any more; what fails is done within a minute."""
    try:
        remove_discarded_folders(repository, store)
    except OSError as error:
        log.warning("files that no recording needs are not removed yet", error=str(error))


def remove_discarded_folders(repository: Repository, store: RecordingStore) -> None:
    """Remove the folders that no recording needs any more. Raises OSError."""
    for digest in repository.discarded_folders():
        repository.release_folder(digest, store.set_aside)
    store.remove_set_aside()
