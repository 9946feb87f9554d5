"""Tables of what text reports of relays tell of their motors."""

from collections.abc import Mapping

from sqlalchemy import Double, ForeignKey
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import RelayEventKind


class RelayStatisticsRow(Base):
    """The relay's own statistics of a motor (MOT) at a time, since they were last reset there."""

    __tablename__ = "relay_statistics"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    time_ns: Mapped[int] = mapped_column(primary_key=True)
    since_ns: Mapped[int | None]
    running_s: Mapped[float | None] = mapped_column(Double)
    stopped_s: Mapped[float | None] = mapped_column(Double)
    starts: Mapped[int | None]
    mean_current_A: Mapped[float | None] = mapped_column(Double)
    peak_current_A: Mapped[float | None] = mapped_column(Double)
    peak_start_current_A: Mapped[float | None] = mapped_column(Double)
    longest_start_s: Mapped[float | None] = mapped_column(Double)
    trips: Mapped[Mapping[str, object]]


class RelayEventRow(Base):
    """A start, stop or trip of a motor in its relay's sequence of events (SER)."""

    __tablename__ = "relay_events"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    kind: Mapped[RelayEventKind] = mapped_column(primary_key=True)
    time_ns: Mapped[int] = mapped_column(primary_key=True)
