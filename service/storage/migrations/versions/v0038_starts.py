"""What recorded starts show: how long they take, what they draw, how far the voltage falls.

Starts that were recorded before have no figures until their recordings are diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0038"
down_revision = "0037"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "starts",
        sa.Column("recording_id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("is_from_rest", sa.Boolean(), nullable=False),
        sa.Column("acceleration_s", sa.Double(), nullable=True),
        sa.Column("peak_current_A", sa.Double(), nullable=False),
        sa.Column("crest_current_A", sa.Double(), nullable=False),
        sa.Column("running_current_A", sa.Double(), nullable=True),
        sa.Column("lowest_voltage_V", sa.Double(), nullable=True),
        sa.Column("i2t_A2s", sa.Double(), nullable=False),
        sa.Column("i2t_over_s", sa.Double(), nullable=False),
        sa.Column("rated_current_A", sa.Double(), nullable=False),
        sa.Column("rated_voltage_V", sa.Double(), nullable=False),
        sa.Column("curve", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_starts_motor_motors")),
        sa.PrimaryKeyConstraint("recording_id", name=op.f("pk_starts")),
    )
    op.create_index("ix_starts_motor_time_ns_recording_id", "starts", ["motor", "time_ns", "recording_id"])
    op.create_index("ix_starts_time_ns_recording_id", "starts", ["time_ns", "recording_id"])


def downgrade() -> None:
    op.drop_table("starts")
