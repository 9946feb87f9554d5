"""What an unclear kind may be, with each condition and in its history; of older ones it is not known."""

import sqlalchemy as sa
from alembic import op

revision = "0026"
down_revision = "0025"
branch_labels = None
depends_on = None

TABLES = ("observations", "conditions", "condition_changes")


def upgrade() -> None:
    for table in TABLES:
        op.add_column(table, sa.Column("candidates", sa.String(), nullable=True))


def downgrade() -> None:
    for table in TABLES:
        op.drop_column(table, "candidates")
