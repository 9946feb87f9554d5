"""Measured values of the motors over time."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

QUANTITIES = (
    "ia_A",
    "ib_A",
    "ic_A",
    "vab_V",
    "vbc_V",
    "vca_V",
    "va_V",
    "vb_V",
    "vc_V",
    "power_W",
    "reactive_power_var",
    "power_factor",
    "frequency_Hz",
)


def upgrade() -> None:
    op.create_table(
        "measurements",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("step_s", sa.BigInteger(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("samples", sa.BigInteger(), nullable=False),
        *(sa.Column(quantity, sa.Double(), nullable=True) for quantity in QUANTITIES),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_measurements_motor_motors")),
        sa.PrimaryKeyConstraint("motor", "step_s", "time_ns", name=op.f("pk_measurements")),
    )
    op.create_index("ix_measurements_step_s_time_ns", "measurements", ["step_s", "time_ns"])


def downgrade() -> None:
    op.drop_table("measurements")
