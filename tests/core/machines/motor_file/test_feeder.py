"""What a motor's file says of its feeder, written and read again, and what it refuses."""

from dataclasses import replace
from pathlib import Path

import pytest

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import Cable, Capacitors, Connection, CurrentPosition, Motor
from testing.machines.motors import LARGE, MEDIUM


def file_of(folder: Path, motor: Motor, before: str = "", behind: str = "") -> Path:
    """A motor's file with lines before and behind its tables."""
    path = write_motor(folder / "m.toml", motor)
    path.write_text(f"{before}\n{path.read_text('utf-8')}\n{behind}\n", encoding="utf-8")
    return path


def test_the_feeder_is_written_and_read_again(tmp_path: Path) -> None:
    motor = replace(
        MEDIUM,
        capacitors=Capacitors(2.5, Connection.STAR),
        cable=Cable(0.12, 0.05),
        neutral=True,
    )
    path = write_motor(tmp_path / "m.toml", motor)
    assert read_motor(path) == replace(motor, name="m")


def test_a_bank_is_in_delta_unless_the_file_says_otherwise(tmp_path: Path) -> None:
    motor = read_motor(
        file_of(tmp_path, MEDIUM, behind="[capacitors]\nkvar = 3\n[cable]\nresistance_ohm = 0.1")
    )
    assert motor.capacitors == Capacitors(3.0, Connection.DELTA)
    assert motor.cable == Cable(0.1, 0.0)


def test_ct_position_is_the_current_position_of_the_transformers(tmp_path: Path) -> None:
    motor = read_motor(file_of(tmp_path, LARGE, before='ct_position = "inside-delta"'))
    assert motor.transformers.current_position is CurrentPosition.INSIDE_DELTA
    assert (
        read_motor(file_of(tmp_path, MEDIUM, before='ct_position = "line"')).transformers
        == MEDIUM.transformers
    )


@pytest.mark.parametrize(
    ("motor", "before", "behind", "message"),
    [
        (MEDIUM, 'ct_position = "inside-delta"', "", "ct_position.*for a motor in star.*inside-delta"),
        (LARGE, 'ct_position = "inside"', "", 'ct_position: expected "line" or "inside-delta"'),
        (
            LARGE,
            'ct_position = "line"',
            '[transformers]\ncurrent_position = "inside-delta"',
            r'ct_position: expected "inside-delta", as \[transformers\]',
        ),
        (LARGE, "neutral = true", "", "neutral: expected false for a motor in delta"),
        (MEDIUM, 'neutral = "yes"', "", "neutral: expected true or false"),
        (MEDIUM, "", "[capacitors]\nkvar = 300", "kvar: expected 0.0075 to 15 kvar"),
        (MEDIUM, "", '[capacitors]\nkvar = 3\nconnection = "ring"', 'connection: expected "star" or "delta"'),
        (MEDIUM, "", "[cable]\nresistance_ohm = 50", "resistance_ohm: expected a number.* 0 to 6.4 ohm"),
        (MEDIUM, "neutrall = true", "", "neutrall.*neutral"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(
    tmp_path: Path, motor: Motor, before: str, behind: str, message: str
) -> None:
    with pytest.raises(MotorFileError, match=f"(?s){message}"):
        read_motor(file_of(tmp_path, motor, before, behind))
