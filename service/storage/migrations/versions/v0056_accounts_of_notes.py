"""Notes, their withdrawals and baselines have the account that acted, beside the name that somebody wrote.

It is not known of those of before, except of what the service notes of the motors file by itself.
"""

import sqlalchemy as sa
from alembic import op

revision = "0056"
down_revision = "0055"
branch_labels = None
depends_on = None

COLUMNS = (
    ("condition_events", "account"),
    ("condition_events", "withdrawn_account"),
    ("baselines", "account"),
)
OF_THE_FILE = """
    UPDATE condition_events SET account = 'statorwatch'
    WHERE kind = 'parameters-edited' AND "by" = 'motors file'
"""


def upgrade() -> None:
    for table, column in COLUMNS:
        op.add_column(table, sa.Column(column, sa.String(), nullable=True))
    op.execute(OF_THE_FILE)


def downgrade() -> None:
    for table, column in COLUMNS:
        op.drop_column(table, column)
