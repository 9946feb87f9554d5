"""The table of what the relays measured."""

from sqlalchemy import ForeignKey, Index
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


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
