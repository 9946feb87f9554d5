"""How long recordings are, series of them that were asked for, and recordings joined from these.

Recordings that were diagnosed before have no length until they are diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0044"
down_revision = "0043"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("recordings", sa.Column("duration_s", sa.Double(), nullable=True))
    op.add_column("recordings", sa.Column("pre_trigger_s", sa.Double(), nullable=True))
    op.add_column("recordings", sa.Column("parts", sa.JSON(), nullable=True))
    op.add_column("recording_requests", sa.Column("seconds", sa.Double(), nullable=True))
    op.add_column("recording_requests", sa.Column("triggers", sa.BigInteger(), nullable=True))
    op.add_column("recording_requests", sa.Column("joined_recording_id", sa.String(36), nullable=True))
    op.add_column("recording_requests", sa.Column("joined_remark", sa.String(), nullable=True))


def downgrade() -> None:
    for column in ("joined_remark", "joined_recording_id", "triggers", "seconds"):
        op.drop_column("recording_requests", column)
    for column in ("parts", "pre_trigger_s", "duration_s"):
        op.drop_column("recordings", column)
