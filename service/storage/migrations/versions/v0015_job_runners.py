"""A running job belongs to the job runner that claimed it, for as long as that renews its lease."""

import sqlalchemy as sa
from alembic import op

revision = "0015"
down_revision = "0014"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "job_runners",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("installation", sa.String(), nullable=False),
        sa.Column("renewals", sa.BigInteger(), nullable=False),
        sa.Column("started_ns", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_job_runners")),
    )
    op.add_column("jobs", sa.Column("runner", sa.String(length=36), nullable=True))


def downgrade() -> None:
    op.drop_column("jobs", "runner")
    op.drop_table("job_runners")
