"""Tables of numbers that are kept, because to count would take longer every year."""

from sqlalchemy import ForeignKey
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import AlarmKind


class StateCountRow(Base):
    """How many rows of a table are in a state. Every state of every counted table has its row."""

    __tablename__ = "state_counts"

    counted_table: Mapped[str] = mapped_column(primary_key=True)
    state: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int]


class StandingAlarmCountRow(Base):
    """How many alarms of a kind stand at a relay; without a row, none ever stood."""

    __tablename__ = "standing_alarm_counts"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    kind: Mapped[AlarmKind] = mapped_column(primary_key=True)
    number: Mapped[int]
