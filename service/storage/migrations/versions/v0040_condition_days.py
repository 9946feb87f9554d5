"""Days of each motor's condition, so that months of hundreds of motors are shown without their records."""

import sqlalchemy as sa
from alembic import op

revision = "0040"
down_revision = "0039"
branch_labels = None
depends_on = None

DAY_NS = 86_400_000_000_000

FILL = f"""
    INSERT INTO condition_days (motor, day_ns, records, mu_f_least, mu_f_mean, mu_f_largest)
    SELECT motor, time_ns - ((time_ns % {DAY_NS}) + {DAY_NS}) % {DAY_NS} AS of_day,
        count(*), min(mu_f), avg(mu_f), max(mu_f)
    FROM observations WHERE state IS NOT NULL GROUP BY motor, of_day
"""  # noqa: S608 - the number is our own


def upgrade() -> None:
    op.create_table(
        "condition_days",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("day_ns", sa.BigInteger(), nullable=False),
        sa.Column("records", sa.BigInteger(), nullable=False),
        sa.Column("mu_f_least", sa.Double(), nullable=True),
        sa.Column("mu_f_mean", sa.Double(), nullable=True),
        sa.Column("mu_f_largest", sa.Double(), nullable=True),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_condition_days_motor_motors")),
        sa.PrimaryKeyConstraint("motor", "day_ns", name=op.f("pk_condition_days")),
    )
    op.execute(sa.text(FILL))


def downgrade() -> None:
    op.drop_table("condition_days")
