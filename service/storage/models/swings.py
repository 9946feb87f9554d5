"""Table of what recordings show of the air gap, and of a load that swings."""

from sqlalchemy import Double, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


class SwingFindingRow(Base):
    """What a recording shows of its motor's air gap and of its load's swings (core.rotor.swing_findings).

    gap_...: of the air gap. turn_...: torque of the load that swings once a turn, which the same lines tell.
    load_...: the strongest other swing. It outlives a recording that a rule of retention deletes, as the
    motor's trend does.
    """

    __tablename__ = "swing_findings"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    gap_permeance_ripple: Mapped[float | None] = mapped_column(Double)
    gap_standard_deviation: Mapped[float | None] = mapped_column(Double)
    gap_detection_limit: Mapped[float | None] = mapped_column(Double)
    gap_lower_sideband_dB: Mapped[float | None] = mapped_column(Double)
    gap_upper_sideband_dB: Mapped[float | None] = mapped_column(Double)
    turn_load_torque: Mapped[float | None] = mapped_column(Double)
    turn_load_torque_deviation: Mapped[float | None] = mapped_column(Double)
    turn_frequency_hz: Mapped[float | None] = mapped_column(Double)
    gap_reasons: Mapped[tuple[str, ...]]
    load_torque: Mapped[float | None] = mapped_column(Double)
    load_noise: Mapped[float | None] = mapped_column(Double)
    load_frequency_hz: Mapped[float | None] = mapped_column(Double)
    load_torque_deviation: Mapped[float | None] = mapped_column(Double)
    load_detection_limit: Mapped[float | None] = mapped_column(Double)
    load_reasons: Mapped[tuple[str, ...]]

    __table_args__ = (
        Index("ix_swing_findings_motor_time_ns_recording_id", "motor", "time_ns", "recording_id"),
    )
