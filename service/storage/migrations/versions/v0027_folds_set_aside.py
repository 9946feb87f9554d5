"""A motor whose fold fails again and again is set aside; why is kept with its condition."""

import sqlalchemy as sa
from alembic import op

revision = "0027"
down_revision = "0026"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("conditions", sa.Column("problem", sa.String(), nullable=True))
    op.add_column(
        "fold_marks", sa.Column("set_aside", sa.Boolean(), server_default=sa.false(), nullable=False)
    )


def downgrade() -> None:
    op.drop_column("fold_marks", "set_aside")
    op.drop_column("conditions", "problem")
