"""Tables of the plant: sites, relays and motors."""

from sqlalchemy import ForeignKey, LargeBinary
from sqlalchemy.orm import Mapped, mapped_column

from core.machines.parameters import ParametersSource
from service.storage.models.base import Base
from service.storage.states import ClockQuality, LinkState


class SiteRow(Base):
    """A site. planned_stop_ns: when all its motors stop next, as somebody planned; null without a plan."""

    __tablename__ = "sites"

    name: Mapped[str] = mapped_column(primary_key=True)
    description: Mapped[str]
    in_service: Mapped[bool]
    planned_stop_ns: Mapped[int | None]


class IedRow(Base):
    __tablename__ = "ieds"

    name: Mapped[str] = mapped_column(primary_key=True)
    site: Mapped[str] = mapped_column(ForeignKey("sites.name"))
    host: Mapped[str]
    port: Mapped[int]
    manufacturer: Mapped[str]
    type: Mapped[str]
    in_service: Mapped[bool]
    link_state: Mapped[LinkState]
    link_reason: Mapped[str | None]
    link_changed_ns: Mapped[int | None]
    last_success_ns: Mapped[int | None]
    entry_id: Mapped[bytes | None] = mapped_column(LargeBinary)
    entry_report_control: Mapped[str | None]
    clock_offset_ns: Mapped[int | None]
    clock_uncertainty_ns: Mapped[int | None]
    clock_quality: Mapped[ClockQuality | None]
    clock_measured_ns: Mapped[int | None]


class MotorRow(Base):
    """A motor. bus: with whose other motors it is compared. parameters_source: of the motors file.

    planned_stop_ns: when it stops next, as somebody planned; null without a plan.
    """

    __tablename__ = "motors"

    name: Mapped[str] = mapped_column(primary_key=True)
    description: Mapped[str]
    site: Mapped[str] = mapped_column(ForeignKey("sites.name"))
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), index=True)
    in_service: Mapped[bool]
    schedule: Mapped[str | None]
    bus: Mapped[str | None]
    parameters_source: Mapped[ParametersSource]
    planned_stop_ns: Mapped[int | None]
