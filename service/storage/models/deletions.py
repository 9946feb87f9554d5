"""Tables of what was deleted on purpose, and of the folders that are still to be removed."""

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from core.diagnosis.verdict import Verdict
from service.storage.models.base import Base
from service.storage.states import ClockQuality, DeletedBy, RecordingSource, RecordingState


class DeletionRow(Base):
    """A recording that was deleted, under the id that it had.

    waveform: what identifies its samples, whatever its files were called; None where none were stored.
    account: who deleted it; None where a rule did.  remote_modified_ns to joined_id: as the recording had
    them, for who undoes the deletion.
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
    account: Mapped[str | None]
    reason: Mapped[str]
    remote_modified_ns: Mapped[int | None]
    fetched_ns: Mapped[int | None]
    clock_offset_ns: Mapped[int | None]
    clock_uncertainty_ns: Mapped[int | None]
    clock_quality: Mapped[ClockQuality | None]
    clock_measured_ns: Mapped[int | None]
    parts: Mapped[tuple[str, ...] | None]
    joined_id: Mapped[str | None] = mapped_column(String(36))

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
