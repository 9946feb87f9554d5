"""Tables of what people found when they inspected motors."""

from sqlalchemy import ForeignKey, Index, LargeBinary, String
from sqlalchemy.orm import Mapped, mapped_column

from core.condition.kinds import Kind
from service.storage.models.base import Base
from service.storage.states import InspectionOutcome


class InspectionRow(Base):
    """What an inspection of a motor found, beside what the service had said of it. Nothing is judged by it.

    time_ns: when it was. kind, finding: what was said, "none" for nothing. cause: what it was, where that is
    something else. alarm_id: the alarm that it was about; null where it was about none.
    account: that told it. by: whom somebody named, else the account.
    withdrawn_...: it was wrong, and counts no more; null while it counts.
    """

    __tablename__ = "inspections"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    kind: Mapped[Kind]
    finding: Mapped[str]
    outcome: Mapped[InspectionOutcome]
    cause: Mapped[str | None]
    text: Mapped[str]
    alarm_id: Mapped[str | None] = mapped_column(String(36))
    account: Mapped[str]
    by: Mapped[str]
    made_ns: Mapped[int]
    withdrawn_ns: Mapped[int | None]
    withdrawn_account: Mapped[str | None]
    withdrawn_reason: Mapped[str | None]

    __table_args__ = (Index("ix_inspections_motor_time_ns_id", "motor", "time_ns", "id"),)


class InspectionPictureRow(Base):
    """A picture of an inspection, as somebody gave it: PNG or JPEG by its signature. number: from 1 on."""

    __tablename__ = "inspection_pictures"

    inspection: Mapped[str] = mapped_column(ForeignKey("inspections.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), index=True)
    media_type: Mapped[str] = mapped_column(String(16))
    size_bytes: Mapped[int]
    content: Mapped[bytes] = mapped_column(LargeBinary)
