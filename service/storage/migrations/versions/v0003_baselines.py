"""Recordings that stand for a motor's healthy condition."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "baseline_recordings",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("recording_id", sa.String(length=36), nullable=False),
        sa.Column("chosen_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_baseline_recordings_motor_motors")),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_baseline_recordings_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("motor", "recording_id", name=op.f("pk_baseline_recordings")),
    )


def downgrade() -> None:
    op.drop_table("baseline_recordings")
