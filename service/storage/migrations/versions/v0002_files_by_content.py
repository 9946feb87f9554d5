"""Find recordings by the content of their files."""

from alembic import op

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_index(op.f("ix_recording_files_sha256"), "recording_files", ["sha256"], unique=False)


def downgrade() -> None:
    op.drop_index(op.f("ix_recording_files_sha256"), "recording_files")
