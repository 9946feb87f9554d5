"""Messages about alarms: an outbox that is worked off, and what became of each."""

import sqlalchemy as sa
from alembic import op

revision = "0035"
down_revision = "0034"
branch_labels = None
depends_on = None

INDEXES = {
    "ix_notifications_state_channel_not_before_ns_id": ("state", "channel", "not_before_ns", "id"),
    "ix_notifications_bundle_closes_ns": ("bundle", "closes_ns"),
    "ix_notifications_created_ns_id": ("created_ns", "id"),
    "ix_notifications_state_created_ns_id": ("state", "created_ns", "id"),
    "ix_notifications_channel_created_ns_id": ("channel", "created_ns", "id"),
    "ix_notifications_finished_ns": ("finished_ns",),
}


def upgrade() -> None:
    op.create_table(
        "notifications",
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("channel", sa.String(), nullable=False),
        sa.Column("recipient", sa.String(), nullable=False),
        sa.Column("key", sa.String(), nullable=True),
        sa.Column("bundle", sa.String(), nullable=True),
        sa.Column("site", sa.String(), nullable=True),
        sa.Column("priority", sa.String(16), nullable=True),
        sa.Column("is_held", sa.Boolean(), nullable=False),
        sa.Column("document", sa.JSON(), nullable=True),
        sa.Column("created_ns", sa.BigInteger(), nullable=False),
        sa.Column("closes_ns", sa.BigInteger(), nullable=False),
        sa.Column("not_before_ns", sa.BigInteger(), nullable=False),
        sa.Column("attempts", sa.BigInteger(), nullable=False),
        sa.Column("claim", sa.String(), nullable=True),
        sa.Column("tried_ns", sa.BigInteger(), nullable=True),
        sa.Column("finished_ns", sa.BigInteger(), nullable=True),
        sa.Column("error", sa.String(), nullable=True),
        sa.PrimaryKeyConstraint("id", name="pk_notifications"),
        sa.UniqueConstraint("key", name="uq_notifications_key"),
    )
    for name, columns in INDEXES.items():
        op.create_index(name, "notifications", [*columns])
    op.create_table(
        "notification_alarms",
        sa.Column("notification", sa.String(36), nullable=False),
        sa.Column("sequence", sa.BigInteger(), autoincrement=False, nullable=False),
        sa.Column("alarm", sa.String(36), nullable=False),
        sa.Column("event", sa.String(16), nullable=False),
        sa.PrimaryKeyConstraint("notification", "sequence", name="pk_notification_alarms"),
        sa.ForeignKeyConstraint(
            ["notification"],
            ["notifications.id"],
            name="fk_notification_alarms_notification_notifications",
            ondelete="CASCADE",
        ),
    )
    op.create_index(
        "ix_notification_alarms_alarm_notification", "notification_alarms", ["alarm", "notification"]
    )


def downgrade() -> None:
    op.drop_table("notification_alarms")
    op.drop_table("notifications")
