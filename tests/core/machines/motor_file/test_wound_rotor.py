"""What MOTOR.toml says of a wound rotor: read, refused where it cannot be, and written again."""

import tomllib
from pathlib import Path

import pytest

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import MachineKind, Motor, WoundRotor
from testing.machines.wound_rotors import HOIST, HOIST_WITH_UNKNOWN_RESISTANCE

PLATE = """
[nameplate]
rated_power_W = 37e3
rated_voltage_V = 400
rated_frequency_Hz = 50
pole_pairs = 2
connection = "star"
"""
ROTOR = 'kind = "wound-rotor"\nrotor_voltage_V = 240\nrotor_current_A = 98\n'


def _motor(text: str) -> Motor:
    return motor_from_table(tomllib.loads(PLATE + text), name="H1", source="H1.toml")


def test_a_motor_has_a_cage_unless_its_file_says_otherwise() -> None:
    assert _motor("").kind is MachineKind.CAGE
    assert _motor('kind = "cage"').wound_rotor is None


def test_the_plate_of_a_wound_rotor_is_read() -> None:
    motor = _motor(ROTOR + "rated_speed_rpm = 1464\n[rotor_circuit]\nexternal_resistance_ohm = [0, 0.35]")
    assert motor.kind is MachineKind.WOUND_ROTOR
    assert motor.wound_rotor == WoundRotor(240.0, 98.0, (0.0, 0.35))
    assert motor.nameplate.rated_speed_rpm == 1464.0


def test_one_resistance_is_a_known_one() -> None:
    rotor = _motor(ROTOR + "[rotor_circuit]\nexternal_resistance_ohm = 0.2").wound_rotor
    assert rotor is not None
    assert rotor.external_resistance_ohm == (0.2, 0.2)


def test_without_parameters_the_plate_tells_the_resistance_of_the_rotor() -> None:
    """3 R_2 I_2^2 is lost of P / (1 - s): s = 0.024, and the turns are as 400 V to 240 V."""
    machine = _motor(ROTOR + "rated_speed_rpm = 1464").parameters
    lost_W = 0.024 / 0.976 * 37e3
    assert 3 * 98.0**2 * machine.rotor_resistance_ohm == pytest.approx(lost_W * (400 / 240) ** 2, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "field", "words"),
    [
        ('kind = "synchronous"', "[nameplate] kind", '"cage" or "wound-rotor"'),
        ("rotor_voltage_V = 240", "[nameplate] rotor_voltage_V", 'kind = "wound-rotor"'),
        ("[rotor_circuit]\nexternal_resistance_ohm = 1", "[rotor_circuit] external_resistance_ohm", "kind"),
        ('kind = "wound-rotor"\nrotor_current_A = 98', "[nameplate] rotor_voltage_V", "above zero"),
        (ROTOR.replace("98", "980"), "[nameplate] rotor_current_A", "times rated_power_W"),
        (ROTOR + "rated_speed_rpm = 1500", "[nameplate] rated_speed_rpm", "rpm"),
        (ROTOR + "[rotor_circuit]\nexternal_resistance_ohm = [0.3, 0.1]", "[rotor_circuit] ", "[least, "),
        (
            ROTOR + "[rotor_circuit]\nexternal_resistance_ohm = [0, 1" + "0" * 399 + "]",
            "[rotor_circuit]",
            "ohm",
        ),
        (ROTOR + "[rotor_circuit]\nexternal_resistance_ohm = 350", "[rotor_circuit] ", "ohm a phase"),
    ],
)
def test_what_no_wound_rotor_has_is_refused(text: str, field: str, words: str) -> None:
    with pytest.raises(MotorFileError) as refused:
        _motor(text)
    assert refused.value.field.startswith(field)
    assert words in refused.value.expected


@pytest.mark.parametrize("motor", [HOIST, HOIST_WITH_UNKNOWN_RESISTANCE])
def test_it_is_written_and_read_again(tmp_path: Path, motor: Motor) -> None:
    write_motor(tmp_path / "hoist.toml", motor)
    assert read_motor(tmp_path / "hoist.toml") == motor
