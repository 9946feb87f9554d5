"""History and figures of each relay's link; alarms."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "link_changes",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("changed_ns", sa.BigInteger(), nullable=False),
        sa.Column("state", sa.String(length=16), nullable=False),
        sa.Column("reason", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_link_changes_ied_ieds")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_link_changes")),
    )
    op.create_index("ix_link_changes_ied_changed_ns_id", "link_changes", ["ied", "changed_ns", "id"])

    op.create_table(
        "link_figures",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("round_trip_s", sa.Double(), nullable=True),
        sa.Column("connections", sa.BigInteger(), nullable=False),
        sa.Column("received_bytes", sa.BigInteger(), nullable=False),
        sa.Column("reports", sa.BigInteger(), nullable=False),
        sa.Column("report_gaps", sa.BigInteger(), nullable=False),
        sa.Column("day", sa.BigInteger(), nullable=False),
        sa.Column("day_bytes", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_link_figures_ied_ieds")),
        sa.PrimaryKeyConstraint("ied", name=op.f("pk_link_figures")),
    )

    op.create_table(
        "alarms",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("kind", sa.String(length=16), nullable=False),
        sa.Column("subject", sa.String(), nullable=False),
        sa.Column("reason", sa.String(), nullable=False),
        sa.Column("raised_ns", sa.BigInteger(), nullable=False),
        sa.Column("cleared_ns", sa.BigInteger(), nullable=True),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_alarms_ied_ieds")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_alarms")),
    )
    op.create_index("ix_alarms_ied_cleared_ns", "alarms", ["ied", "cleared_ns"])
    op.create_index("ix_alarms_raised_ns_id", "alarms", ["raised_ns", "id"])


def downgrade() -> None:
    for table in ("alarms", "link_figures", "link_changes"):
        op.drop_table(table)
