"""Schedules of motors; who asked for an event report."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("motors", sa.Column("schedule", sa.String(), nullable=True))
    op.add_column(
        "event_reports", sa.Column("origin", sa.String(length=16), nullable=False, server_default="request")
    )


def downgrade() -> None:
    # Not in batch mode: that drops the table, to which rows of others refer.
    op.drop_column("event_reports", "origin")
    op.drop_column("motors", "schedule")
