"""Relays that are set aside, because their answers crash the gateway or break the protocol."""

import sqlalchemy as sa
from alembic import op

revision = "0012"
down_revision = "0010"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "quarantines",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("reason", sa.String(), nullable=False),
        sa.Column("times", sa.BigInteger(), nullable=False),
        sa.Column("since_ns", sa.BigInteger(), nullable=False),
        sa.Column("until_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name="fk_quarantines_ied_ieds"),
        sa.PrimaryKeyConstraint("ied", name="pk_quarantines"),
    )


def downgrade() -> None:
    op.drop_table("quarantines")
