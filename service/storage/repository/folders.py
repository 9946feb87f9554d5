"""Which folders of the recording store are needed. Who adds or removes one holds its lock meanwhile."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.recording_store.store import StoredRecording
from service.storage.engine import one_at_a_time
from service.storage.errors import FolderGoneError
from service.storage.models import DiscardedFolderRow, RecordingRow
from service.storage.repository.sessions import only


def lock_folder(session: Session, digest: str) -> None:
    """Let nobody else add or remove the folder of this content before the transaction ends."""
    one_at_a_time(session.connection(), f"folder {digest}")


def require_folder(session: Session, stored: StoredRecording) -> None:
    """Keep the folder of a record that is about to be added. Raises FolderGoneError."""
    lock_folder(session, stored.digest)
    if not stored.directory.is_dir():
        raise FolderGoneError(stored.digest)


def discard_folder(session: Session, digest: str, now_ns: int) -> None:
    """Note that a folder is to be removed, if no recording has this content."""
    lock_folder(session, digest)
    if only(session, select(RecordingRow).where(RecordingRow.digest == digest)) is None:
        session.merge(DiscardedFolderRow(digest=digest, discarded_ns=now_ns))
