"""Tables. Times are UTC, integer nanoseconds since 1970 (columns ..._ns); ids are random UUIDs as text."""

from collections.abc import Mapping
from enum import StrEnum

from sqlalchemy import JSON, BigInteger, Enum, ForeignKey, Index, LargeBinary, MetaData, String, text
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column

from core.diagnosis.verdict import Verdict
from service.storage.states import (
    AlarmKind,
    ClockQuality,
    JobState,
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)


def _words(enum: type[StrEnum]) -> Enum:
    """Column of the enum's values, as text: readable in any database tool, no migration to grow."""
    return Enum(
        enum,
        values_callable=lambda members: [member.value for member in members],
        native_enum=False,
        create_constraint=False,
        length=16,
    )


class Base(DeclarativeBase):
    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map = {  # noqa: RUF012  # SQLAlchemy's own declaration style
        int: BigInteger,
        LinkState: _words(LinkState),
        AlarmKind: _words(AlarmKind),
        ClockQuality: _words(ClockQuality),
        RecordingRequestOrigin: _words(RecordingRequestOrigin),
        RecordingRequestState: _words(RecordingRequestState),
        RecordingState: _words(RecordingState),
        RecordingSource: _words(RecordingSource),
        JobState: _words(JobState),
        Verdict: _words(Verdict),
        Mapping[str, object]: JSON,
        list[Mapping[str, object]]: JSON,
    }


class SiteRow(Base):
    __tablename__ = "sites"

    name: Mapped[str] = mapped_column(primary_key=True)
    description: Mapped[str]
    in_service: Mapped[bool]


class IedRow(Base):
    __tablename__ = "ieds"

    name: Mapped[str] = mapped_column(primary_key=True)
    site: Mapped[str] = mapped_column(ForeignKey("sites.name"))
    host: Mapped[str]
    port: Mapped[int]
    manufacturer: Mapped[str]
    type: Mapped[str]
    in_service: Mapped[bool]
    link_state: Mapped[LinkState]
    link_reason: Mapped[str | None]
    link_changed_ns: Mapped[int | None]
    last_success_ns: Mapped[int | None]
    entry_id: Mapped[bytes | None] = mapped_column(LargeBinary)
    entry_report_control: Mapped[str | None]
    clock_offset_ns: Mapped[int | None]
    clock_uncertainty_ns: Mapped[int | None]
    clock_quality: Mapped[ClockQuality | None]
    clock_measured_ns: Mapped[int | None]


class GatewayRow(Base):
    """A process that visits relays. `beats` goes on as long as it lives."""

    __tablename__ = "gateways"

    id: Mapped[str] = mapped_column(primary_key=True)
    host: Mapped[str]
    process_id: Mapped[int]
    beats: Mapped[int]
    started_ns: Mapped[int]


class LeaseRow(Base):
    """The gateway that visits a relay: no other does."""

    __tablename__ = "leases"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    gateway: Mapped[str] = mapped_column(ForeignKey("gateways.id"), index=True)


class QuarantineRow(Base):
    """A relay set aside until `until_ns`, or back since, not trusted yet. `times`: 0 where only suspected."""

    __tablename__ = "quarantines"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    reason: Mapped[str]
    times: Mapped[int]
    since_ns: Mapped[int]
    until_ns: Mapped[int]


class LinkChangeRow(Base):
    """One change of a link's state, or of the reason why it is down."""

    __tablename__ = "link_changes"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"))
    changed_ns: Mapped[int]
    state: Mapped[LinkState]
    reason: Mapped[str | None]

    __table_args__ = (Index("ix_link_changes_ied_changed_ns_id", "ied", "changed_ns", "id"),)


class LinkFiguresRow(Base):
    """What went over a link since the relay is known; `day_bytes` in the UTC day `day` (days since 1970)."""

    __tablename__ = "link_figures"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    round_trip_s: Mapped[float | None]
    connections: Mapped[int]
    received_bytes: Mapped[int]
    reports: Mapped[int]
    report_gaps: Mapped[int]
    day: Mapped[int]
    day_bytes: Mapped[int]


class AlarmRow(Base):
    """What somebody has to look after at a relay; it stands until it is cleared. `subject`: a file's name."""

    __tablename__ = "alarms"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"))
    kind: Mapped[AlarmKind]
    subject: Mapped[str]
    reason: Mapped[str]
    raised_ns: Mapped[int]
    cleared_ns: Mapped[int | None]

    __table_args__ = (
        Index("ix_alarms_ied_cleared_ns", "ied", "cleared_ns"),
        Index("ix_alarms_raised_ns_id", "raised_ns", "id"),
    )


class RelayFindingsRow(Base):
    """What was found at a relay when it was last visited: what is used of it, what is not as promised."""

    __tablename__ = "relay_findings"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    found_ns: Mapped[int]
    acquisition: Mapped[Mapping[str, object]]
    differences: Mapped[list[Mapping[str, object]]]
    ignored_files: Mapped[list[Mapping[str, object]]]
    ignored_in_all: Mapped[int]


class MotorRow(Base):
    __tablename__ = "motors"

    name: Mapped[str] = mapped_column(primary_key=True)
    description: Mapped[str]
    site: Mapped[str] = mapped_column(ForeignKey("sites.name"))
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), index=True)
    in_service: Mapped[bool]
    schedule: Mapped[str | None]


class RecordingRow(Base):
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
    )


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


class BaselineRecordingRow(Base):
    """A recording that stands for a motor's healthy condition."""

    __tablename__ = "baseline_recordings"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"), primary_key=True)
    chosen_ns: Mapped[int]


class MeasurementRow(Base):
    """Values a relay measured: of one time (step_s = 0), or means of `step_s` seconds from `time_ns` on."""

    __tablename__ = "measurements"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    step_s: Mapped[int] = mapped_column(primary_key=True)
    time_ns: Mapped[int] = mapped_column(primary_key=True)
    samples: Mapped[int]
    ia_A: Mapped[float | None]
    ib_A: Mapped[float | None]
    ic_A: Mapped[float | None]
    vab_V: Mapped[float | None]
    vbc_V: Mapped[float | None]
    vca_V: Mapped[float | None]
    va_V: Mapped[float | None]
    vb_V: Mapped[float | None]
    vc_V: Mapped[float | None]
    power_W: Mapped[float | None]
    reactive_power_var: Mapped[float | None]
    power_factor: Mapped[float | None]
    frequency_Hz: Mapped[float | None]
    average_current_A: Mapped[float | None]
    maximum_current_A: Mapped[float | None]
    minimum_current_A: Mapped[float | None]
    average_voltage_V: Mapped[float | None]
    maximum_voltage_V: Mapped[float | None]
    minimum_voltage_V: Mapped[float | None]
    average_power_W: Mapped[float | None]
    maximum_power_W: Mapped[float | None]
    minimum_power_W: Mapped[float | None]
    maximum_ia_A: Mapped[float | None]
    maximum_ib_A: Mapped[float | None]
    maximum_ic_A: Mapped[float | None]
    minimum_ia_A: Mapped[float | None]
    minimum_ib_A: Mapped[float | None]
    minimum_ic_A: Mapped[float | None]
    maximum_vab_V: Mapped[float | None]
    maximum_vbc_V: Mapped[float | None]
    maximum_vca_V: Mapped[float | None]
    minimum_vab_V: Mapped[float | None]
    minimum_vbc_V: Mapped[float | None]
    minimum_vca_V: Mapped[float | None]

    __table_args__ = (Index("ix_measurements_step_s_time_ns", "step_s", "time_ns"),)


class RecordingRequestRow(Base):
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

    __table_args__ = (
        Index("ux_recording_requests_key", "motor", "idempotency_key", unique=True),
        Index("ix_recording_requests_ied_state_requested_ns", "ied", "state", "requested_ns"),
        Index("ix_recording_requests_requested_ns_id", "requested_ns", "id"),
    )


class JobRow(Base):
    __tablename__ = "jobs"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"))
    method: Mapped[str]
    model: Mapped[str]
    state: Mapped[JobState]
    attempts: Mapped[int]
    not_before_ns: Mapped[int]
    created_ns: Mapped[int]
    started_ns: Mapped[int | None]
    finished_ns: Mapped[int | None]
    error: Mapped[str | None]

    __table_args__ = (
        Index("ix_jobs_state_not_before_ns", "state", "not_before_ns"),
        Index("ix_jobs_recording_id_created_ns_id", "recording_id", "created_ns", "id"),
    )


class DiagnosisRow(Base):
    """The result of one job. `current` marks the latest of a recording: that one is in the trend."""

    __tablename__ = "diagnoses"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    job_id: Mapped[str] = mapped_column(ForeignKey("jobs.id"), unique=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"), index=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    current: Mapped[bool]
    created_ns: Mapped[int]
    recorded_ns: Mapped[int]
    verdict: Mapped[Verdict]
    mu_f: Mapped[float | None]
    mu_f_ci95_low: Mapped[float | None]
    mu_f_ci95_high: Mapped[float | None]
    theta_f: Mapped[int | None]
    load_level: Mapped[float | None]
    method: Mapped[str]
    model: Mapped[str]
    document: Mapped[Mapping[str, object]]

    __table_args__ = (
        Index("ix_diagnoses_motor_current_recorded_ns_id", "motor", "current", "recorded_ns", "id"),
    )
