"""The table of the back-ups: which were made of this database, when and where, and which were verified."""

from sqlalchemy import Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import BackupState


class BackupRow(Base):
    """A back-up, from its beginning on. A back-up holds no row of itself that says how it ended.

    due_ns: the time of the schedule that it was made for; null where somebody asked for it. Several services
    share a database: one of them makes it.
    directory, name: where it lies, and its folder there.  ended_ns: when it was verified, or failed.
    files, size_bytes: what it consists of; null until it is verified.
    """

    __tablename__ = "backups"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    state: Mapped[BackupState]
    directory: Mapped[str]
    name: Mapped[str | None]
    due_ns: Mapped[int | None]
    began_ns: Mapped[int]
    ended_ns: Mapped[int | None]
    recordings: Mapped[int | None]
    files: Mapped[int | None]
    size_bytes: Mapped[int | None]
    problem: Mapped[str | None]

    __table_args__ = (
        Index("ux_backups_due_ns", "due_ns", unique=True),
        Index("ix_backups_began_ns_id", "began_ns", "id"),
        Index("ix_backups_state_ended_ns", "state", "ended_ns"),
    )
