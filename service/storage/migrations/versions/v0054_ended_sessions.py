"""When all sessions of a user were ended: those of gateways are no rows of their own."""

import sqlalchemy as sa
from alembic import op

revision = "0054"
down_revision = "0053"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("users", sa.Column("sessions_ended_ns", sa.BigInteger(), nullable=True))


def downgrade() -> None:
    op.drop_column("users", "sessions_ended_ns")
