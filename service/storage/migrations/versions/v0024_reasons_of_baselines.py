"""When and by whom a baseline was chosen, why, and what spoke against its recordings."""

import sqlalchemy as sa
from alembic import op

revision = "0024"
down_revision = "0023"
branch_labels = None
depends_on = None


def upgrade() -> None:
    baselines = op.create_table(
        "baselines",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("chosen_ns", sa.BigInteger(), nullable=False),
        sa.Column("reason", sa.String(), nullable=True),
        sa.Column("by", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_baselines_motor_motors")),
        sa.PrimaryKeyConstraint("motor", name=op.f("pk_baselines")),
    )
    motor, chosen_ns = sa.column("motor", sa.String()), sa.column("chosen_ns", sa.BigInteger())
    chosen = sa.select(motor, sa.func.max(chosen_ns)).select_from(sa.table("baseline_recordings"))
    op.execute(baselines.insert().from_select(["motor", "chosen_ns"], chosen.group_by(motor)))
    op.add_column("baseline_recordings", sa.Column("doubt", sa.String(), nullable=True))


def downgrade() -> None:
    op.drop_column("baseline_recordings", "doubt")
    op.drop_table("baselines")
