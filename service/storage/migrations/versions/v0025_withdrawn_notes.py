"""A note that was wrong can be withdrawn; who did so, when and why is kept with it."""

import sqlalchemy as sa
from alembic import op

revision = "0025"
down_revision = "0024"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("condition_events", sa.Column("withdrawn_ns", sa.BigInteger(), nullable=True))
    op.add_column("condition_events", sa.Column("withdrawn_by", sa.String(), nullable=True))
    op.add_column("condition_events", sa.Column("withdrawn_reason", sa.String(), nullable=True))


def downgrade() -> None:
    for name in ("withdrawn_reason", "withdrawn_by", "withdrawn_ns"):
        op.drop_column("condition_events", name)
