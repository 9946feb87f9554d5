"""What MOTOR.toml says of starts: read, refused where no motor has it, and written again."""

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import StartLimits
from testing.machines.motors import REFERENCE

PLATE = """
[nameplate]
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2
connection = "star"

[limits]
"""


def limits(text: str) -> StartLimits:
    return motor_from_table(tomllib.loads(PLATE + text), name="P1", source="P1.toml").start_limits


def test_limits_of_starts_are_read() -> None:
    text = "locked_rotor_current_A = 9\nlocked_rotor_hot_s = 10\nstarts_per_hour = 6"
    assert limits(text) == StartLimits(9.0, 10.0, None, 6)
    assert limits("fault_level = 0.01") == StartLimits()


@pytest.mark.parametrize(
    ("text", "field"),
    [
        ("locked_rotor_current_A = 900", "locked_rotor_current_A"),
        ("locked_rotor_hot_s = 0", "locked_rotor_hot_s"),
        ("locked_rotor_cold_s = 12000", "locked_rotor_cold_s"),
        ("starts_per_hour = 2.5", "starts_per_hour"),
    ],
)
def test_what_no_motor_has_is_refused(text: str, field: str) -> None:
    with pytest.raises(MotorFileError) as refused:
        limits(text)

    assert refused.value.field == f"[limits] {field}"


def test_they_are_written_and_read_again(tmp_path: Path) -> None:
    motor = replace(REFERENCE, name="P1", start_limits=StartLimits(9.0, 10.0, None, 6))

    write_motor(tmp_path / "P1.toml", motor)

    assert read_motor(tmp_path / "P1.toml") == motor
