"""Parameters of motors followed over their records.

Records that were folded before tell nothing of them until their motor is judged again, by itself.
"""

import sqlalchemy as sa
from alembic import op

revision = "0043"
down_revision = "0042"
branch_labels = None
depends_on = None

PARAMETERS = ("stator_resistance", "rotor_resistance", "magnetising_inductance", "leakage_inductance")
COLUMNS = [f"{parameter}_{what}" for parameter in PARAMETERS for what in ("change", "margin")]


def upgrade() -> None:
    for column in COLUMNS:
        op.add_column("observations", sa.Column(column, sa.Double(), nullable=True))
    op.add_column("conditions", sa.Column("parameters", sa.JSON(), nullable=True))
    op.add_column("condition_checkpoints", sa.Column("tracking", sa.JSON(), nullable=True))


def downgrade() -> None:
    op.drop_column("condition_checkpoints", "tracking")
    op.drop_column("conditions", "parameters")
    for column in reversed(COLUMNS):
        op.drop_column("observations", column)
