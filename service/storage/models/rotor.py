"""Table of what recordings show of the rotor."""

from sqlalchemy import Double, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from core.rotor.finding import RotorState
from service.storage.models.base import Base


class RotorFindingRow(Base):
    """What a recording shows of its motor's rotor (core.rotor).

    It outlives a recording that a rule of retention deletes, because later ones are compared with it.
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

    __table_args__ = (
        Index("ix_rotor_findings_motor_time_ns_recording_id", "motor", "time_ns", "recording_id"),
    )
