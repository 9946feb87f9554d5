"""Motors tell where their parameters come from: given, commissioned, from a data sheet, or typical."""

import sqlalchemy as sa
from alembic import op

revision = "0029"
down_revision = "0028"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column(
        "motors", sa.Column("parameters_source", sa.String(16), nullable=False, server_default="given")
    )


def downgrade() -> None:
    op.drop_column("motors", "parameters_source")
