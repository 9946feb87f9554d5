"""Table of what recordings show of the rotor."""

from sqlalchemy import Double, ForeignKey, Index, String, text
from sqlalchemy.orm import Mapped, mapped_column

from core.rotor.finding import RotorState
from service.storage.models.base import Base

COUNTS = text("condition IS NOT NULL")


def _of_those_that_count(name: str, *columns: str) -> Index:
    return Index(name, *columns, sqlite_where=COUNTS, postgresql_where=COUNTS)


class RotorFindingRow(Base):
    """What a recording shows of its motor's rotor (core.rotor).

    It outlives a recording that a rule of retention deletes, because later ones are compared with it.
    condition: of the rotor from this record on (core.rotor.trend); null of a record that does not count: it
    cannot tell, or a joined recording stands for it.
    """

    __tablename__ = "rotor_findings"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    state: Mapped[RotorState]
    lower_sideband_dB: Mapped[float | None] = mapped_column(Double)
    upper_sideband_dB: Mapped[float | None] = mapped_column(Double)
    severity_dB: Mapped[float | None] = mapped_column(Double)
    severity_dB_ci95_low: Mapped[float | None] = mapped_column(Double)
    severity_dB_ci95_high: Mapped[float | None] = mapped_column(Double)
    detection_limit_dB: Mapped[float | None] = mapped_column(Double)
    slip: Mapped[float | None] = mapped_column(Double)
    load_level: Mapped[float | None] = mapped_column(Double)
    load_bin: Mapped[int | None]
    duration_s: Mapped[float] = mapped_column(Double)
    load_oscillation_dB: Mapped[float | None] = mapped_column(Double)
    reasons: Mapped[tuple[str, ...]]
    condition: Mapped[RotorState | None]

    __table_args__ = (
        Index("ix_rotor_findings_motor_time_ns_recording_id", "motor", "time_ns", "recording_id"),
        _of_those_that_count("ix_rotor_course_time_ns", "motor", "time_ns", "recording_id"),
        _of_those_that_count("ix_rotor_course_load_bin", "motor", "load_bin", "time_ns", "recording_id"),
        _of_those_that_count("ix_rotor_course_condition", "motor", "condition", "time_ns", "recording_id"),
    )
