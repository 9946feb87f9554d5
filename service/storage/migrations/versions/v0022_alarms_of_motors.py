"""An alarm may be about a motor's condition: it then has the motor, and what is advised."""

import sqlalchemy as sa
from alembic import op

revision = "0022"
down_revision = "0021"
branch_labels = None
depends_on = None

NEW = ("motor", "advice")
COLUMNS = ["motor", "raised_ns", "id"]
INDEXES = {
    "ix_alarms_motor_raised_ns_id": None,
    "ix_alarms_standing_motor_raised_ns_id": sa.text("cleared_ns IS NULL"),
    "ix_alarms_cleared_motor_raised_ns_id": sa.text("cleared_ns IS NOT NULL"),
}


def upgrade() -> None:
    for name in NEW:
        op.add_column("alarms", sa.Column(name, sa.String(), nullable=True))
    for name, condition in INDEXES.items():
        op.create_index(name, "alarms", COLUMNS, sqlite_where=condition, postgresql_where=condition)


def downgrade() -> None:
    op.execute(sa.text("DELETE FROM standing_alarm_counts WHERE kind LIKE 'condition-%'"))
    op.execute(sa.text("DELETE FROM alarms WHERE motor IS NOT NULL"))
    for name in INDEXES:
        op.drop_index(name, table_name="alarms")
    for name in NEW:
        op.drop_column("alarms", name)
