"""Alarms have a life after ISA-18.2: state, priority and a journal; they may be about a site or the service.

Those that stand call for somebody; those that are cleared are over. What happened to them so far is taken
into the journal, as seen by the notifications, so that no old alarm calls anybody.
"""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0033"
down_revision = "0032"
branch_labels = None
depends_on = None

STANDING = sa.text("cleared_ns IS NULL")
CLEARED = sa.text("cleared_ns IS NOT NULL")
OPEN = sa.text("state <> 'normal'")
SHELVED = sa.text("state = 'shelved'")
UNROUTED = sa.text("routed_ns IS NULL")
ANNOUNCED = sa.text("after = 'unacknowledged'")

BEFORE: dict[str, tuple[list[str], sa.TextClause | None]] = {
    "ix_alarms_ied_cleared_ns": (["ied", "cleared_ns"], None),
    "ix_alarms_raised_ns_id": (["raised_ns", "id"], None),
    "ix_alarms_ied_raised_ns_id": (["ied", "raised_ns", "id"], None),
    "ix_alarms_standing": (["ied", "kind", "subject"], STANDING),
    "ix_alarms_standing_raised_ns_id": (["raised_ns", "id"], STANDING),
    "ix_alarms_standing_ied_raised_ns_id": (["ied", "raised_ns", "id"], STANDING),
    "ix_alarms_cleared_raised_ns_id": (["raised_ns", "id"], CLEARED),
    "ix_alarms_cleared_ied_raised_ns_id": (["ied", "raised_ns", "id"], CLEARED),
    "ix_alarms_motor_raised_ns_id": (["motor", "raised_ns", "id"], None),
    "ix_alarms_standing_motor_raised_ns_id": (["motor", "raised_ns", "id"], STANDING),
    "ix_alarms_cleared_motor_raised_ns_id": (["motor", "raised_ns", "id"], CLEARED),
}
AFTER = BEFORE | {
    "ix_alarms_open_cause": (["ied", "motor", "kind", "subject"], OPEN),
    "ix_alarms_open_urgency_raised_ns_id": (["urgency", "raised_ns", "id"], OPEN),
    **{
        f"ix_alarms_open_{column}_urgency": ([column, "urgency", "raised_ns", "id"], OPEN)
        for column in ("site", "ied", "motor", "state")
    },
    "ix_alarms_shelved_until_ns": (["shelved_until_ns"], SHELVED),
}

NEW: dict[str, sa.types.TypeEngine[Any]] = {
    "site": sa.String(),
    "recording_id": sa.String(36),
    "priority": sa.String(16),
    "state": sa.String(32),
    "urgency": sa.BigInteger(),
    "value": sa.Double(),
    "seen_value": sa.Double(),
    "raises": sa.BigInteger(),
    "changed_ns": sa.BigInteger(),
    "changed_by": sa.String(),
    "comment": sa.String(),
    "shelved_until_ns": sa.BigInteger(),
    "shelved_above": sa.Double(),
    "suppressed_because": sa.String(),
}
REQUIRED = ("priority", "state", "urgency", "raises", "changed_ns", "changed_by")

FILL = """
    UPDATE alarms SET
        site = (SELECT site FROM ieds WHERE ieds.name = alarms.ied),
        priority = CASE kind
            WHEN 'condition-fault' THEN 'high'
            WHEN 'condition-watch' THEN 'medium'
            WHEN 'quarantined' THEN 'medium'
            ELSE 'low'
        END,
        urgency = CASE WHEN cleared_ns IS NULL THEN 30 ELSE 0 END + CASE kind
            WHEN 'condition-fault' THEN 2
            WHEN 'condition-watch' THEN 1
            WHEN 'quarantined' THEN 1
            ELSE 0
        END,
        state = CASE WHEN cleared_ns IS NULL THEN 'unacknowledged' ELSE 'normal' END,
        raises = 1,
        changed_ns = coalesce(cleared_ns, raised_ns),
        changed_by = 'statorwatch'
"""
JOURNAL = """
    INSERT INTO alarm_changes (alarm, changed_ns, event, before, after, by, comment, routed_ns)
    SELECT id, raised_ns, 'raised', 'normal', 'unacknowledged', 'statorwatch', reason, raised_ns
    FROM alarms ORDER BY raised_ns, id
"""
CLEARINGS = """
    INSERT INTO alarm_changes (alarm, changed_ns, event, before, after, by, comment, routed_ns)
    SELECT id, cleared_ns, 'cleared', 'unacknowledged', 'normal', 'statorwatch', NULL, cleared_ns
    FROM alarms WHERE cleared_ns IS NOT NULL ORDER BY cleared_ns, id
"""


def upgrade() -> None:
    for name in BEFORE:
        op.drop_index(name, table_name="alarms")
    with op.batch_alter_table("alarms") as table:
        for name, kind in NEW.items():
            table.add_column(sa.Column(name, kind, nullable=True))
        table.alter_column("ied", existing_type=sa.String(), nullable=True)
        table.alter_column("kind", existing_type=sa.String(16), type_=sa.String(32), existing_nullable=False)
    with op.batch_alter_table("standing_alarm_counts") as table:
        table.alter_column("kind", existing_type=sa.String(16), type_=sa.String(32), existing_nullable=False)
    op.execute(sa.text(FILL))
    with op.batch_alter_table("alarms") as table:
        for name in REQUIRED:
            table.alter_column(name, existing_type=NEW[name], nullable=False)
    for name, (columns, condition) in AFTER.items():
        op.create_index(name, "alarms", columns, sqlite_where=condition, postgresql_where=condition)
    _make_journal()


def _make_journal() -> None:
    op.create_table(
        "alarm_changes",
        sa.Column(
            "sequence",
            sa.BigInteger().with_variant(sa.Integer(), "sqlite"),
            autoincrement=True,
            nullable=False,
        ),
        sa.Column("alarm", sa.String(36), nullable=False),
        sa.Column("changed_ns", sa.BigInteger(), nullable=False),
        sa.Column("event", sa.String(32), nullable=False),
        sa.Column("before", sa.String(32), nullable=False),
        sa.Column("after", sa.String(32), nullable=False),
        sa.Column("by", sa.String(), nullable=False),
        sa.Column("comment", sa.String(), nullable=True),
        sa.Column("routed_ns", sa.BigInteger(), nullable=True),
        sa.ForeignKeyConstraint(
            ["alarm"], ["alarms.id"], name=op.f("fk_alarm_changes_alarm_alarms"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("sequence", name=op.f("pk_alarm_changes")),
    )
    for statement in (JOURNAL, CLEARINGS):
        op.execute(sa.text(statement))
    op.create_index("ix_alarm_changes_alarm_sequence", "alarm_changes", ["alarm", "sequence"])
    for name, condition, columns in (
        ("ix_alarm_changes_unrouted", UNROUTED, ["sequence"]),
        ("ix_alarm_changes_announced", ANNOUNCED, ["changed_ns", "alarm"]),
    ):
        op.create_index(name, "alarm_changes", columns, sqlite_where=condition, postgresql_where=condition)


def downgrade() -> None:
    op.drop_table("alarm_changes")
    op.execute(sa.text("DELETE FROM alarms WHERE ied IS NULL"))
    op.execute(sa.text("DELETE FROM alarms WHERE length(kind) > 16"))
    op.execute(sa.text("DELETE FROM standing_alarm_counts WHERE length(kind) > 16"))
    for name in AFTER:
        op.drop_index(name, table_name="alarms")
    with op.batch_alter_table("alarms") as table:
        for name in NEW:
            table.drop_column(name)
        table.alter_column("ied", existing_type=sa.String(), nullable=False)
        table.alter_column("kind", existing_type=sa.String(32), type_=sa.String(16), existing_nullable=False)
    with op.batch_alter_table("standing_alarm_counts") as table:
        table.alter_column("kind", existing_type=sa.String(32), type_=sa.String(16), existing_nullable=False)
    for name, (columns, condition) in BEFORE.items():
        op.create_index(name, "alarms", columns, sqlite_where=condition, postgresql_where=condition)
