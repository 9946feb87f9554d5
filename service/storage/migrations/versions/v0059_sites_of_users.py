"""Users and tokens may be limited to sites."""

import sqlalchemy as sa
from alembic import op

revision = "0059"
down_revision = "0058"
branch_labels = None
depends_on = None

TABLES = ("users", "api_tokens")


def upgrade() -> None:
    for table in TABLES:
        op.add_column(table, sa.Column("sites", sa.JSON(none_as_null=True), nullable=True))


def downgrade() -> None:
    for table in reversed(TABLES):
        op.drop_column(table, "sites")
