"""Conditions of motors: observations, what follows from them, events, and what is yet to be observed.

Recordings that are diagnosed already are observed from their files, in the background.
"""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0023"
down_revision = "0022"
branch_labels = None
depends_on = None

PHASORS = ("positive_voltage", "negative_voltage", "positive_current", "negative_current", "zero_current")
LEVELS = ("mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "change", "change_ci95_low", "change_ci95_high")


def upgrade() -> None:
    op.add_column("motors", sa.Column("bus", sa.String(), nullable=True))
    op.create_table(
        "observations",
        sa.Column("recording_id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("recorder", sa.String(), nullable=False),
        sa.Column("sequence", sa.String(16), nullable=False),
        sa.Column("voltage_channels", sa.String(16), nullable=False),
        sa.Column("frequency_hz", sa.Double(), nullable=False),
        *(
            sa.Column(f"{name}_{part}", sa.Double(), nullable=False)
            for name in PHASORS
            for part in ("re", "im")
        ),
        sa.Column("zero_voltage_re", sa.Double(), nullable=True),
        sa.Column("zero_voltage_im", sa.Double(), nullable=True),
        sa.Column("scatter", sa.Double(), nullable=False),
        sa.Column("cycles", sa.BigInteger(), nullable=False),
        sa.Column("load_level", sa.Double(), nullable=True),
        sa.Column("state", sa.String(16), nullable=True),
        sa.Column("kind", sa.String(16), nullable=True),
        *_figures(),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_observations_motor_motors")),
        sa.PrimaryKeyConstraint("recording_id", name=op.f("pk_observations")),
    )
    op.create_index(
        "ix_observations_motor_time_ns_recording_id", "observations", ["motor", "time_ns", "recording_id"]
    )
    conditions = op.create_table(
        "conditions",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("version", sa.BigInteger(), nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("since_ns", sa.BigInteger(), nullable=True),
        sa.Column("as_of_ns", sa.BigInteger(), nullable=True),
        sa.Column("document", sa.JSON(), nullable=True),
        sa.Column("standing", sa.JSON(), nullable=True),
        *_figures(),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_conditions_motor_motors")),
        sa.PrimaryKeyConstraint("motor", name=op.f("pk_conditions")),
    )
    op.create_table(
        "condition_changes",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("recording_id", sa.String(36), nullable=True),
        sa.Column("event_id", sa.String(36), nullable=True),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        *_figures(),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_condition_changes_motor_motors")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_condition_changes")),
    )
    op.create_index("ix_condition_changes_motor_time_ns_id", "condition_changes", ["motor", "time_ns", "id"])
    op.create_table(
        "condition_events",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("kind", sa.String(32), nullable=False),
        sa.Column("reason", sa.String(), nullable=False),
        sa.Column("by", sa.String(), nullable=False),
        sa.Column("made_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_condition_events_motor_motors")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_condition_events")),
    )
    op.create_index("ix_condition_events_motor_time_ns_id", "condition_events", ["motor", "time_ns", "id"])
    op.create_table(
        "condition_checkpoints",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("records", sa.BigInteger(), nullable=False),
        sa.Column("state", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(
            ["motor"], ["motors.name"], name=op.f("fk_condition_checkpoints_motor_motors")
        ),
        sa.PrimaryKeyConstraint("motor", "time_ns", name=op.f("pk_condition_checkpoints")),
    )
    op.create_table(
        "fold_marks",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("from_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_fold_marks_motor_motors")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_fold_marks")),
    )
    op.create_index("ix_fold_marks_motor_from_ns", "fold_marks", ["motor", "from_ns"])
    op.create_table(
        "motor_versions",
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("from_ns", sa.BigInteger(), nullable=False),
        sa.Column("document", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_motor_versions_motor_motors")),
        sa.PrimaryKeyConstraint("motor", "from_ns", name=op.f("pk_motor_versions")),
    )
    unobserved = op.create_table(
        "unobserved_recordings",
        sa.Column("recording_id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("recorded_ns", sa.BigInteger(), nullable=False),
        sa.ForeignKeyConstraint(
            ["motor"], ["motors.name"], name=op.f("fk_unobserved_recordings_motor_motors")
        ),
        sa.ForeignKeyConstraint(
            ["recording_id"],
            ["recordings.id"],
            name=op.f("fk_unobserved_recordings_recording_id_recordings"),
        ),
        sa.PrimaryKeyConstraint("recording_id", name=op.f("pk_unobserved_recordings")),
    )
    op.create_index(
        "ix_unobserved_recordings_motor_recorded_ns_recording_id",
        "unobserved_recordings",
        ["motor", "recorded_ns", "recording_id"],
    )
    name = sa.column("name", sa.String())
    unknown = sa.select(name, sa.literal(0), sa.literal("unknown"), sa.literal("none"))
    op.execute(
        conditions.insert().from_select(
            ["motor", "version", "state", "kind"], unknown.select_from(sa.table("motors"))
        )
    )
    columns = ("recording_id", "motor", "recorded_ns")
    diagnosed: sa.Select[*tuple[Any, ...]] = (
        sa.select(*(sa.column(one) for one in columns))
        .select_from(sa.table("diagnoses"))
        .where(
            sa.column("motor").in_(sa.select(name).select_from(sa.table("motors"))),
            sa.column("current", sa.Boolean()),
            sa.column("verdict", sa.String()) != "undiagnosable",
        )
    )
    op.execute(unobserved.insert().from_select(columns, diagnosed))


def downgrade() -> None:
    for table in (
        "unobserved_recordings",
        "motor_versions",
        "fold_marks",
        "condition_checkpoints",
        "condition_events",
        "condition_changes",
        "conditions",
        "observations",
    ):
        op.drop_table(table)
    op.drop_column("motors", "bus")


def _figures() -> list[sa.Column[object]]:
    return [
        sa.Column("phase", sa.String(1), nullable=True),
        *(sa.Column(name, sa.Double(), nullable=True) for name in LEVELS),
    ]
