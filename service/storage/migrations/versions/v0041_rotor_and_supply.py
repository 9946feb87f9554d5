"""What recordings show of the rotor and of the supply.

Recordings that were diagnosed before show neither until they are diagnosed again.
"""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0041"
down_revision = "0040"
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "rotor_findings",
        *_keys(),
        sa.Column("state", sa.String(16), nullable=False),
        *_numbers(
            "lower_sideband_dB",
            "upper_sideband_dB",
            "severity_dB",
            "severity_dB_ci95_low",
            "severity_dB_ci95_high",
            "detection_limit_dB",
            "slip",
            "load_level",
            nullable=True,
        ),
        sa.Column("load_bin", sa.BigInteger(), nullable=True),
        *_numbers("duration_s", nullable=False),
        *_numbers("load_oscillation_dB", nullable=True),
        sa.Column("reasons", sa.JSON(), nullable=False),
        *_constraints("rotor_findings"),
    )
    op.create_table(
        "supply_figures",
        *_keys(),
        *_numbers("frequency_hz", nullable=False),
        sa.Column("line_voltages_V", sa.JSON(), nullable=False),
        *_numbers("voltage_unbalance_iec", "voltage_unbalance_nema", nullable=False),
        *_numbers("derating", nullable=True),
        *_numbers("voltage_deviation", "thd_voltage", "harmonic_voltage_factor", nullable=False),
        sa.Column("voltage_harmonics", sa.JSON(), nullable=False),
        sa.Column("line_currents_A", sa.JSON(), nullable=True),
        *_numbers("current_unbalance", "thd_current", nullable=True),
        sa.Column("current_harmonics", sa.JSON(), nullable=False),
        *_numbers("active_power_W", "power_factor", nullable=True),
        *_numbers("duration_s", nullable=False),
        sa.Column("reasons", sa.JSON(), nullable=False),
        *_constraints("supply_figures"),
    )
    for table in ("rotor_findings", "supply_figures"):
        order = ["motor", "time_ns", "recording_id"]
        op.create_index(f"ix_{table}_motor_time_ns_recording_id", table, order)


def downgrade() -> None:
    op.drop_table("supply_figures")
    op.drop_table("rotor_findings")


def _keys() -> list[sa.Column[Any]]:
    return [
        sa.Column("recording_id", sa.String(36), nullable=False),
        sa.Column("motor", sa.String(), nullable=False),
        sa.Column("time_ns", sa.BigInteger(), nullable=False),
    ]


def _numbers(*names: str, nullable: bool) -> list[sa.Column[Any]]:
    return [sa.Column(name, sa.Double(), nullable=nullable) for name in names]


def _constraints(table: str) -> list[sa.Constraint]:
    return [
        sa.ForeignKeyConstraint(["motor"], ["motors.name"], name=op.f(f"fk_{table}_motor_motors")),
        sa.PrimaryKeyConstraint("recording_id", name=op.f(f"pk_{table}")),
    ]
