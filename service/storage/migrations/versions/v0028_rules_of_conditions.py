"""Conditions tell by which rules they were judged; a record whose fold fails is kept, with the reason."""

import sqlalchemy as sa
from alembic import op

revision = "0028"
down_revision = "0027"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("conditions", sa.Column("rules", sa.String(), nullable=True))
    for name in ("left_out", "left_out_by"):
        op.add_column("observations", sa.Column(name, sa.String(), nullable=True))


def downgrade() -> None:
    for name in ("left_out_by", "left_out"):
        op.drop_column("observations", name)
    op.drop_column("conditions", "rules")
