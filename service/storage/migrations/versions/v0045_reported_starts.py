"""Starts that a relay's motor start report tells, alone or beside a recording."""

import sqlalchemy as sa
from alembic import op

revision = "0045"
down_revision = "0044"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("starts", sa.Column("source", sa.String(16), nullable=False, server_default="recording"))
    op.add_column("starts", sa.Column("report", sa.JSON(), nullable=True))


def downgrade() -> None:
    op.execute("DELETE FROM starts WHERE source = 'report'")
    op.drop_column("starts", "report")
    op.drop_column("starts", "source")
