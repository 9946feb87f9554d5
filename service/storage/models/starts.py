"""Table of the recorded starts."""

from collections.abc import Mapping

from sqlalchemy import Double, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import StartSource


class StartRow(Base):
    """What a recorded start shows (core.starts). curve: current and voltage over time.

    recording_id: of a start that a report alone tells, an id made of motor and time.

    model: torque, parameters, sideband and stress; null where they hold figures that are no numbers.

    report: what the relay's motor start report tells of the same start; null where none was brought.

    It outlives a recording that a rule of retention deletes, because later starts are compared with it.
    """

    __tablename__ = "starts"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    is_from_rest: Mapped[bool]
    acceleration_s: Mapped[float | None] = mapped_column(Double)
    peak_current_A: Mapped[float] = mapped_column(Double)
    crest_current_A: Mapped[float] = mapped_column(Double)
    running_current_A: Mapped[float | None] = mapped_column(Double)
    lowest_voltage_V: Mapped[float | None] = mapped_column(Double)
    i2t_A2s: Mapped[float] = mapped_column(Double)
    i2t_over_s: Mapped[float] = mapped_column(Double)
    rated_current_A: Mapped[float] = mapped_column(Double)
    rated_voltage_V: Mapped[float] = mapped_column(Double)
    curve: Mapped[Mapping[str, object]]
    model: Mapped[Mapping[str, object] | None]
    source: Mapped[StartSource] = mapped_column(server_default=StartSource.RECORDING)
    report: Mapped[Mapping[str, object] | None]

    __table_args__ = (
        Index("ix_starts_motor_time_ns_recording_id", "motor", "time_ns", "recording_id"),
        Index("ix_starts_motor_source_time_ns_recording_id", "motor", "source", "time_ns", "recording_id"),
        Index("ix_starts_time_ns_recording_id", "time_ns", "recording_id"),
    )
