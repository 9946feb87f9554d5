"""Measured values from a relay's load profile, beside those that the service polled."""

import sqlalchemy as sa
from alembic import op

revision = "0047"
down_revision = "0046"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("measurements", sa.Column("source", sa.String(16), nullable=False, server_default="polled"))


def downgrade() -> None:
    op.execute("DELETE FROM measurements WHERE source = 'load-profile'")
    op.drop_column("measurements", "source")
