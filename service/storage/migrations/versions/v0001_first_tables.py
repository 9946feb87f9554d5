"""The first tables, with what keeps the audit trail as it is, and the rows that are there from the start.

Until the first release they are those of the models, and the revision is made of them: a database with other
tables is one of another version.
"""

from collections.abc import Iterator
from hashlib import sha256

from alembic import op
from sqlalchemy import Index, insert
from sqlalchemy.dialects import postgresql
from sqlalchemy.schema import CreateIndex, CreateTable

from service.storage.models import (
    AuditForwardingRow,
    AuditHeadRow,
    Base,
    JobRow,
    RecordingRequestRow,
    RecordingRow,
    StateCountRow,
)
from service.storage.partitions import DEFAULT, TABLE
from service.storage.states import JobState, RecordingRequestState, RecordingState

REFUSE_ON_SQLITE = """
CREATE TRIGGER audit_entries_{event} BEFORE {event} ON audit_entries {condition}
BEGIN SELECT RAISE(ABORT, 'an entry of the audit trail is never changed or deleted'); END
"""
# INSERT OR REPLACE deletes the row that is there without asking the trigger for deletions.
REPLACES = "WHEN EXISTS (SELECT 1 FROM audit_entries WHERE number = NEW.number)"
HEAD_ON_SQLITE = """
CREATE TRIGGER audit_head_{event} BEFORE {event} ON audit_head {condition}
BEGIN SELECT RAISE(ABORT, 'the head of the audit trail only goes on'); END
"""
ON_SQLITE = (
    REFUSE_ON_SQLITE.format(event="update", condition=""),
    REFUSE_ON_SQLITE.format(event="delete", condition=""),
    REFUSE_ON_SQLITE.format(event="insert", condition=REPLACES),
    HEAD_ON_SQLITE.format(event="update", condition="WHEN NEW.number <= OLD.number OR NEW.id <> OLD.id"),
    HEAD_ON_SQLITE.format(event="delete", condition=""),
    HEAD_ON_SQLITE.format(event="insert", condition="WHEN EXISTS (SELECT 1 FROM audit_head)"),
)

ON_POSTGRESQL = (
    f"CREATE TABLE {DEFAULT} PARTITION OF {TABLE} DEFAULT",
    """
    CREATE FUNCTION audit_entries_stay() RETURNS trigger LANGUAGE plpgsql AS
    $$ BEGIN RAISE EXCEPTION 'an entry of the audit trail is never changed or deleted'; END $$
    """,
    """
    CREATE FUNCTION audit_head_goes_on() RETURNS trigger LANGUAGE plpgsql AS
    $$ BEGIN
        IF TG_OP = 'UPDATE' AND NEW.number > OLD.number THEN RETURN NEW; END IF;
        RAISE EXCEPTION 'the head of the audit trail only goes on';
    END $$
    """,
    "CREATE TRIGGER audit_entries_stay BEFORE UPDATE OR DELETE OR TRUNCATE ON audit_entries "
    "FOR EACH STATEMENT EXECUTE FUNCTION audit_entries_stay()",
    "CREATE TRIGGER audit_head_goes_on BEFORE UPDATE OR DELETE ON audit_head "
    "FOR EACH ROW EXECUTE FUNCTION audit_head_goes_on()",
    "CREATE TRIGGER audit_head_stays BEFORE TRUNCATE ON audit_head "
    "FOR EACH STATEMENT EXECUTE FUNCTION audit_head_goes_on()",
)

STATES = {RecordingRow: RecordingState, RecordingRequestRow: RecordingRequestState, JobRow: JobState}

ROWS = {
    StateCountRow: [
        {"counted_table": table.__tablename__, "state": state.value, "number": 0}
        for table, states in STATES.items()
        for state in states
    ],
    AuditHeadRow: [{"id": 1, "number": 0, "hash": "0" * 64}],
    AuditForwardingRow: [{"id": 1, "number": 0}],
}


def _is_partial(index: Index) -> bool:
    return index.dialect_options["sqlite"]["where"] is not None


def _tables() -> Iterator[CreateTable | CreateIndex]:
    """Yield all tables, each with its indexes: of two that serve, SQLite takes the last, the partial one."""
    for table in Base.metadata.sorted_tables:
        yield CreateTable(table)
        yield from map(CreateIndex, sorted(table.indexes, key=lambda one: (_is_partial(one), str(one.name))))


def _statements() -> Iterator[str]:
    """Yield all that is made, as text: for PostgreSQL, where it says the most."""
    dialect = postgresql.dialect()  # type: ignore[no-untyped-call]  # SQLAlchemy has no types here
    yield from (str(one.compile(dialect=dialect)) for one in _tables())
    yield from (*ON_SQLITE, *ON_POSTGRESQL)
    yield repr(list(ROWS.values()))


revision = "0001_" + sha256("\n".join(_statements()).encode()).hexdigest()[:12]
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    connection = op.get_bind()
    for element in _tables():
        connection.execute(element)
    for statement in ON_SQLITE if connection.dialect.name == "sqlite" else ON_POSTGRESQL:
        connection.exec_driver_sql(statement)
    for table, rows in ROWS.items():
        connection.execute(insert(table), rows)
