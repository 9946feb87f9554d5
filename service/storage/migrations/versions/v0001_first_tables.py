"""First tables."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "sites",
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("description", sa.String(), nullable=False),
        sa.Column("in_service", sa.Boolean(), nullable=False),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_sites")),
    )
    op.create_table(
        "ieds",
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("site", sa.String(), nullable=False),
        sa.Column("host", sa.String(), nullable=False),
        sa.Column("port", sa.BigInteger(), nullable=False),
        sa.Column("manufacturer", sa.String(), nullable=False),
        sa.Column("type", sa.String(), nullable=False),
        sa.Column("in_service", sa.Boolean(), nullable=False),
        sa.Column(
            "link_state",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("link_reason", sa.String(), nullable=True),
        sa.Column("link_changed_ns", sa.BigInteger(), nullable=True),
        sa.Column("last_success_ns", sa.BigInteger(), nullable=True),
        sa.Column("entry_id", sa.LargeBinary(), nullable=True),
        sa.ForeignKeyConstraint(["site"], ["sites.name"], name=op.f("fk_ieds_site_sites")),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_ieds")),
    )
    op.create_table(
        "motors",
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("description", sa.String(), nullable=False),
        sa.Column("site", sa.String(), nullable=False),
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("in_service", sa.Boolean(), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_motors_ied_ieds")),
        sa.ForeignKeyConstraint(["site"], ["sites.name"], name=op.f("fk_motors_site_sites")),
        sa.PrimaryKeyConstraint("name", name=op.f("pk_motors")),
    )
    op.create_index(op.f("ix_motors_ied"), "motors", ["ied"], unique=False)

    op.create_table(
        "recordings",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("ied", sa.String(), nullable=True),
        sa.Column(
            "source",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("digest", sa.String(length=64), nullable=True),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("remote_modified_ns", sa.BigInteger(), nullable=True),
        sa.Column(
            "state",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("reason", sa.String(), nullable=True),
        sa.Column("attempts", sa.BigInteger(), nullable=False),
        sa.Column("announced_ns", sa.BigInteger(), nullable=False),
        sa.Column("fetched_ns", sa.BigInteger(), nullable=True),
        sa.Column("recorded_ns", sa.BigInteger(), nullable=True),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_recordings_ied_ieds")),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_recordings_motor_motors")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_recordings")),
    )
    op.create_index("ix_recordings_announced_ns_id", "recordings", ["announced_ns", "id"], unique=False)
    op.create_index(
        "ix_recordings_motor_announced_ns_id", "recordings", ["motor", "announced_ns", "id"], unique=False
    )
    op.create_index("ux_recordings_relay", "recordings", ["ied", "name", "digest"], unique=True)
    op.create_index(
        "ux_recordings_upload",
        "recordings",
        ["motor", "name", "digest"],
        unique=True,
        sqlite_where=sa.text("ied IS NULL"),
        postgresql_where=sa.text("ied IS NULL"),
    )

    op.create_table(
        "event_reports",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column(
            "state",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("reason", sa.String(), nullable=True),
        sa.Column("idempotency_key", sa.String(), nullable=True),
        sa.Column("recording_id", sa.String(length=36), nullable=True),
        sa.Column("requested_ns", sa.BigInteger(), nullable=False),
        sa.Column("triggered_ns", sa.BigInteger(), nullable=True),
        sa.Column("recorded_ns", sa.BigInteger(), nullable=True),
        sa.Column("fetched_ns", sa.BigInteger(), nullable=True),
        sa.Column("diagnosed_ns", sa.BigInteger(), nullable=True),
        sa.Column("failed_ns", sa.BigInteger(), nullable=True),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_event_reports_ied_ieds")),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_event_reports_motor_motors")),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_event_reports_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_event_reports")),
    )
    op.create_index(
        "ix_event_reports_ied_state_requested_ns",
        "event_reports",
        ["ied", "state", "requested_ns"],
        unique=False,
    )
    op.create_index(op.f("ix_event_reports_recording_id"), "event_reports", ["recording_id"], unique=False)
    op.create_index("ix_event_reports_requested_ns_id", "event_reports", ["requested_ns", "id"], unique=False)
    op.create_index("ux_event_reports_key", "event_reports", ["motor", "idempotency_key"], unique=True)

    op.create_table(
        "jobs",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("recording_id", sa.String(length=36), nullable=False),
        sa.Column("method", sa.String(), nullable=False),
        sa.Column("model", sa.String(), nullable=False),
        sa.Column(
            "state",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("attempts", sa.BigInteger(), nullable=False),
        sa.Column("not_before_ns", sa.BigInteger(), nullable=False),
        sa.Column("created_ns", sa.BigInteger(), nullable=False),
        sa.Column("started_ns", sa.BigInteger(), nullable=True),
        sa.Column("finished_ns", sa.BigInteger(), nullable=True),
        sa.Column("error", sa.String(), nullable=True),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_jobs_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_jobs")),
    )
    op.create_index(
        "ix_jobs_recording_id_created_ns_id", "jobs", ["recording_id", "created_ns", "id"], unique=False
    )
    op.create_index("ix_jobs_state_not_before_ns", "jobs", ["state", "not_before_ns"], unique=False)

    op.create_table(
        "recording_files",
        sa.Column("recording_id", sa.String(length=36), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_recording_files_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("recording_id", "name", name=op.f("pk_recording_files")),
    )
    op.create_table(
        "remote_records",
        sa.Column("ied", sa.String(), nullable=False),
        sa.Column("name", sa.String(), nullable=False),
        sa.Column("size_bytes", sa.BigInteger(), nullable=False),
        sa.Column("modified_ns", sa.BigInteger(), nullable=False),
        sa.Column("recording_id", sa.String(length=36), nullable=False),
        sa.ForeignKeyConstraint(["ied"], ["ieds.name"], name=op.f("fk_remote_records_ied_ieds")),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_remote_records_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("ied", "name", "size_bytes", "modified_ns", name=op.f("pk_remote_records")),
    )
    op.create_index(op.f("ix_remote_records_recording_id"), "remote_records", ["recording_id"], unique=False)

    op.create_table(
        "diagnoses",
        sa.Column("id", sa.String(length=36), nullable=False),
        sa.Column("job_id", sa.String(length=36), nullable=False),
        sa.Column("recording_id", sa.String(length=36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("current", sa.Boolean(), nullable=False),
        sa.Column("created_ns", sa.BigInteger(), nullable=False),
        sa.Column("recorded_ns", sa.BigInteger(), nullable=False),
        sa.Column(
            "verdict",
            sa.String(length=16),
            nullable=False,
        ),
        sa.Column("mu_f", sa.Double(), nullable=True),
        sa.Column("mu_f_ci95_low", sa.Double(), nullable=True),
        sa.Column("mu_f_ci95_high", sa.Double(), nullable=True),
        sa.Column("theta_f", sa.BigInteger(), nullable=True),
        sa.Column("load_level", sa.Double(), nullable=True),
        sa.Column("method", sa.String(), nullable=False),
        sa.Column("model", sa.String(), nullable=False),
        sa.Column("document", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["job_id"], ["jobs.id"], name=op.f("fk_diagnoses_job_id_jobs")),
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f("fk_diagnoses_motor_motors")),
        sa.ForeignKeyConstraint(
            ["recording_id"], ["recordings.id"], name=op.f("fk_diagnoses_recording_id_recordings")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_diagnoses")),
        sa.UniqueConstraint("job_id", name=op.f("uq_diagnoses_job_id")),
    )
    op.create_index(
        "ix_diagnoses_motor_current_recorded_ns_id",
        "diagnoses",
        ["motor", "current", "recorded_ns", "id"],
        unique=False,
    )
    op.create_index(op.f("ix_diagnoses_recording_id"), "diagnoses", ["recording_id"], unique=False)


def downgrade() -> None:
    for table in (
        "diagnoses",
        "remote_records",
        "recording_files",
        "jobs",
        "event_reports",
        "recordings",
        "motors",
        "ieds",
        "sites",
    ):
        op.drop_table(table)
