"""Tables of alarms: what somebody has to look after, and all that happened to it."""

from sqlalchemy import (
    BigInteger,
    ColumnElement,
    ForeignKey,
    Index,
    Integer,
    String,
    TextClause,
    bindparam,
    text,
)
from sqlalchemy.orm import InstrumentedAttribute, Mapped, mapped_column

from core.condition.kinds import Kind
from service.storage.models.base import Base
from service.storage.states import AlarmEvent, AlarmKind, AlarmPriority, AlarmState

STANDING = text("cleared_ns IS NULL")
CLEARED = text("cleared_ns IS NOT NULL")
OPEN = text("state <> 'normal'")
SHELVED = text("state = 'shelved'")
MEMBER = text("part_of IS NOT NULL")
UNROUTED = text("routed_ns IS NULL")
ANNOUNCED = text("after = 'unacknowledged'")


def _partial(name: str, condition: TextClause, *columns: str) -> Index:
    """Return an index of those rows that meet a condition."""
    return Index(name, *columns, sqlite_where=condition, postgresql_where=condition)


class AlarmRow(Base):
    """One occurrence of something that somebody has to look after.

    Its cause stands until `cleared_ns`; `state` is what people and the plant's design have made of it. It is
    over when its state is normal. Until then the same cause raises no second alarm.

    site, ied, motor: where; null where it is not about one. subject: a file's name; of a motor's condition,
    its cause. urgency: order of lists, from state and priority. value: how bad the cause is, if it can grow;
    seen_value: how bad it was when somebody last acknowledged or shelved the alarm. raised_ns: the latest
    time; raises: how often. changed_ns, changed_by, comment: of the latest change of the state.
    shelved_until_ns, shelved_above: what ends the shelving, time or a value. suppressed_because: by design.
    part_of: the alarm that tells many like this one in one line. causes: of a motor's condition, the kinds of
    asymmetry that people were told.
    """

    __tablename__ = "alarms"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    site: Mapped[str | None]
    ied: Mapped[str | None] = mapped_column(ForeignKey("ieds.name"))
    motor: Mapped[str | None]
    kind: Mapped[AlarmKind]
    subject: Mapped[str]
    reason: Mapped[str]
    advice: Mapped[str | None]
    recording_id: Mapped[str | None] = mapped_column(String(36))
    priority: Mapped[AlarmPriority]
    state: Mapped[AlarmState]
    urgency: Mapped[int]
    value: Mapped[float | None]
    seen_value: Mapped[float | None]
    raised_ns: Mapped[int]
    raises: Mapped[int]
    cleared_ns: Mapped[int | None]
    changed_ns: Mapped[int]
    changed_by: Mapped[str]
    comment: Mapped[str | None]
    shelved_until_ns: Mapped[int | None]
    shelved_above: Mapped[float | None]
    suppressed_because: Mapped[str | None]
    part_of: Mapped[str | None] = mapped_column(String(36))
    causes: Mapped[tuple[Kind, ...]] = mapped_column(nullable=True)

    __table_args__ = (
        Index("ix_alarms_ied_cleared_ns", "ied", "cleared_ns"),
        Index("ix_alarms_raised_ns_id", "raised_ns", "id"),
        Index("ix_alarms_ied_raised_ns_id", "ied", "raised_ns", "id"),
        # A list of those that stand reads none of the many that are cleared, and the other way round.
        _partial("ix_alarms_standing", STANDING, "ied", "kind", "subject"),
        _partial("ix_alarms_standing_raised_ns_id", STANDING, "raised_ns", "id"),
        _partial("ix_alarms_standing_ied_raised_ns_id", STANDING, "ied", "raised_ns", "id"),
        _partial("ix_alarms_cleared_raised_ns_id", CLEARED, "raised_ns", "id"),
        _partial("ix_alarms_cleared_ied_raised_ns_id", CLEARED, "ied", "raised_ns", "id"),
        Index("ix_alarms_motor_raised_ns_id", "motor", "raised_ns", "id"),
        _partial("ix_alarms_standing_motor_raised_ns_id", STANDING, "motor", "raised_ns", "id"),
        _partial("ix_alarms_cleared_motor_raised_ns_id", CLEARED, "motor", "raised_ns", "id"),
        _partial("ix_alarms_open_cause", OPEN, "ied", "motor", "kind", "subject"),
        _partial("ix_alarms_open_urgency_raised_ns_id", OPEN, "urgency", "raised_ns", "id"),
        _partial("ix_alarms_open_site_urgency", OPEN, "site", "urgency", "raised_ns", "id"),
        _partial("ix_alarms_open_ied_urgency", OPEN, "ied", "urgency", "raised_ns", "id"),
        _partial("ix_alarms_open_motor_urgency", OPEN, "motor", "urgency", "raised_ns", "id"),
        _partial("ix_alarms_open_state_urgency", OPEN, "state", "urgency", "raised_ns", "id"),
        _partial("ix_alarms_shelved_until_ns", SHELVED, "shelved_until_ns"),
        _partial("ix_alarms_part_of", MEMBER, "part_of", "raised_ns", "id"),
        _partial("ix_alarms_standing_site_kind", STANDING, "site", "kind"),
    )


class AlarmChangeRow(Base):
    """One thing that happened to an alarm, in the order of `sequence`. Rows are added, never changed.

    routed_ns: when the notifications had a look at it; null until then. What was raised may have been
    acknowledged, shelved or suppressed since, even in the same transaction: the alarm itself tells.
    """

    __tablename__ = "alarm_changes"

    sequence: Mapped[int] = mapped_column(
        BigInteger().with_variant(Integer(), "sqlite"), primary_key=True, autoincrement=True
    )
    alarm: Mapped[str] = mapped_column(String(36), ForeignKey("alarms.id", ondelete="CASCADE"))
    changed_ns: Mapped[int]
    event: Mapped[AlarmEvent]
    before: Mapped[AlarmState]
    after: Mapped[AlarmState]
    by: Mapped[str]
    comment: Mapped[str | None]
    routed_ns: Mapped[int | None]

    __table_args__ = (
        Index("ix_alarm_changes_alarm_sequence", "alarm", "sequence"),
        _partial("ix_alarm_changes_unrouted", UNROUTED, "sequence"),
        _partial("ix_alarm_changes_announced", ANNOUNCED, "changed_ns", "alarm"),
    )


def in_state(state: AlarmState) -> ColumnElement[bool]:
    """Return the condition that alarms are in this state, as the partial indexes say it.

    SQLite takes such an index only where the statement has the index's own words, not a parameter. Not for
    those that are normal.
    """
    return (AlarmRow.state == _literal(AlarmRow.state, state)) & is_open()


def is_open() -> ColumnElement[bool]:
    """Return the condition that alarms are not over, as the partial indexes say it."""
    return AlarmRow.state != _literal(AlarmRow.state, AlarmState.NORMAL)


def announced() -> ColumnElement[bool]:
    """Return the condition that changes made alarms call for somebody, as the partial index says it."""
    return AlarmChangeRow.after == _literal(AlarmChangeRow.after, AlarmState.UNACKNOWLEDGED)


def _literal(column: InstrumentedAttribute[AlarmState], state: AlarmState) -> ColumnElement[AlarmState]:
    return bindparam(None, state, type_=column.type, literal_execute=True)
