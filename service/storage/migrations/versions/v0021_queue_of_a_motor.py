"""A job has its motor, so that the queued diagnoses of one are counted without looking at those of others.

Jobs that have ended are never counted: those of before keep an empty name.
"""

import sqlalchemy as sa
from alembic import op

revision = "0021"
down_revision = "0020"
branch_labels = None
depends_on = None

QUEUED = sa.text("state = 'queued'")


def upgrade() -> None:
    op.add_column("jobs", sa.Column("motor", sa.String(), nullable=False, server_default=""))
    op.execute(
        sa.text(
            "UPDATE jobs SET motor = (SELECT motor FROM recordings WHERE recordings.id = jobs.recording_id)"
            " WHERE state IN ('queued', 'running')"
        )
    )
    op.create_index("ix_jobs_queued", "jobs", ["motor"], sqlite_where=QUEUED, postgresql_where=QUEUED)


def downgrade() -> None:
    op.drop_index("ix_jobs_queued", table_name="jobs")
    op.drop_column("jobs", "motor")
