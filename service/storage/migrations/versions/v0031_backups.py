"""Back-ups are remembered, with the time when each was verified."""

import sqlalchemy as sa
from alembic import op

revision = "0031"
down_revision = "0030"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "backups",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("directory", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=True),
        sa.Column("due_ns", sa.BigInteger(), nullable=True),
        sa.Column("began_ns", sa.BigInteger(), nullable=False),
        sa.Column("ended_ns", sa.BigInteger(), nullable=True),
        sa.Column("recordings", sa.BigInteger(), nullable=True),
        sa.Column("files", sa.BigInteger(), nullable=True),
        sa.Column("size_bytes", sa.BigInteger(), nullable=True),
        sa.Column("problem", sa.String(), nullable=True),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_backups")),
    )
    op.create_index("ux_backups_due_ns", "backups", ["due_ns"], unique=True)
    op.create_index("ix_backups_began_ns_id", "backups", ["began_ns", "id"])
    op.create_index("ix_backups_state_ended_ns", "backups", ["state", "ended_ns"])


def downgrade() -> None:
    op.drop_table("backups")
