"""The rotor's condition from each record on, and joined recordings that stand for their parts.

The conditions of records that are there already are judged here, by the rules as they were in this version.
"""

from collections import defaultdict, deque
from collections.abc import Iterator
from itertools import groupby
from statistics import median
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0046"
down_revision = "0045"
branch_labels = None
depends_on = None

COUNTS = sa.text("condition IS NOT NULL")
INDEXES = {
    "ix_rotor_course_time_ns": ["motor", "time_ns", "recording_id"],
    "ix_rotor_course_load_bin": ["motor", "load_bin", "time_ns", "recording_id"],
    "ix_rotor_course_condition": ["motor", "condition", "time_ns", "recording_id"],
}
RECORDINGS = sa.table(
    "recordings", sa.column("id"), sa.column("source"), sa.column("parts", sa.JSON()), sa.column("joined_id")
)
FINDINGS = sa.table(
    "rotor_findings",
    *map(sa.column, ("recording_id", "motor", "time_ns", "state", "severity_dB", "load_bin", "condition")),
)
LEAST_DB, RISE_DB = -50.0, 4.0


def upgrade() -> None:
    op.add_column("recordings", sa.Column("joined_id", sa.String(36), nullable=True))
    op.add_column("rotor_findings", sa.Column("condition", sa.String(16), nullable=True))
    joined_by = _note_joined()
    _judge(joined_by)
    for name, columns in INDEXES.items():
        op.create_index(name, "rotor_findings", columns, sqlite_where=COUNTS, postgresql_where=COUNTS)


def downgrade() -> None:
    for name in INDEXES:
        op.drop_index(name, "rotor_findings")
    op.drop_column("rotor_findings", "condition")
    op.drop_column("recordings", "joined_id")


def _note_joined() -> dict[str, str]:
    """Note with each recording what it was joined to; return that."""
    query = sa.select(RECORDINGS.c.id, RECORDINGS.c.parts).where(RECORDINGS.c.source == "joined")
    joined_by = {part: joined for joined, parts in op.get_bind().execute(query) for part in parts or ()}
    for part, joined in joined_by.items():
        op.execute(sa.update(RECORDINGS).where(RECORDINGS.c.id == part).values(joined_id=joined))
    return joined_by


def _judge(joined_by: dict[str, str]) -> None:
    c = FINDINGS.c
    query = (
        sa.select(c.motor, c.recording_id, c.state, c.severity_dB, c.load_bin)
        .where(c.state != "unsupported")
        .order_by(c.motor, c.time_ns, c.recording_id)
    )
    rows = op.get_bind().execute(query).all()
    telling = {row.recording_id for row in rows}
    counting = [row for row in rows if joined_by.get(row.recording_id) not in telling]
    statement = (
        sa.update(FINDINGS)
        .where(c.recording_id == sa.bindparam("of_recording"))
        .values(condition=sa.bindparam("judged"))
    )
    for _, of_motor in groupby(counting, key=lambda row: row.motor):
        judged = [
            {"of_recording": recording_id, "judged": state} for recording_id, state in _course(of_motor)
        ]
        op.get_bind().execute(statement, judged)


def _course(rows: Iterator[Any]) -> Iterator[tuple[str, str]]:
    """Yield each record and the state from it on."""
    first: defaultdict[int, list[float]] = defaultdict(list)
    faults: deque[bool] = deque(maxlen=3)
    notable: deque[bool] = deque(maxlen=3)
    for row in rows:
        level, baseline = max(row.severity_dB, LEAST_DB), first[row.load_bin]
        has_risen = len(baseline) == 3 and level - median(baseline) >= RISE_DB
        if len(baseline) < 3:
            baseline.append(level)
        faults.append(row.state == "fault")
        notable.append(row.state != "healthy" or has_risen)
        if sum(faults) >= 2:
            yield row.recording_id, "fault"
        else:
            yield row.recording_id, "watch" if sum(notable) >= 2 or any(faults) else "healthy"
