"""How many rows there are in each state is kept, not counted anew; standing alarms are found by an index."""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"
branch_labels = None
depends_on = None

STATES = {
    "recordings": ("announced", "fetched", "diagnosed", "rejected", "failed"),
    "recording_requests": ("requested", "triggered", "recorded", "fetched", "diagnosed", "failed"),
    "jobs": ("queued", "running", "done", "failed"),
}


def upgrade() -> None:
    counts = op.create_table(
        "state_counts",
        sa.Column("counted_table", sa.String(), nullable=False),
        sa.Column("state", sa.String(), nullable=False),
        sa.Column("number", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("counted_table", "state", name=op.f("pk_state_counts")),
    )
    for table, states in STATES.items():
        state = sa.column("state", sa.String())
        present = sa.select(state, sa.func.count()).select_from(sa.table(table)).group_by(state)
        numbers = dict(op.get_bind().execute(present).all())
        op.bulk_insert(
            counts,
            [{"counted_table": table, "state": word, "number": numbers.get(word, 0)} for word in states],
        )
    op.create_index(
        "ix_alarms_standing",
        "alarms",
        ["ied", "kind"],
        sqlite_where=sa.text("cleared_ns IS NULL"),
        postgresql_where=sa.text("cleared_ns IS NULL"),
    )


def downgrade() -> None:
    op.drop_index("ix_alarms_standing", table_name="alarms")
    op.drop_table("state_counts")
