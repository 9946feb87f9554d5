"""Recordings tell what the motor does in them; results that say nothing of a winding are told from bad ones.

What older diagnoses say in words is taken over: what was diagnosed runs, and the first reason of a refusal
names a start, a stop or a motor at rest. The others are told when they are diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0030"
down_revision = "0029"
branch_labels = None
depends_on = None

INDEXES = {
    "ix_recordings_operation_announced_ns_id": ("operation", "announced_ns", "id"),
    "ix_recordings_motor_operation_announced_ns_id": ("motor", "operation", "announced_ns", "id"),
}

TREND = "ix_diagnoses_trend"
FIGURES = (
    *("recorded_ns", "id", "recording_id", "verdict", "mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "theta_f"),
    *("load_level", "mu_f_scatter95_low", "mu_f_scatter95_high", "detection_limit"),
    *("load_level_ci95_low", "load_level_ci95_high"),
)

REASON = {
    "sqlite": "json_extract(document, '$.reasons[0]')",
    "postgresql": "(document->'reasons'->>0)",
}
OPERATIONS = """
    UPDATE recordings SET operation = (
        SELECT CASE
            WHEN verdict <> 'undiagnosable' THEN 'running'
            WHEN {reason} LIKE 'start: %' OR {reason} LIKE 'running: a start%' THEN 'start'
            WHEN {reason} LIKE 'stop: %' THEN 'stop'
            WHEN {reason} LIKE 'running: %' THEN 'not-running'
        END
        FROM diagnoses
        WHERE diagnoses.recording_id = recordings.id AND diagnoses.current
    )
"""
SAYS_NOTHING = """
    UPDATE diagnoses SET says_nothing = {true}
    WHERE verdict = 'undiagnosable' AND recording_id IN (
        SELECT id FROM recordings WHERE operation IN ('start', 'stop', 'not-running')
    )
"""
UNUSABLE = """
    UPDATE recordings SET operation_remark = 'diagnose this recording again to see whether it can be used'
    WHERE operation = 'start' AND EXISTS (
        SELECT 1 FROM diagnoses
        WHERE diagnoses.recording_id = recordings.id AND diagnoses.current
            AND {reason} NOT LIKE 'start: the motor starts, its current comes%'
    )
"""
TRUE = {"sqlite": "1", "postgresql": "TRUE"}


def upgrade() -> None:
    op.add_column("recordings", sa.Column("operation", sa.String(16), nullable=True))
    op.add_column("recordings", sa.Column("operation_remark", sa.String(), nullable=True))
    op.add_column(
        "diagnoses", sa.Column("says_nothing", sa.Boolean(), nullable=False, server_default=sa.false())
    )
    op.add_column("conditions", sa.Column("stood_ns", sa.BigInteger(), nullable=True))
    for statement in statements(op.get_bind().dialect.name):
        op.execute(statement)
    for name, columns in INDEXES.items():
        op.create_index(name, "recordings", [*columns])
    op.drop_index(TREND, table_name="diagnoses")
    op.create_index(TREND, "diagnoses", ["motor", "current", "says_nothing", *FIGURES])
    op.execute(sa.text("INSERT INTO state_counts VALUES ('recording_requests', 'skipped', 0)"))


def downgrade() -> None:
    op.execute(sa.text("DELETE FROM recording_requests WHERE state = 'skipped'"))
    op.execute(sa.text("DELETE FROM state_counts WHERE state = 'skipped'"))
    op.drop_index(TREND, table_name="diagnoses")
    op.create_index(TREND, "diagnoses", ["motor", "current", *FIGURES])
    for name in INDEXES:
        op.drop_index(name, table_name="recordings")
    op.drop_column("conditions", "stood_ns")
    op.drop_column("diagnoses", "says_nothing")
    for name in ("operation_remark", "operation"):
        op.drop_column("recordings", name)


def statements(database: str) -> list[sa.TextClause]:
    """Return what takes over what older diagnoses say in words."""
    return [
        sa.text(_escaped(statement.format(reason=REASON[database], true=TRUE[database])))
        for statement in (OPERATIONS, SAYS_NOTHING, UNUSABLE)
    ]


def _escaped(statement: str) -> str:
    """Return the statement without bound parameters: a single colon would begin one."""
    return statement.replace(":", r"\:")
