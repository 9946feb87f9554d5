from alembic import op

from service.storage.models import RecordFiguresRow

revision = "0059"
down_revision = "0058"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.drop_table("supply_figures")
    op.drop_table("swing_findings")
    RecordFiguresRow.__table__.create(op.get_bind())  # type: ignore[attr-defined]


def downgrade() -> None:
    raise NotImplementedError
