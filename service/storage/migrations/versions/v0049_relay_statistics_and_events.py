"""What reports of relays tell of their motors: statistics, and starts, stops and trips."""

import sqlalchemy as sa
from alembic import op

revision = "0049"
down_revision = "0048"
branch_labels = None
depends_on = None

FIGURES = (
    "running_s",
    "stopped_s",
    "mean_current_A",
    "peak_current_A",
    "peak_start_current_A",
    "longest_start_s",
)


def upgrade() -> None:
    op.create_table(
        "relay_statistics",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("since_ns", sa.BigInteger(), nullable=True),
        sa.Column("starts", sa.BigInteger(), nullable=True),
        *(sa.Column(name, sa.Double(), nullable=True) for name in FIGURES),
        sa.Column("trips", sa.JSON(), nullable=False),
        *_keys("relay_statistics", "motor", "time_ns"),
    )
    op.create_table(
        "relay_events",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        *_keys("relay_events", "motor", "kind", "time_ns"),
    )


def downgrade() -> None:
    op.drop_table("relay_events")
    op.drop_table("relay_statistics")


def _keys(table: str, *primary: str) -> tuple[sa.Constraint, ...]:
    return (
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=f"fk_{table}_motor_motors"),
        sa.PrimaryKeyConstraint(*primary, name=f"pk_{table}"),
    )
