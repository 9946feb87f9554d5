"""Measured values in partitions on PostgreSQL; what is there becomes one of them.

No row is written again, so that an upgrade takes as long as to read the table once. On SQLite nothing
changes.
"""

import time

import sqlalchemy as sa
from alembic import op

revision = "0051"
down_revision = "0050"
branch_labels = None
depends_on = None

DAY_NS = 86_400 * 10**9

KEYS = (
    "ALTER TABLE {table} ADD CONSTRAINT pk_{table} PRIMARY KEY (motor, step_s, time_ns)",
    "ALTER TABLE {table} ADD CONSTRAINT fk_{table}_motor_motors FOREIGN KEY (motor) REFERENCES motors (name)",
    "CREATE INDEX ix_{table}_step_s_time_ns ON {table} (step_s, time_ns)",
)


def upgrade() -> None:
    if op.get_bind().dialect.name != "postgresql":
        return
    is_empty = op.get_bind().scalar(sa.text("SELECT 1 FROM measurements LIMIT 1")) is None
    op.execute("ALTER TABLE measurements RENAME TO measurements_before")
    for name in ("pk_measurements", "ix_measurements_step_s_time_ns"):
        after = name.replace("measurements", "measurements_before")
        op.execute(f"ALTER INDEX {name} RENAME TO {after}")
    like = "(LIKE measurements_before INCLUDING DEFAULTS)"
    op.execute(f"CREATE TABLE measurements {like} PARTITION BY RANGE (time_ns)")
    for statement in KEYS:
        op.execute(statement.format(table="measurements"))
    op.execute(f"CREATE TABLE measurements_since {like} PARTITION BY RANGE (step_s, time_ns)")
    op.execute(f"CREATE TABLE measurements_default {like}")
    op.execute("ALTER TABLE measurements_since ATTACH PARTITION measurements_default DEFAULT")
    if is_empty:
        op.execute("DROP TABLE measurements_before")
        begin = "MINVALUE"
    else:
        begin = str(_divided())
    op.execute(
        "ALTER TABLE measurements ATTACH PARTITION measurements_since"
        f" FOR VALUES FROM ({begin}) TO (MAXVALUE)"
    )


def _divided() -> int:
    """Make the table of before a partition, up to tomorrow; return where that ends [ns].

    Rows of a clock that was ahead are moved. The others are read once, to see that they belong there.
    """
    end_ns = (time.time_ns() // DAY_NS + 2) * DAY_NS
    steps = (
        "WITH RECURSIVE steps (step_s) AS (SELECT min(step_s) FROM measurements_before UNION ALL"
        " SELECT (SELECT min(b.step_s) FROM measurements_before b WHERE b.step_s > steps.step_s)"
        " FROM steps WHERE steps.step_s IS NOT NULL) SELECT step_s FROM steps WHERE step_s IS NOT NULL"
    )
    op.execute(
        "WITH moved AS (DELETE FROM measurements_before"  # noqa: S608 - own numbers
        f" WHERE step_s IN ({steps}) AND time_ns >= {end_ns} RETURNING *)"
        " INSERT INTO measurements_default SELECT * FROM moved"
    )
    op.execute(
        "ALTER TABLE measurements ATTACH PARTITION measurements_before"
        f" FOR VALUES FROM (MINVALUE) TO ({end_ns})"
    )
    return end_ns


def downgrade() -> None:
    if op.get_bind().dialect.name != "postgresql":
        return
    op.execute("CREATE TABLE measurements_after (LIKE measurements INCLUDING DEFAULTS)")
    op.execute("INSERT INTO measurements_after SELECT * FROM measurements")
    op.execute("DROP TABLE measurements")
    op.execute("ALTER TABLE measurements_after RENAME TO measurements")
    for statement in KEYS:
        op.execute(statement.format(table="measurements"))
