"""Sessions that keep the number of rows in each state, in the transaction that changes them.

Counting whole tables whenever the metrics are asked for would take longer every year. PostgreSQL also tells
those who wait for it that jobs were queued, once the transaction is kept.
"""

from collections import Counter

from sqlalchemy import bindparam, event, func, select, update
from sqlalchemy.orm import Session, UOWTransaction
from sqlalchemy.orm.attributes import get_history

from service.storage.models import Base, JobRow, RecordingRequestRow, RecordingRow, StateCountRow
from service.storage.states import JobState

COUNTED = (RecordingRow, RecordingRequestRow, JobRow)
_CHANGES = "changes of state counts"
_HELD = "rows that were read"
_COUNTS = Base.metadata.tables[StateCountRow.__tablename__]
_COUNT = (
    update(_COUNTS)
    .where(_COUNTS.c.counted_table == bindparam("of_table"), _COUNTS.c.state == bindparam("of_state"))
    .values(number=_COUNTS.c.number + bindparam("change"))
)

JOBS_QUEUED = "statorwatch_jobs_queued"
"""The channel of PostgreSQL on which it is told that jobs were queued."""


class CountingSession(Session):
    """Keeps the state counts in step with the rows that are added, changed and deleted through it.

    It sees what goes through objects; no statement may change the state of a counted table's rows directly.
    It holds what it has read: a row that several functions ask for is read once.
    """


@event.listens_for(CountingSession, "loaded_as_persistent")
def _hold(session: Session, row: object) -> None:
    session.info.setdefault(_HELD, []).append(row)


@event.listens_for(CountingSession, "after_flush")
def _note_changes(session: Session, _context: UOWTransaction) -> None:
    changes: Counter[tuple[str, str]] = session.info.setdefault(_CHANGES, Counter())
    for row in session.new:
        if isinstance(row, COUNTED):
            changes[row.__tablename__, row.state] += 1
    for row in session.dirty:
        if isinstance(row, COUNTED):
            for earlier in get_history(row, "state").deleted:
                changes[row.__tablename__, earlier] -= 1
                changes[row.__tablename__, row.state] += 1
    for row in session.deleted:
        if isinstance(row, COUNTED):
            changes[row.__tablename__, row.state] -= 1


@event.listens_for(CountingSession, "before_commit")
def _write_changes(session: Session) -> None:
    """Write the changed counts last in a transaction and in one order.

    So writers wait for each other briefly, and in no circle.
    """
    session.flush()
    changes: Counter[tuple[str, str]] = session.info.pop(_CHANGES, Counter())
    counts = [
        {"of_table": table, "of_state": state, "change": change}
        for (table, state), change in sorted(changes.items())
        if change
    ]
    if counts:
        session.connection().execute(_COUNT, counts)
    if changes[JobRow.__tablename__, JobState.QUEUED] > 0 and session.get_bind().dialect.name == "postgresql":
        session.execute(select(func.pg_notify(JOBS_QUEUED, "")))
