"""Trends over years are drawn from an index alone.

The index is written anew, with what is said from each record on: seconds for a million records.
"""

from alembic import op

revision = "0053"
down_revision = "0052"
branch_labels = None
depends_on = None

BEFORE = "ix_observations_motor_time_ns_recording_id"
TREND = "ix_observations_trend"
TIME = ("motor", "time_ns", "recording_id")
FIGURES = ("state", "mu_f", "mu_f_ci95_low", "mu_f_ci95_high")


def upgrade() -> None:
    op.create_index(TREND, "observations", [*TIME, *FIGURES])
    op.drop_index(BEFORE, table_name="observations")


def downgrade() -> None:
    op.create_index(BEFORE, "observations", [*TIME])
    op.drop_index(TREND, table_name="observations")
