"""Gateways, and the leases by which they share out the relays."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "gateways",
        sa.Column("id", sa.String(), nullable=False),
        sa.Column("host", sa.String(), nullable=False),
        sa.Column("process_id", sa.BigInteger(), nullable=False),
        sa.Column("beats", sa.BigInteger(), nullable=False),
        sa.Column("started_ns", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_gateways")),
    )
    op.create_table(
        "leases",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("gateway", sa.String(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_leases_ied_ieds")),
        sa.ForeignKeyConstraint(["gateway"], ["gateways.id"], name=op.f("fk_leases_gateway_gateways")),
        sa.PrimaryKeyConstraint("ied", name=op.f("pk_leases")),
    )
    op.create_index(op.f("ix_leases_gateway"), "leases", ["gateway"])


def downgrade() -> None:
    for table in ("leases", "gateways"):
        op.drop_table(table)
