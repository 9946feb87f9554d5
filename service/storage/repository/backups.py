"""Which back-ups were made: so that one is made when it is due, and somebody is told when none was."""

import uuid

from sqlalchemy import select, update

from service.storage.models import BackupRow
from service.storage.records import BackupEntry, Cursor, Page
from service.storage.repository.sessions import Order, Sessions, columns_of, found, only, page_of, record_of
from service.storage.states import BackupState

INTERRUPTED = "it was interrupted: the next back-up into this directory has begun"


class BackupRows(Sessions):
    def begin_backup(self, directory: str, *, now_ns: int, due_ns: int | None = None) -> BackupEntry | None:
        """Note that a back-up begins. Return None where one for the same due time has begun already.

        One that was under way in the same directory has failed: two cannot be made there at once.
        """
        with self._write() as session:
            if due_ns is not None and only(session, select(BackupRow).where(BackupRow.due_ns == due_ns)):
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

    def finish_backup(
        self, backup_id: str, *, name: str, recordings: int, files: int, size_bytes: int, now_ns: int
    ) -> BackupEntry:
        """Note that a back-up is complete, and that every file of it was read again. Raises NotFoundError."""
        with self._write() as session:
            row = found(session, BackupRow, backup_id, "back-up")
            row.state, row.ended_ns, row.problem = BackupState.VERIFIED, now_ns, None
            row.name, row.recordings, row.files, row.size_bytes = name, recordings, files, size_bytes
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
