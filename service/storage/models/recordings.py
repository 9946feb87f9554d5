"""Tables of the recordings: those asked for, those a relay lists, and those in the store."""

from sqlalchemy import Double, ForeignKey, Index, String, text
from sqlalchemy.orm import Mapped, mapped_column

from core.operation import Operation
from service.storage.models.base import Base
from service.storage.states import (
    ClockQuality,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)


class RecordingRow(Base):
    """A recording. operation: what the motor does in it; null while nobody has looked, or it cannot be told.

    operation_remark: why the parameters of a motor cannot be estimated from this start; null where they can.
    duration_s, pre_trigger_s: its length, and how much of it is before the trigger; null before it was read.
    parts: ids of the recordings that it was joined from; null of others.
    joined_id: id of the recording that was joined from it and others; null where none was.
    copy_of: id of the recording of the same event that counts in its place; null where it counts itself.
    """

    __tablename__ = "recordings"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    ied: Mapped[str | None] = mapped_column(ForeignKey("ieds.name"))
    source: Mapped[RecordingSource]
    name: Mapped[str]
    digest: Mapped[str | None] = mapped_column(String(64))
    size_bytes: Mapped[int]
    remote_modified_ns: Mapped[int | None]
    state: Mapped[RecordingState]
    reason: Mapped[str | None]
    attempts: Mapped[int]
    announced_ns: Mapped[int]
    fetched_ns: Mapped[int | None]
    recorded_ns: Mapped[int | None]
    clock_offset_ns: Mapped[int | None]
    clock_uncertainty_ns: Mapped[int | None]
    clock_quality: Mapped[ClockQuality | None]
    clock_measured_ns: Mapped[int | None]
    operation: Mapped[Operation | None]
    operation_remark: Mapped[str | None]
    duration_s: Mapped[float | None] = mapped_column(Double)
    pre_trigger_s: Mapped[float | None] = mapped_column(Double)
    parts: Mapped[tuple[str, ...] | None]
    joined_id: Mapped[str | None] = mapped_column(String(36))
    copy_of: Mapped[str | None] = mapped_column(String(36))

    __table_args__ = (
        Index("ux_recordings_relay", "ied", "name", "digest", unique=True),
        # NULLs differ from each other in a unique index: uploads, which have no IED, need one of their own.
        Index(
            "ux_recordings_upload",
            "motor",
            "name",
            "digest",
            unique=True,
            sqlite_where=text("ied IS NULL"),
            postgresql_where=text("ied IS NULL"),
        ),
        Index("ix_recordings_announced_ns_id", "announced_ns", "id"),
        Index("ix_recordings_motor_announced_ns_id", "motor", "announced_ns", "id"),
        Index("ix_recordings_state_announced_ns_id", "state", "announced_ns", "id"),
        Index("ix_recordings_motor_state_announced_ns_id", "motor", "state", "announced_ns", "id"),
        Index("ix_recordings_operation_announced_ns_id", "operation", "announced_ns", "id"),
        Index("ix_recordings_motor_operation_announced_ns_id", "motor", "operation", "announced_ns", "id"),
        Index("ix_recordings_digest", "digest"),
        Index("ix_recordings_motor_recorded_ns_id", "motor", "recorded_ns", "id"),
        Index(
            "ix_recordings_copy_of",
            "copy_of",
            sqlite_where=text("copy_of IS NOT NULL"),
            postgresql_where=text("copy_of IS NOT NULL"),
        ),
        Index(
            "ix_recordings_untimed",
            "motor",
            "announced_ns",
            "id",
            sqlite_where=text("recorded_ns IS NULL"),
            postgresql_where=text("recorded_ns IS NULL"),
        ),
    )


class OutlineRow(Base):
    """What tells copies of one event (core.condition.copies), of each recording that was diagnosed.

    It outlives a counted recording that a rule of retention deletes, as what that one told of its motor does.
    time_ns: the trigger time, UTC.  fidelity: 0 is the finest.
    """

    __tablename__ = "outlines"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    fidelity: Mapped[int]
    currents_A: Mapped[tuple[float, ...]]
    voltages_V: Mapped[tuple[float, ...]]

    __table_args__ = (Index("ix_outlines_motor_time_ns", "motor", "time_ns"),)


class RemoteRecordRow(Base):
    """A record as its relay lists it, and the recording it became: what is here is not pulled again."""

    __tablename__ = "remote_records"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    size_bytes: Mapped[int] = mapped_column(primary_key=True)
    modified_ns: Mapped[int] = mapped_column(primary_key=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"), index=True)


class RecordingFileRow(Base):
    __tablename__ = "recording_files"

    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"), primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    size_bytes: Mapped[int]
    sha256: Mapped[str] = mapped_column(String(64), index=True)


class BaselineRow(Base):
    """When and by whom a motor's baseline was chosen, and why, where that was said.

    account: that chose it. by: whom somebody named, else the account.
    """

    __tablename__ = "baselines"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    chosen_ns: Mapped[int]
    reason: Mapped[str | None]
    account: Mapped[str]
    by: Mapped[str]


class BaselineRecordingRow(Base):
    """A recording that stands for a motor's healthy condition; `doubt`: what spoke against that then."""

    __tablename__ = "baseline_recordings"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"), primary_key=True)
    chosen_ns: Mapped[int]
    doubt: Mapped[str | None]


class RecordingRequestRow(Base):
    """A request of one recording, or of a series that is joined to one of so many seconds.

    triggers: how often the relay is triggered for a series.  joined_recording_id: what became of the series.
    joined_remark: why that is shorter than asked for, or why there is none.
    """

    __tablename__ = "recording_requests"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"))
    origin: Mapped[RecordingRequestOrigin] = mapped_column(server_default=RecordingRequestOrigin.REQUEST)
    state: Mapped[RecordingRequestState]
    reason: Mapped[str | None]
    idempotency_key: Mapped[str | None]
    recording_id: Mapped[str | None] = mapped_column(ForeignKey("recordings.id"), index=True)
    requested_ns: Mapped[int]
    triggered_ns: Mapped[int | None]
    recorded_ns: Mapped[int | None]
    fetched_ns: Mapped[int | None]
    diagnosed_ns: Mapped[int | None]
    failed_ns: Mapped[int | None]
    seconds: Mapped[float | None] = mapped_column(Double)
    triggers: Mapped[int | None]
    joined_recording_id: Mapped[str | None] = mapped_column(String(36))
    joined_remark: Mapped[str | None]

    __table_args__ = (
        Index("ux_recording_requests_key", "motor", "origin", "idempotency_key", unique=True),
        Index("ix_recording_requests_ied_state_requested_ns", "ied", "state", "requested_ns"),
        Index("ix_recording_requests_requested_ns_id", "requested_ns", "id"),
        Index("ix_recording_requests_motor_requested_ns_id", "motor", "requested_ns", "id"),
        Index(
            "ix_recording_requests_series",
            "motor",
            "requested_ns",
            sqlite_where=text("seconds IS NOT NULL"),
            postgresql_where=text("seconds IS NOT NULL"),
        ),
    )
