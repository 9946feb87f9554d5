"""The audit trail: entries that are chained by their hashes, and triggers that keep them as they are."""

import sqlalchemy as sa
from alembic import op

revision = "0032"
down_revision = "0031"
branch_labels = None
depends_on = None

NO_HASH = "0" * 64

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
ON_SQLITE = [
    REFUSE_ON_SQLITE.format(event="update", condition=""),
    REFUSE_ON_SQLITE.format(event="delete", condition=""),
    REFUSE_ON_SQLITE.format(event="insert", condition=REPLACES),
    HEAD_ON_SQLITE.format(event="update", condition="WHEN NEW.number <= OLD.number OR NEW.id <> OLD.id"),
    HEAD_ON_SQLITE.format(event="delete", condition=""),
    HEAD_ON_SQLITE.format(event="insert", condition="WHEN EXISTS (SELECT 1 FROM audit_head)"),
]

ON_POSTGRESQL = [
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
]


def upgrade() -> None:
    op.create_table(
        "audit_entries",
        sa.Column("number", sa.BigInteger(), autoincrement=False, nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
        sa.Column("actor", sa.String(), nullable=False),
        sa.Column("origin", sa.String(), nullable=False),
        sa.Column("roles", sa.String(), nullable=False),
        sa.Column("action", sa.String(64), nullable=False),
        sa.Column("subject_kind", sa.String(64), nullable=False),
        sa.Column("subject", sa.String(), nullable=False),
        sa.Column("before", sa.Text(), nullable=True),
        sa.Column("after", sa.Text(), nullable=True),
        sa.Column("previous", sa.String(64), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_audit_entries"),
    )
    for column in ("actor", "action", "subject"):
        op.create_index(f"ix_audit_entries_{column}_number", "audit_entries", [column, "number"])
    head = op.create_table(
        "audit_head",
        sa.Column("id", sa.BigInteger(), autoincrement=False, nullable=False),
        sa.Column("number", sa.BigInteger(), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_audit_head"),
        sa.CheckConstraint("id = 1", name="only_row"),
    )
    op.bulk_insert(head, [{"id": 1, "number": 0, "hash": NO_HASH}])
    for statement in ON_SQLITE if op.get_bind().dialect.name == "sqlite" else ON_POSTGRESQL:
        op.execute(sa.text(statement))


def downgrade() -> None:
    for table in ("audit_entries", "audit_head"):
        op.drop_table(table)
    if op.get_bind().dialect.name == "postgresql":
        for function in ("audit_entries_stay", "audit_head_goes_on"):
            op.execute(sa.text(f"DROP FUNCTION {function}()"))
