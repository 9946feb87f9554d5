"""The table of what the relays measured."""

from sqlalchemy import Double, ForeignKey, Index
from sqlalchemy.orm import Mapped, mapped_column

from service.plant import MeteredQuantity
from service.storage.models.base import Base
from service.storage.states import MeasurementSource


class MeasurementRow(Base):
    """Values a relay measured: of one time (step_s = 0), or means of `step_s` seconds from `time_ns` on.

    It has a column for each MeteredQuantity, null where the relay has no such value.
    """

    __tablename__ = "measurements"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    step_s: Mapped[int] = mapped_column(primary_key=True)
    time_ns: Mapped[int] = mapped_column(primary_key=True)
    samples: Mapped[int]
    source: Mapped[MeasurementSource] = mapped_column(server_default=MeasurementSource.POLLED)

    __table_args__ = (
        Index("ix_measurements_step_s_time_ns", "step_s", "time_ns"),
        {"postgresql_partition_by": "RANGE (step_s, time_ns)"},
    )


for quantity in MeteredQuantity:
    setattr(MeasurementRow, quantity.value, mapped_column(Double))
