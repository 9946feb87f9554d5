"""Table of what recordings show of the supply."""

from sqlalchemy import Double, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


class SupplyFiguresRow(Base):
    """What a recording shows of its motor's supply (core.supply); harmonics are shares of the fundamental.

    It outlives a recording that a rule of retention deletes, as the motor's trend does.
    """

    __tablename__ = "supply_figures"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    frequency_hz: Mapped[float] = mapped_column(Double)
    line_voltages_V: Mapped[tuple[float, ...]]
    voltage_unbalance_iec: Mapped[float] = mapped_column(Double)
    voltage_unbalance_nema: Mapped[float] = mapped_column(Double)
    derating: Mapped[float | None] = mapped_column(Double)
    voltage_deviation: Mapped[float] = mapped_column(Double)
    thd_voltage: Mapped[float] = mapped_column(Double)
    harmonic_voltage_factor: Mapped[float] = mapped_column(Double)
    voltage_harmonics: Mapped[tuple[float, ...]]
    line_currents_A: Mapped[tuple[float, ...] | None]
    current_unbalance: Mapped[float | None] = mapped_column(Double)
    thd_current: Mapped[float | None] = mapped_column(Double)
    current_harmonics: Mapped[tuple[float, ...]]
    active_power_W: Mapped[float | None] = mapped_column(Double)
    power_factor: Mapped[float | None] = mapped_column(Double)
    duration_s: Mapped[float] = mapped_column(Double)
    reasons: Mapped[tuple[str, ...]]

    __table_args__ = (
        Index("ix_supply_figures_motor_time_ns_recording_id", "motor", "time_ns", "recording_id"),
    )
