"""Table of what recordings show of the air gap, of the load's swings, of the supply and of the losses."""

from types import MappingProxyType
from typing import Final

from sqlalchemy import JSON, Double, ForeignKey, Index, String, text
from sqlalchemy.orm import InstrumentedAttribute, Mapped, mapped_column

from core.quantities import Quantity, Subject, of_subject
from service.storage.models.base import Base

FIGURE_SUBJECTS: Final = (Subject.AIR_GAP, Subject.LOAD, Subject.SUPPLY, Subject.LOSSES)
DETAILS: Final = MappingProxyType({subject: subject.replace(" ", "_") for subject in FIGURE_SUBJECTS})
"""Columns of what is told of a subject beside its figures, as its reasons; null where it was not sought."""
FIGURE_COLUMNS: Final[tuple[Quantity, ...]] = tuple(one for of in FIGURE_SUBJECTS for one in of_subject(of))


INDEXED: Final = ("air_gap", "supply")
"""What is looked up by motor and time; losses are told with a supply, swings with an air gap."""


def _of_those_that_tell(details: str) -> Index:
    """Return the index of a motor's records that tell of a subject, in the order of time."""
    tells = text(f"{details} IS NOT NULL")
    columns = ("motor", "time_ns", "recording_id")
    return Index(f"ix_record_figures_{details}", *columns, sqlite_where=tells, postgresql_where=tells)


class RecordFiguresRow(Base):
    """What a recording shows beside its winding and its rotor: a column for each figure of the catalogue.

    The row outlives a recording that a rule of retention deletes, as the motor's trend does.
    """

    __tablename__ = "record_figures"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]

    __table_args__ = tuple(map(_of_those_that_tell, INDEXED))


for details in DETAILS.values():
    setattr(RecordFiguresRow, details, mapped_column(details, JSON(none_as_null=True)))
for quantity in FIGURE_COLUMNS:
    setattr(RecordFiguresRow, quantity.name, mapped_column(quantity.name, Double, nullable=True))


def details_of(subject: Subject) -> InstrumentedAttribute[dict[str, object] | None]:
    """Return the column of what is told of a subject beside its figures."""
    column: InstrumentedAttribute[dict[str, object] | None] = getattr(RecordFiguresRow, DETAILS[subject])
    return column
