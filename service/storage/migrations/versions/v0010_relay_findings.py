"""What was found at each relay, whose EntryID is kept, and the relays' own statistics."""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0008"
branch_labels = None
depends_on = None

STATISTICS = (
    "average_current_A",
    "maximum_current_A",
    "minimum_current_A",
    "average_voltage_V",
    "maximum_voltage_V",
    "minimum_voltage_V",
    "average_power_W",
    "maximum_power_W",
    "minimum_power_W",
    "maximum_ia_A",
    "maximum_ib_A",
    "maximum_ic_A",
    "minimum_ia_A",
    "minimum_ib_A",
    "minimum_ic_A",
    "maximum_vab_V",
    "maximum_vbc_V",
    "maximum_vca_V",
    "minimum_vab_V",
    "minimum_vbc_V",
    "minimum_vca_V",
)


def upgrade() -> None:
    op.create_table(
        "relay_findings",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("found_ns", sa.BigInteger(), nullable=False),
        sa.Column("acquisition", sa.JSON(), nullable=False),
        sa.Column("differences", sa.JSON(), nullable=False),
        sa.Column("ignored_files", sa.JSON(), nullable=False),
        sa.Column("ignored_in_all", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_relay_findings_ied_ieds")),
        sa.PrimaryKeyConstraint("ied", name=op.f("pk_relay_findings")),
    )
    op.add_column("ieds", sa.Column("entry_report_control", sa.String(), nullable=True))
    for quantity in STATISTICS:
        op.add_column("measurements", sa.Column(quantity, sa.Double(), nullable=True))


def downgrade() -> None:
    for quantity in STATISTICS:
        op.drop_column("measurements", quantity)
    op.drop_column("ieds", "entry_report_control")
    op.drop_table("relay_findings")
