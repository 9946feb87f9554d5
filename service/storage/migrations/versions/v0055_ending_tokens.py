"""Tokens end with what made them; roles that watch each other are apart.

The tokens of before end: nothing in their rows tells who asked for them, and with what. A user who had both
SECADM and SECAUD keeps SECADM, for without one nobody manages users.
"""

import sqlalchemy as sa
from alembic import op

revision = "0055"
down_revision = "0054"
branch_labels = None
depends_on = None

BOTH_ROLES = "roles LIKE '%SECADM%' AND roles LIKE '%SECAUD%'"


def upgrade() -> None:
    op.drop_table("api_tokens")
    _create_tokens(
        sa.Column("parent", sa.String(36), nullable=True),
        sa.ForeignKeyConstraint(
            ["parent"],
            ["api_tokens.id"],
            name=op.f("fk_api_tokens_parent_api_tokens"),
            ondelete="CASCADE",
        ),
    )
    op.create_index("ix_api_tokens_parent", "api_tokens", ["parent"])
    op.execute(f"UPDATE users SET roles = replace(roles, ' SECAUD', '') WHERE {BOTH_ROLES}")  # noqa: S608
    # A constraint that comes with a column: SQLite would else have to copy the table that others refer to.
    op.execute(
        "ALTER TABLE users ADD COLUMN password_set_by VARCHAR "
        f"CONSTRAINT ck_users_separate_roles CHECK (NOT ({BOTH_ROLES}))"
    )
    op.add_column("users", sa.Column("confirmed_ns", sa.BigInteger(), nullable=True))


def downgrade() -> None:
    op.drop_table("api_tokens")
    _create_tokens()
    op.drop_column("users", "confirmed_ns")
    if op.get_bind().dialect.name == "postgresql":
        op.execute("ALTER TABLE users DROP CONSTRAINT ck_users_separate_roles")
    op.execute("ALTER TABLE users DROP COLUMN password_set_by")


def _create_tokens(*added: sa.schema.SchemaItem) -> None:
    op.create_table(
        "api_tokens",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("user", sa.String(100), nullable=False),
        sa.Column("label", sa.String(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("scope", sa.String(), nullable=True),
        *added,
        sa.Column("created_ns", sa.BigInteger(), nullable=False),
        sa.Column("expires_ns", sa.BigInteger(), nullable=True),
        sa.Column("used_ns", sa.BigInteger(), nullable=True),
        sa.ForeignKeyConstraint(["user"], ["users.name"], name=op.f("fk_api_tokens_user_users")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_api_tokens")),
        sa.UniqueConstraint("digest", name=op.f("uq_api_tokens_digest")),
    )
    op.create_index("ix_api_tokens_user", "api_tokens", ["user"])
