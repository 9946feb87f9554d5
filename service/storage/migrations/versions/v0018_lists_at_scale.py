"""Every list has an index for each of its filters, and the numbers of standing alarms are kept."""

from collections.abc import Mapping

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"
branch_labels = None
depends_on = None

STANDING = sa.text("cleared_ns IS NULL")
CLEARED = sa.text("cleared_ns IS NOT NULL")

NEW = {
    "ix_recordings_state_announced_ns_id": ("recordings", ["state", "announced_ns", "id"], None),
    "ix_recordings_motor_state_announced_ns_id": (
        "recordings",
        ["motor", "state", "announced_ns", "id"],
        None,
    ),
    "ix_recording_requests_motor_requested_ns_id": (
        "recording_requests",
        ["motor", "requested_ns", "id"],
        None,
    ),
    "ix_alarms_ied_raised_ns_id": ("alarms", ["ied", "raised_ns", "id"], None),
    "ix_alarms_standing": ("alarms", ["ied", "kind", "subject"], STANDING),
    "ix_alarms_standing_raised_ns_id": ("alarms", ["raised_ns", "id"], STANDING),
    "ix_alarms_standing_ied_raised_ns_id": ("alarms", ["ied", "raised_ns", "id"], STANDING),
    "ix_alarms_cleared_raised_ns_id": ("alarms", ["raised_ns", "id"], CLEARED),
    "ix_alarms_cleared_ied_raised_ns_id": ("alarms", ["ied", "raised_ns", "id"], CLEARED),
}
OLD = {
    "ix_alarms_standing": ("alarms", ["ied", "kind"], STANDING),
}
Indexes = Mapping[str, tuple[str, list[str], sa.TextClause | None]]


def upgrade() -> None:
    counts = op.create_table(
        "standing_alarm_counts",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("number", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_standing_alarm_counts_ied_ieds")),
        sa.PrimaryKeyConstraint("ied", "kind", name=op.f("pk_standing_alarm_counts")),
    )
    ied, kind = sa.column("ied", sa.String()), sa.column("kind", sa.String())
    standing = (
        sa.select(ied, kind, sa.func.count())
        .select_from(sa.table("alarms"))
        .where(sa.column("cleared_ns").is_(None))
        .group_by(ied, kind)
    )
    op.execute(counts.insert().from_select(["ied", "kind", "number"], standing))
    _replace(OLD, NEW)


def downgrade() -> None:
    _replace(NEW, OLD)
    op.drop_table("standing_alarm_counts")


def _replace(before: Indexes, after: Indexes) -> None:
    for name, (table, _columns, _condition) in before.items():
        op.drop_index(name, table_name=table)
    for name, (table, columns, condition) in after.items():
        op.create_index(name, table, columns, sqlite_where=condition, postgresql_where=condition)
