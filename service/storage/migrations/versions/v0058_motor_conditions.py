"""A motor's condition is that of all its parts; that of its stator alone is kept beside it."""

import sqlalchemy as sa
from alembic import op

revision = "0058"
down_revision = "0057"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("conditions", sa.Column("stator", sa.JSON(), nullable=True))
    op.execute("UPDATE conditions SET stator = document")


def downgrade() -> None:
    op.drop_column("conditions", "stator")
