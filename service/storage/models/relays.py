"""Tables of what is known of the relays: who visits them, their links, alarms and findings."""

from collections.abc import Mapping

from sqlalchemy import ForeignKey, Index, String, TextClause, text
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import AlarmKind, LinkState

STANDING = text("cleared_ns IS NULL")
CLEARED = text("cleared_ns IS NOT NULL")


def _of_alarms(name: str, condition: TextClause, *columns: str) -> Index:
    """Return an index of those alarms that meet a condition."""
    return Index(name, *columns, sqlite_where=condition, postgresql_where=condition)


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


class AlarmRow(Base):
    """What somebody has to look after; it stands until it is cleared.

    subject: a file's name; of a motor's condition, its cause.
    motor, advice: of a motor's condition, whose relay is `ied`; empty for what is about the relay itself.
    """

    __tablename__ = "alarms"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"))
    kind: Mapped[AlarmKind]
    subject: Mapped[str]
    reason: Mapped[str]
    raised_ns: Mapped[int]
    cleared_ns: Mapped[int | None]
    motor: Mapped[str | None]
    advice: Mapped[str | None]

    __table_args__ = (
        Index("ix_alarms_ied_cleared_ns", "ied", "cleared_ns"),
        Index("ix_alarms_raised_ns_id", "raised_ns", "id"),
        Index("ix_alarms_ied_raised_ns_id", "ied", "raised_ns", "id"),
        # A list of those that stand reads none of the many that are cleared, and the other way round.
        _of_alarms("ix_alarms_standing", STANDING, "ied", "kind", "subject"),
        _of_alarms("ix_alarms_standing_raised_ns_id", STANDING, "raised_ns", "id"),
        _of_alarms("ix_alarms_standing_ied_raised_ns_id", STANDING, "ied", "raised_ns", "id"),
        _of_alarms("ix_alarms_cleared_raised_ns_id", CLEARED, "raised_ns", "id"),
        _of_alarms("ix_alarms_cleared_ied_raised_ns_id", CLEARED, "ied", "raised_ns", "id"),
        Index("ix_alarms_motor_raised_ns_id", "motor", "raised_ns", "id"),
        _of_alarms("ix_alarms_standing_motor_raised_ns_id", STANDING, "motor", "raised_ns", "id"),
        _of_alarms("ix_alarms_cleared_motor_raised_ns_id", CLEARED, "motor", "raised_ns", "id"),
    )


class RelayFindingsRow(Base):
    """What was found at a relay when it was last visited: what is used of it, what is not as promised."""

    __tablename__ = "relay_findings"

    ied: Mapped[str] = mapped_column(ForeignKey("ieds.name"), primary_key=True)
    found_ns: Mapped[int]
    acquisition: Mapped[Mapping[str, object]]
    differences: Mapped[list[Mapping[str, object]]]
    ignored_files: Mapped[list[Mapping[str, object]]]
    ignored_in_all: Mapped[int]
