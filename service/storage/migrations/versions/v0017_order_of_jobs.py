"""Jobs have a priority, keys of clients and of schedules lie apart, and content and times have indexes."""

import sqlalchemy as sa
from alembic import op

revision = "0017"
down_revision = "0016"
branch_labels = None
depends_on = None

KEY = "ux_recording_requests_key"


def upgrade() -> None:
    op.drop_index(KEY, table_name="recording_requests")
    op.create_index(KEY, "recording_requests", ["motor", "origin", "idempotency_key"], unique=True)
    op.add_column("jobs", sa.Column("priority", sa.BigInteger(), nullable=False, server_default="0"))
    op.drop_index("ix_jobs_state_not_before_ns", table_name="jobs")
    op.create_index(
        "ix_jobs_state_priority_not_before_ns_id", "jobs", ["state", "priority", "not_before_ns", "id"]
    )
    op.create_index("ix_recordings_digest", "recordings", ["digest"])
    op.create_index("ix_recordings_motor_recorded_ns_id", "recordings", ["motor", "recorded_ns", "id"])
    op.create_index(
        "ix_recordings_untimed",
        "recordings",
        ["motor", "announced_ns", "id"],
        sqlite_where=sa.text("recorded_ns IS NULL"),
        postgresql_where=sa.text("recorded_ns IS NULL"),
    )


def downgrade() -> None:
    for name in ("ix_recordings_untimed", "ix_recordings_motor_recorded_ns_id", "ix_recordings_digest"):
        op.drop_index(name, table_name="recordings")
    op.drop_index("ix_jobs_state_priority_not_before_ns_id", table_name="jobs")
    op.drop_column("jobs", "priority")
    op.create_index("ix_jobs_state_not_before_ns", "jobs", ["state", "not_before_ns"])
    op.drop_index(KEY, table_name="recording_requests")
    # A client's key may be one of a schedule now; the older tables cannot hold both.
    op.execute(
        sa.text(
            "UPDATE recording_requests SET idempotency_key = NULL"
            " WHERE origin = 'request' AND idempotency_key LIKE 'schedule %'"
        )
    )
    op.create_index(KEY, "recording_requests", ["motor", "idempotency_key"], unique=True)
