"""Starts that a relay's motor start report tells, alone or beside a recording."""

import sqlalchemy as sa
from alembic import op

revision = "0045"
down_revision = "0044"
branch_labels = None
depends_on = None

INDEX = "ix_starts_motor_source_time_ns_recording_id"


def upgrade() -> None:
    op.add_column("starts", sa.Column("source", sa.String(16), nullable=False, server_default="recording"))
    op.add_column("starts", sa.Column("report", sa.JSON(), nullable=True))
    op.create_index(INDEX, "starts", ["motor", "source", "time_ns", "recording_id"])


def downgrade() -> None:
    op.drop_index(INDEX, "starts")
    op.execute("DELETE FROM starts WHERE source = 'report'")
    op.drop_column("starts", "report")
    op.drop_column("starts", "source")
