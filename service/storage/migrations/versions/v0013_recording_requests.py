"""Recording requests have their own name: an event report is a file that a relay writes."""

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"
branch_labels = None
depends_on = None

BEFORE, AFTER = "event_reports", "recording_requests"

INDEXES = {
    "ix_{}_ied_state_requested_ns": (["ied", "state", "requested_ns"], False),
    "ix_{}_recording_id": (["recording_id"], False),
    "ix_{}_requested_ns_id": (["requested_ns", "id"], False),
    "ux_{}_key": (["motor", "idempotency_key"], True),
}

CONSTRAINTS = ("pk_{}", "fk_{}_ied_ieds", "fk_{}_motor_motors", "fk_{}_recording_id_recordings")


def upgrade() -> None:
    _rename(BEFORE, AFTER)


def downgrade() -> None:
    _rename(AFTER, BEFORE)


def _rename(before: str, after: str) -> None:
    """SQLite cannot rename an index, and does not list the names of constraints."""
    for name in INDEXES:
        op.drop_index(name.format(before), table_name=before)
    op.rename_table(before, after)
    for name, (columns, unique) in INDEXES.items():
        op.create_index(name.format(after), after, columns, unique=unique)
    if op.get_bind().dialect.name == "postgresql":
        for name in CONSTRAINTS:
            statement = f"ALTER TABLE {after} RENAME CONSTRAINT {name.format(before)} TO {name.format(after)}"
            op.execute(sa.text(statement))
