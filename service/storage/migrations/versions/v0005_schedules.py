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
    with op.batch_alter_table("event_reports") as table:
        table.drop_column("origin")
    with op.batch_alter_table("motors") as table:
        table.drop_column("schedule")
