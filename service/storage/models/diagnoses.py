"""Tables of the diagnoses: the queue of jobs and their results."""

from collections.abc import Mapping

from sqlalchemy import ForeignKey, Index, String, false, text
from sqlalchemy.orm import Mapped, mapped_column, relationship

from core.diagnosis.verdict import Verdict
from service.storage.models.base import Base
from service.storage.states import JobState


class JobRunnerRow(Base):
    """A job runner of some service. `renewals` goes on as long as it lives."""

    __tablename__ = "job_runners"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    installation: Mapped[str]
    renewals: Mapped[int]
    started_ns: Mapped[int]
    host: Mapped[str] = mapped_column(server_default="")
    process_id: Mapped[int] = mapped_column(server_default="0")
    workers: Mapped[int] = mapped_column(server_default="0")


class JobRow(Base):
    """A diagnosis to be made.

    motor: that of the recording; empty where the job ended before this column was.
    priority: a JobPriority.  runner: the job runner that makes or made it.
    """

    __tablename__ = "jobs"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    recording_id: Mapped[str] = mapped_column(ForeignKey("recordings.id"))
    method: Mapped[str]
    model: Mapped[str]
    state: Mapped[JobState]
    motor: Mapped[str] = mapped_column(server_default="")
    priority: Mapped[int] = mapped_column(server_default="0")
    attempts: Mapped[int]
    not_before_ns: Mapped[int]
    created_ns: Mapped[int]
    started_ns: Mapped[int | None]
    finished_ns: Mapped[int | None]
    error: Mapped[str | None]
    runner: Mapped[str | None] = mapped_column(String(36))
    result: Mapped["DiagnosisRow | None"] = relationship(viewonly=True)

    __table_args__ = (
        Index("ix_jobs_state_priority_not_before_ns_id", "state", "priority", "not_before_ns", "id"),
        Index(
            "ix_jobs_queued",
            "motor",
            sqlite_where=text("state = 'queued'"),
            postgresql_where=text("state = 'queued'"),
        ),
        Index("ix_jobs_recording_id_created_ns_id", "recording_id", "created_ns", "id"),
    )


class DiagnosisRow(Base):
    """The result of one job. `current` marks the latest of a recording: that one is in the trend.

    ci95: from all causes; null in rows of versions that knew only the scatter.
    says_nothing: whether the motor was seen to stand, start, stop or trip, and nothing of its winding, or the
    recording is a copy: such a result is none of the motor's, neither good nor bad.
    """

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
    mu_f_scatter95_low: Mapped[float | None]
    mu_f_scatter95_high: Mapped[float | None]
    detection_limit: Mapped[float | None]
    theta_f: Mapped[int | None]
    load_level: Mapped[float | None]
    load_level_ci95_low: Mapped[float | None]
    load_level_ci95_high: Mapped[float | None]
    method: Mapped[str]
    model: Mapped[str]
    document: Mapped[Mapping[str, object]]
    says_nothing: Mapped[bool] = mapped_column(server_default=false())

    __table_args__ = (
        # All that a point of the trend needs: a row with its document lies on pages of its own.
        Index(
            "ix_diagnoses_trend",
            "motor",
            "current",
            "says_nothing",
            "recorded_ns",
            "id",
            "recording_id",
            "verdict",
            "mu_f",
            "mu_f_ci95_low",
            "mu_f_ci95_high",
            "theta_f",
            "load_level",
            "mu_f_scatter95_low",
            "mu_f_scatter95_high",
            "detection_limit",
            "load_level_ci95_low",
            "load_level_ci95_high",
        ),
    )
