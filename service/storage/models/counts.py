"""The table of how many rows there are in each state."""

from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base


class StateCountRow(Base):
    """How many rows of a table are in a state. Every state of every counted table has its row."""

    __tablename__ = "state_counts"

    counted_table: Mapped[str] = mapped_column(primary_key=True)
    state: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int]
