"""A gateway says what does not work in it, with each heartbeat."""

import sqlalchemy as sa
from alembic import op

revision = "0016"
down_revision = "0015"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("gateways", sa.Column("problem", sa.String(), nullable=True))


def downgrade() -> None:
    op.drop_column("gateways", "problem")
