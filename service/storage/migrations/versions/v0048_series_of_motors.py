"""An index of the series of recordings that were asked for, by motor."""

import sqlalchemy as sa
from alembic import op

revision = "0048"
down_revision = "0047"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_index(
        "ix_recording_requests_series",
        "recording_requests",
        ["motor", "requested_ns"],
        sqlite_where=sa.text("seconds IS NOT NULL"),
        postgresql_where=sa.text("seconds IS NOT NULL"),
    )


def downgrade() -> None:
    op.drop_index("ix_recording_requests_series", table_name="recording_requests")
