"""A second factor of users: the secret of an authenticator app, sealed, and codes that count once."""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0057"
down_revision = "0056"
branch_labels = None
depends_on = None

NEW: dict[str, sa.types.TypeEngine[Any]] = {
    "totp": sa.String(),
    "totp_pending": sa.String(),
    "totp_step": sa.BigInteger(),
    "second_factor_ns": sa.BigInteger(),
}


def upgrade() -> None:
    for name, kind in NEW.items():
        op.add_column("users", sa.Column(name, kind, nullable=True))
    op.add_column(
        "user_sessions", sa.Column("second_factor", sa.Boolean(), nullable=False, server_default=sa.false())
    )
    op.create_table(
        "recovery_codes",
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("user", sa.String(100), nullable=False),
        sa.ForeignKeyConstraint(["user"], ["users.name"], name=op.f("fk_recovery_codes_user_users")),
        sa.PrimaryKeyConstraint("digest", name=op.f("pk_recovery_codes")),
    )
    op.create_index("ix_recovery_codes_user", "recovery_codes", ["user"])


def downgrade() -> None:
    op.drop_table("recovery_codes")
    op.drop_column("user_sessions", "second_factor")
    for name in NEW:
        op.drop_column("users", name)
