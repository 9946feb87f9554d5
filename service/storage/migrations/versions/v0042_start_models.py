"""What the motor's model tells of a start: torque, parameters, the rotor's sideband, heating.

Starts that were measured before show none of it until their recordings are diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0042"
down_revision = "0041"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.add_column("starts", sa.Column("model", sa.JSON(), nullable=True))


def downgrade() -> None:
    op.drop_column("starts", "model")
