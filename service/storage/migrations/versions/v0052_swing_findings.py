"""What recordings show of the air gap, and of a load that swings.

Recordings that were diagnosed before are in the trend once they are diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0052"
down_revision = "0051"
branch_labels = None
depends_on = None

FIGURES = (
    "gap_permeance_ripple",
    "gap_standard_deviation",
    "gap_detection_limit",
    "gap_lower_sideband_dB",
    "gap_upper_sideband_dB",
    "turn_load_torque",
    "turn_load_torque_deviation",
    "turn_frequency_hz",
    "load_torque",
    "load_noise",
    "load_frequency_hz",
    "load_torque_deviation",
    "load_detection_limit",
)


def upgrade() -> None:
    op.create_table(
        "swing_findings",
        sa.Column("recording_id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        *(sa.Column(name, sa.Double(), nullable=True) for name in FIGURES),
        sa.Column("gap_reasons", sa.JSON(), nullable=False),
        sa.Column("load_reasons", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_swing_findings_motor_motors")),
        sa.PrimaryKeyConstraint("recording_id", name=op.f("pk_swing_findings")),
    )
    op.create_index(
        "ix_swing_findings_motor_time_ns_recording_id",
        "swing_findings",
        ["motor", "time_ns", "recording_id"],
    )


def downgrade() -> None:
    op.drop_table("swing_findings")
