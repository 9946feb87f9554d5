"""Diagnoses keep an interval from all causes beside the record's own scatter, and what could have been seen.

What older rows call the 95 % interval is the scatter alone. It keeps its figures under the new name. The
interval from all causes is not known of them: it is null until the recording is diagnosed again.
"""

import sqlalchemy as sa
from alembic import op

revision = "0019"
down_revision = "0018"
branch_labels = None
depends_on = None

NEW = (
    "mu_f_scatter95_low",
    "mu_f_scatter95_high",
    "detection_limit",
    "load_level_ci95_low",
    "load_level_ci95_high",
)

COLUMNS = """
    UPDATE diagnoses SET
        mu_f_scatter95_low = mu_f_ci95_low, mu_f_scatter95_high = mu_f_ci95_high,
        mu_f_ci95_low = NULL, mu_f_ci95_high = NULL,
"""
UPGRADE = {
    "sqlite": COLUMNS
    + """
        detection_limit = json_extract(document, '$.detection_limit'),
        document = json_set(document,
            '$.mu_f_scatter95', json_extract(document, '$.mu_f_ci95'), '$.mu_f_ci95', NULL,
            '$.load_level_scatter95', json_extract(document, '$.load_level_ci95'), '$.load_level_ci95', NULL)
    """,
    "postgresql": COLUMNS
    + """
        detection_limit = (document->>'detection_limit')::float8,
        document = (document::jsonb || jsonb_build_object(
            'mu_f_scatter95', document->'mu_f_ci95', 'mu_f_ci95', NULL,
            'load_level_scatter95', document->'load_level_ci95', 'load_level_ci95', NULL))::json
    """,
}
DOWNGRADE = {
    "sqlite": """
        UPDATE diagnoses SET
            mu_f_ci95_low = mu_f_scatter95_low, mu_f_ci95_high = mu_f_scatter95_high,
            document = json_remove(json_set(document,
                '$.mu_f_ci95', json_extract(document, '$.mu_f_scatter95'),
                '$.load_level_ci95', json_extract(document, '$.load_level_scatter95')),
                '$.mu_f_scatter95', '$.load_level_scatter95')
    """,
    "postgresql": """
        UPDATE diagnoses SET
            mu_f_ci95_low = mu_f_scatter95_low, mu_f_ci95_high = mu_f_scatter95_high,
            document = ((document::jsonb || jsonb_build_object(
                'mu_f_ci95', document->'mu_f_scatter95',
                'load_level_ci95', document->'load_level_scatter95'))
                - 'mu_f_scatter95' - 'load_level_scatter95')::json
    """,
}


BY_TIME = "ix_diagnoses_motor_current_recorded_ns_id"
TIME = ("motor", "current", "recorded_ns", "id")

TREND = "ix_diagnoses_trend"
FIGURES = ("recording_id", "verdict", "mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "theta_f", "load_level")


def upgrade() -> None:
    op.drop_index(BY_TIME, table_name="diagnoses")
    for name in NEW:
        op.add_column("diagnoses", sa.Column(name, sa.Double(), nullable=True))
    op.execute(sa.text(_escaped(UPGRADE[op.get_bind().dialect.name])))
    op.create_index(TREND, "diagnoses", [*TIME, *FIGURES, *NEW])


def downgrade() -> None:
    op.drop_index(TREND, table_name="diagnoses")
    op.execute(sa.text(_escaped(DOWNGRADE[op.get_bind().dialect.name])))
    for name in NEW:
        op.drop_column("diagnoses", name)
    op.create_index(BY_TIME, "diagnoses", [*TIME])


def _escaped(statement: str) -> str:
    """Return the statement without bound parameters: a single colon would begin one."""
    return statement.replace("::", r"\:\:")
