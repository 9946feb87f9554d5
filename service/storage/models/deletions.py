"""Tables of what was deleted on purpose, and of the folders that are still to be removed."""

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from core.diagnosis.verdict import Verdict
from service.storage.models.base import Base
from service.storage.states import DeletedBy, RecordingSource, RecordingState


class DeletionRow(Base):
    """A recording that was deleted, under the id that it had.

    waveform: what identifies its samples, whatever its files were called; None where none were stored.
    """

    __tablename__ = "deletions"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    ied: Mapped[str | None] = mapped_column(ForeignKey("ieds.name"))
    source: Mapped[RecordingSource]
    name: Mapped[str]
    digest: Mapped[str | None] = mapped_column(String(64))
    waveform: Mapped[str | None] = mapped_column(String(64))
    size_bytes: Mapped[int]
    state: Mapped[RecordingState]
    verdict: Mapped[Verdict | None]
    announced_ns: Mapped[int]
    recorded_ns: Mapped[int | None]
    deleted_ns: Mapped[int]
    deleted_by: Mapped[DeletedBy]
    reason: Mapped[str]

    __table_args__ = (
        Index("ix_deletions_deleted_ns_id", "deleted_ns", "id"),
        Index("ix_deletions_motor_deleted_ns_id", "motor", "deleted_ns", "id"),
        Index("ix_deletions_ied_name", "ied", "name"),
    )


class DeletedRemoteRecordRow(Base):
    """A record as its relay lists it whose recording was deleted: what is here is not pulled again."""

    __tablename__ = "deleted_remote_records"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    size_bytes: Mapped[int] = mapped_column(primary_key=True)
    modified_ns: Mapped[int] = mapped_column(primary_key=True)
    deletion_id: Mapped[str] = mapped_column(ForeignKey("deletions.id"), index=True)


class DiscardedFolderRow(Base):
    """A folder of the recording store that no recording needs any more, until it is removed."""

    __tablename__ = "discarded_folders"

    digest: Mapped[str] = mapped_column(String(64), primary_key=True)
    discarded_ns: Mapped[int]
