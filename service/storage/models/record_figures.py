"""Table of what recordings show of the air gap, of the load's swings and of the supply."""

from typing import Final

from sqlalchemy import JSON, Double, ForeignKey, Index, String, text
from sqlalchemy.orm import Mapped, mapped_column

from core.quantities import Quantity, Subject, of_subject
from service.storage.models.base import Base

FIGURE_SUBJECTS: Final = (Subject.AIR_GAP, Subject.LOAD, Subject.SUPPLY)
FIGURE_COLUMNS: Final[tuple[Quantity, ...]] = tuple(one for of in FIGURE_SUBJECTS for one in of_subject(of))


def _of_those_that_tell(details: str) -> Index:
    """Return the index of a motor's records that tell of a subject, in the order of time."""
    tells = text(f"{details} IS NOT NULL")
    columns = ("motor", "time_ns", "recording_id")
    return Index(f"ix_record_figures_{details}", *columns, sqlite_where=tells, postgresql_where=tells)


class RecordFiguresRow(Base):
    """What a recording shows beside its winding and its rotor: a column for each figure of the catalogue.

    air_gap, load, supply: what is told of each beside its figures, as its reasons; null where nothing of it
    was looked for. The row outlives a recording that a rule of retention deletes, as the motor's trend does.
    """

    __tablename__ = "record_figures"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    air_gap: Mapped[dict[str, object] | None] = mapped_column(JSON(none_as_null=True))
    load: Mapped[dict[str, object] | None] = mapped_column(JSON(none_as_null=True))
    supply: Mapped[dict[str, object] | None] = mapped_column(JSON(none_as_null=True))

    __table_args__ = (_of_those_that_tell("air_gap"), _of_those_that_tell("supply"))


for quantity in FIGURE_COLUMNS:
    setattr(RecordFiguresRow, quantity.name, mapped_column(quantity.name, Double, nullable=True))
