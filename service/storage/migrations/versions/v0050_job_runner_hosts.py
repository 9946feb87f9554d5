"""On which host a job runner is, and how many workers it has."""

import sqlalchemy as sa
from alembic import op

revision = "0050"
down_revision = "0049"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("job_runners", sa.Column("host", sa.String(), nullable=False, server_default=""))
    op.add_column("job_runners", sa.Column("process_id", sa.BigInteger(), nullable=False, server_default="0"))
    op.add_column("job_runners", sa.Column("workers", sa.BigInteger(), nullable=False, server_default="0"))


def downgrade() -> None:
    for column in ("workers", "process_id", "host"):
        op.drop_column("job_runners", column)
