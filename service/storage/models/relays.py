"""Tables of what is known of the relays: who visits them, their links and findings."""

from collections.abc import Mapping

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import LinkState


class GatewayRow(Base):
    """A process that visits relays. `heartbeats` goes up as long as it lives.

    problem: what did not work in it at the latest heartbeat.
    """

    __tablename__ = "gateways"

    id: Mapped[str] = mapped_column(primary_key=True)
    host: Mapped[str]
    process_id: Mapped[int]
    heartbeats: Mapped[int] = mapped_column("beats")
    started_ns: Mapped[int]
    problem: Mapped[str | None]


class LeaseRow(Base):
    """The gateway that visits a relay: no other does."""

    __tablename__ = "leases"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    gateway: Mapped[str] = mapped_column(ForeignKey("gateways.id"), index=True)


class QuarantineRow(Base):
    """A relay set aside until `until_ns`, or back since, not trusted yet. `times`: 0 where only suspected."""

    __tablename__ = "quarantines"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    reason: Mapped[str]
    times: Mapped[int]
    since_ns: Mapped[int]
    until_ns: Mapped[int]


class LinkChangeRow(Base):
    """One change of a link's state, or of the reason why it is down."""

    __tablename__ = "link_changes"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"))
    changed_ns: Mapped[int]
    state: Mapped[LinkState]
    reason: Mapped[str | None]

    __table_args__ = (Index("ix_link_changes_ied_changed_ns_id", "ied", "changed_ns", "id"),)


class LinkFiguresRow(Base):
    """What went over a link since the relay is known; `day_bytes` in the UTC day `day` (days since 1970)."""

    __tablename__ = "link_figures"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    round_trip_s: Mapped[float | None]
    connections: Mapped[int]
    received_bytes: Mapped[int]
    reports: Mapped[int]
    report_gaps: Mapped[int]
    day: Mapped[int]
    day_bytes: Mapped[int]


class RelayFindingsRow(Base):
    """What was found at a relay when it was last visited: what is used of it, what is not as promised."""

    __tablename__ = "relay_findings"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    found_ns: Mapped[int]
    acquisition: Mapped[Mapping[str, object]]
    differences: Mapped[list[Mapping[str, object]]]
    ignored_files: Mapped[list[Mapping[str, object]]]
    ignored_in_all: Mapped[int]
