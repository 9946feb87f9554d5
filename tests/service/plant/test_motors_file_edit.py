"""Estimated parameters enter the motors file, and every other line of it stays as it is."""

import tomllib
from pathlib import Path

import pytest

from service.plant import PlantError
from service.plant.motors_file_edit import EstimatedParameters, with_parameters

FOUND = EstimatedParameters(
    values={"stator_resistance_ohm": 0.123456789, "rotor_leakage_H": 3.0e-5},
    intervals={"stator_resistance_ohm": (0.1, 0.2)},
    remarks={"rotor_leakage_H": "fixed: as the stator's"},
    origin="by mcc commission",
)
ENTERED = """[motor.parameters]
source = "commissioned" # by mcc commission
stator_resistance_ohm = 0.1234568
rotor_leakage_H = 3e-05 # fixed: as the stator's

[motor.intervals]
stator_resistance_ohm = [0.1, 0.2]
"""
BETWEEN = """# top
[[motor]]   # first
name = "A"
[motor.nameplate] # plate
rated_power_W = 1e3 # one

# a relay between the motors
[[relay]]
name = "R" # r

[[motor]]
name = "B"
description = '''
[[motor]]
is only text'''

[motor.nameplate]
rated_power_W = 2_000
"""
BEHIND = """
# the bus
[[bus]]
name = "X"
"""


def edited(tmp_path: Path, text: str, motor: str = "B") -> str:
    path = tmp_path / "motors.toml"
    path.write_bytes(text.encode())
    edit = with_parameters(path, motor, FOUND)
    edit.write()
    assert edit.backup.read_bytes().decode() == text
    after = path.read_bytes().decode()
    (table,) = [table for table in tomllib.loads(after)["motor"] if table["name"] == motor]
    assert table["parameters"]["source"] == "commissioned"
    assert table["parameters"]["stator_resistance_ohm"] == 0.1234568
    assert table["intervals"] == {"stator_resistance_ohm": [0.1, 0.2]}
    return after


def test_a_motor_without_parameters_gets_them_behind_its_own_lines(tmp_path: Path) -> None:
    assert edited(tmp_path, BETWEEN + BEHIND) == f"{BETWEEN}\n{ENTERED}{BEHIND}"
    assert edited(tmp_path, BETWEEN) == f"{BETWEEN}\n{ENTERED}"
    assert edited(tmp_path, BETWEEN.removesuffix("\n")) == f"{BETWEEN}\n{ENTERED}"


def test_line_ends_stay(tmp_path: Path) -> None:
    text = f"{BETWEEN}{BEHIND}".replace("\n", "\r\n")
    assert edited(tmp_path, text) == f"{BETWEEN}\n{ENTERED}{BEHIND}".replace("\n", "\r\n")


def test_values_that_were_there_are_replaced_in_their_lines(tmp_path: Path) -> None:
    given = """[motor.parameters]
# measured cold
stator_resistance_ohm = 1.0   # by hand
rotor_leakage_H = 0.001
source = "data-sheet"
[motor.intervals]
rotor_leakage_H = [0.1, 0.2]
stator_resistance_ohm = [0.5, 2.0] # both ends
[motor.limits]
fault_level = 0.01
"""
    written = """[motor.parameters]
# measured cold
stator_resistance_ohm = 0.1234568   # by hand
rotor_leakage_H = 3e-05 # fixed: as the stator's
source = "commissioned" # by mcc commission
[motor.intervals]
stator_resistance_ohm = [0.1, 0.2] # both ends
[motor.limits]
fault_level = 0.01
"""
    assert edited(tmp_path, f"{BETWEEN}{given}{BEHIND}") == f"{BETWEEN}{written}{BEHIND}"


@pytest.mark.parametrize(
    "text",
    [
        'motor = [{name = "A"}, {name = "B", nameplate = {rated_power_W = 3}}]\n',
        '[[motor]]\nname = "B"\nnameplate.rated_power_W = 3\nparameters.stator_resistance_ohm = 1\n',
        '[[ motor ]]\n"name" = "B"\nparameters = {stator_resistance_ohm = 1}\n[[motor]]\nname = "C"\n',
    ],
    ids=["an array of tables", "dotted keys", "tables in a line"],
)
def test_other_ways_to_write_a_table_are_taken(tmp_path: Path, text: str) -> None:
    assert "commissioned" in edited(tmp_path, text)


@pytest.mark.parametrize("text", ["motor = 3\n", '[[motor]]\nname = "A"\n', "", "[[motor]]\nname =\n"])
def test_a_file_without_the_motor_is_left_as_it_is(tmp_path: Path, text: str) -> None:
    path = tmp_path / "motors.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(PlantError):
        with_parameters(path, "B", FOUND)
    assert [each.name for each in tmp_path.iterdir()] == ["motors.toml"]


def test_a_file_that_somebody_changed_meanwhile_is_not_written_over(tmp_path: Path) -> None:
    path = tmp_path / "motors.toml"
    path.write_text(BETWEEN, "utf-8")
    edit = with_parameters(path, "B", FOUND)
    path.write_text(f"{BETWEEN}# another thought\n", "utf-8")
    with pytest.raises(PlantError, match="found one that was changed since"):
        edit.write()
    assert path.read_text("utf-8") == f"{BETWEEN}# another thought\n"


def test_a_link_stays_one_and_so_do_the_rights(tmp_path: Path) -> None:
    file, link = tmp_path / "real.toml", tmp_path / "motors.toml"
    file.write_text(BETWEEN, "utf-8")
    file.chmod(0o640)
    link.symlink_to(file)
    with_parameters(link, "B", FOUND).write()
    assert link.is_symlink()
    assert "commissioned" in file.read_text("utf-8")
    assert file.stat().st_mode & 0o777 == 0o640


def test_the_change_is_shown_line_by_line(tmp_path: Path) -> None:
    path = tmp_path / "motors.toml"
    path.write_text(BETWEEN, "utf-8")
    diff = with_parameters(path, "B", FOUND).diff().splitlines()
    assert [line[1:] for line in diff[2:] if line.startswith("+")] == ["", *ENTERED.splitlines()]
    assert not [line for line in diff[2:] if line.startswith("-")]
