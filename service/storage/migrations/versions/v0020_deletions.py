"""Deleted recordings are remembered, with what their relays list, and folders that are to be removed."""

import sqlalchemy as sa
from alembic import op

revision = "0020"
down_revision = "0019"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "deletions",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("ied", sa.String(), nullable=True),
        sa.Column("source", sa.String(16), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("digest", sa.String(64), nullable=True),
        sa.Column("waveform", sa.String(64), nullable=True),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("verdict", sa.String(16), nullable=True),
        sa.Column("announced_ns", sa.BigInteger(), nullable=False),
        sa.Column("recorded_ns", sa.BigInteger(), nullable=True),
        sa.Column("deleted_ns", sa.BigInteger(), nullable=False),
        sa.Column("deleted_by", sa.String(16), nullable=False),
        sa.Column("reason", sa.String(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_deletions_ied_ieds")),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_deletions_motor_motors")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_deletions")),
    )
    op.create_index("ix_deletions_deleted_ns_id", "deletions", ["deleted_ns", "id"])
    op.create_index("ix_deletions_motor_deleted_ns_id", "deletions", ["motor", "deleted_ns", "id"])
    op.create_index("ix_deletions_ied_name", "deletions", ["ied", "name"])
    op.create_table(
        "deleted_remote_records",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("modified_ns", sa.BigInteger(), nullable=False),
        sa.Column("deletion_id", sa.String(36), nullable=False),
        sa.ForeignKeyConstraint(
            ["deletion_id"], ["deletions.id"], name=op.f("fk_deleted_remote_records_deletion_id_deletions")
        ),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_deleted_remote_records_ied_ieds")),
        sa.PrimaryKeyConstraint(
            "ied", "name", "size_bytes", "modified_ns", name=op.f("pk_deleted_remote_records")
        ),
    )
    op.create_index(op.f("ix_deleted_remote_records_deletion_id"), "deleted_remote_records", ["deletion_id"])
    op.create_table(
        "discarded_folders",
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("discarded_ns", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("digest", name=op.f("pk_discarded_folders")),
    )


def downgrade() -> None:
    for table in ("discarded_folders", "deleted_remote_records", "deletions"):
        op.drop_table(table)
