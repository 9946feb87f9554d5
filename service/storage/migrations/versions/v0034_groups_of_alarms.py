"""An alarm may be one of many that one line tells, and knows which kinds of asymmetry people were told.

Faults of motors are critical from now on.
"""

import sqlalchemy as sa
from alembic import op

revision = "0034"
down_revision = "0033"
branch_labels = None
depends_on = None

MEMBER = sa.text("part_of IS NOT NULL")
STANDING = sa.text("cleared_ns IS NULL")
INDEXES = (
    ("ix_alarms_part_of", ["part_of", "raised_ns", "id"], MEMBER),
    ("ix_alarms_standing_site_kind", ["site", "kind"], STANDING),
)
URGENT = """
    UPDATE alarms SET priority = 'critical', urgency = urgency + 1
    WHERE kind = 'condition-fault' AND priority = 'high'
"""


def upgrade() -> None:
    op.add_column("alarms", sa.Column("part_of", sa.String(36), nullable=True))
    op.add_column("alarms", sa.Column("causes", sa.String(), nullable=True))
    for name, columns, condition in INDEXES:
        op.create_index(name, "alarms", columns, sqlite_where=condition, postgresql_where=condition)
    op.execute(sa.text(URGENT))


def downgrade() -> None:
    for name, _, _ in INDEXES:
        op.drop_index(name, table_name="alarms")
    op.drop_column("alarms", "causes")
    op.drop_column("alarms", "part_of")
