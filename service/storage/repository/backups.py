"""Which back-ups were made: so that one is made when it is due, and somebody is told when none was."""

import uuid

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.storage.models import BackupRow
from service.storage.records import Actor, BackupEntry, Cursor, Page
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Order, Sessions, columns_of, found, only, page_of, record_of
from service.storage.states import BackupState

REPEATED_AFTER_NS = 3600 * NANOSECONDS_PER_SECOND
"""A back-up that failed is tried again an hour after it began."""

INTERRUPTED = "it was interrupted: the next back-up into this directory has begun"


class BackupRows(Sessions):
    def begin_backup(self, directory: str, *, now_ns: int, due_ns: int | None = None) -> BackupEntry | None:
        """Note that a back-up begins. Return None where the one of the same due time is verified, or is new.

        The caller holds the lock of the directory: one that was under way there has failed. One that failed
        is tried again after a while.
        """
        with self._write() as session:
            if due_ns is not None and not _may_begin(session, due_ns, now_ns):
                return None
            earlier = (BackupRow.state == BackupState.RUNNING, BackupRow.directory == directory)
            session.execute(
                update(BackupRow)
                .where(*earlier)
                .values(state=BackupState.FAILED, ended_ns=now_ns, problem=INTERRUPTED)
            )
            row = BackupRow(
                id=str(uuid.uuid4()),
                state=BackupState.RUNNING,
                directory=directory,
                due_ns=due_ns,
                began_ns=now_ns,
            )
            session.add(row)
            session.flush()
            return record_of(BackupEntry, row)

    def is_backup_due(self, due_ns: int, *, now_ns: int) -> bool:
        """Return whether the back-up of a due time is to be made, or to be tried again."""
        with self._read() as session:
            row = only(session, select(BackupRow).where(BackupRow.due_ns == due_ns))
            return row is None or _is_to_be_repeated(row, now_ns)

    def finish_backup(
        self,
        backup_id: str,
        *,
        name: str,
        recordings: int,
        files: int,
        size_bytes: int,
        now_ns: int,
        by: Actor | None = None,
    ) -> BackupEntry:
        """Note that a back-up is complete, and that every file of it was read again.

        by: who had it made, for the audit trail; None for one that the settings wanted. Raises NotFoundError.
        """
        with self._write() as session:
            row = found(session, BackupRow, backup_id, "back-up")
            row.state, row.ended_ns, row.problem = BackupState.VERIFIED, now_ns, None
            row.name, row.recordings, row.files, row.size_bytes = name, recordings, files, size_bytes
            if by is not None:
                after = {"directory": row.directory, "recordings": recordings, "size_bytes": size_bytes}
                subject = ("back-up", name)
                note_change(session, by, AuditAction.BACKUP_MADE, subject, now_ns=now_ns, after=after)
            return record_of(BackupEntry, row)

    def fail_backup(self, backup_id: str, problem: str, *, now_ns: int) -> None:
        """Note why a back-up could not be made. Raises NotFoundError."""
        with self._write() as session:
            row = found(session, BackupRow, backup_id, "back-up")
            row.state, row.ended_ns, row.problem = BackupState.FAILED, now_ns, problem

    def backups(self, *, limit: int, after: Cursor | None = None) -> Page[BackupEntry]:
        """Return a page of the back-ups, latest first."""
        query = select(*columns_of(BackupEntry, BackupRow))
        order: Order = [BackupRow.began_ns, BackupRow.id]
        with self._read() as session:
            return page_of(session, query, order, BackupEntry, limit=limit, after=after, descending=True)

    def latest_verified_backup(self) -> BackupEntry | None:
        """Return the back-up that was verified last; None where none was. Its `ended_ns` says when."""
        query = (
            select(BackupRow)
            .where(BackupRow.state == BackupState.VERIFIED)
            .order_by(BackupRow.ended_ns.desc())
        )
        with self._read() as session:
            row = only(session, query)
            return None if row is None else record_of(BackupEntry, row)


def _may_begin(session: Session, due_ns: int, now_ns: int) -> bool:
    earlier = only(session, select(BackupRow).where(BackupRow.due_ns == due_ns))
    if earlier is None:
        return True
    if not _is_to_be_repeated(earlier, now_ns):
        return False
    earlier.due_ns = None
    session.flush()
    return True


def _is_to_be_repeated(row: BackupRow, now_ns: int) -> bool:
    return row.state is not BackupState.VERIFIED and not 0 <= now_ns - row.began_ns < REPEATED_AFTER_NS
