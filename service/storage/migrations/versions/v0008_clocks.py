"""The relays' clocks: how far from ours, of a relay now and of each recording when it was stored."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None

TABLES = ("ieds", "recordings")
TIMES = ("clock_offset_ns", "clock_uncertainty_ns", "clock_measured_ns")


def upgrade() -> None:
    for table in TABLES:
        for column in TIMES:
            op.add_column(table, sa.Column(column, sa.BigInteger(), nullable=True))
        op.add_column(table, sa.Column("clock_quality", sa.String(length=16), nullable=True))


def downgrade() -> None:
    for table in TABLES:
        for column in (*TIMES, "clock_quality"):
            op.drop_column(table, column)
