"""Which folders of the recording store are needed. Who adds or removes one holds its lock meanwhile."""

from collections.abc import Callable, Collection

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.recording_store.recording import StoredRecording
from service.storage.engine import one_at_a_time
from service.storage.errors import FolderGoneError
from service.storage.models import DiscardedFolderRow, RecordingRow
from service.storage.repository.sessions import Sessions, only

FOLDERS_A_QUERY = 500
"""Databases limit how many values a query may hold."""


class FolderRows(Sessions):
    def known_folders(self, digests: Collection[str]) -> frozenset[str]:
        """Return which of the folders belong to a recording, or are noted as to be removed."""
        known: set[str] = set()
        asked = sorted(digests)
        with self._read() as session:
            for first in range(0, len(asked), FOLDERS_A_QUERY):
                some = asked[first : first + FOLDERS_A_QUERY]
                for column in (RecordingRow.digest, DiscardedFolderRow.digest):
                    known.update(
                        found for found in session.scalars(select(column).where(column.in_(some))) if found
                    )
        return frozenset(known)

    def move_folder(self, digest: str, *, apart: Callable[[str], None], back: Callable[[str], None]) -> bool:
        """Have a folder moved apart if nothing in the database knows it, or else back.

        Returns whether it is known. Nobody adds or deletes a recording of this content meanwhile.
        """
        with self._write() as session:
            lock_folder(session, digest)
            is_known = (
                session.get(DiscardedFolderRow, digest) is not None
                or only(session, select(RecordingRow).where(RecordingRow.digest == digest)) is not None
            )
            (back if is_known else apart)(digest)
            return is_known


def lock_folder(session: Session, digest: str) -> None:
    """Let nobody else add or remove the folder of this content before the transaction ends."""
    one_at_a_time(session.connection(), f"folder {digest}")


def require_folder(session: Session, stored: StoredRecording) -> None:
    """Keep the folder of a record that is about to be added. Raises FolderGoneError, OSError."""
    lock_folder(session, stored.digest)
    if not stored.is_there():
        raise FolderGoneError(stored.digest)


def discard_folder(session: Session, digest: str, now_ns: int) -> None:
    """Note that a folder is to be removed, if no recording has this content."""
    lock_folder(session, digest)
    if only(session, select(RecordingRow).where(RecordingRow.digest == digest)) is None:
        session.merge(DiscardedFolderRow(digest=digest, discarded_ns=now_ns))
