"""The table [thermal]: the settings of the relay's thermal element."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, read_motor
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import ThermalElement
from testing.machines.motors import REFERENCE

NAMEPLATE = {
    "rated_power_W": 800,
    "rated_voltage_V": 380,
    "rated_frequency_Hz": 50,
    "pole_pairs": 2,
    "connection": "star",
}
SETTINGS = {"service_factor": 1.15, "locked_rotor_current": 6.0, "locked_rotor_hot_s": 12.0}


def element(**settings: Any) -> ThermalElement | None:
    tables: dict[str, object] = {"nameplate": NAMEPLATE}
    return motor_from_table(tables | {"thermal": settings}, name="M", source="M.toml").thermal


def test_a_file_without_the_table_tells_no_element() -> None:
    assert motor_from_table({"nameplate": NAMEPLATE}, name="M", source="M.toml").thermal is None


def test_what_is_left_out_is_as_in_the_relay() -> None:
    assert element(**SETTINGS) == ThermalElement(1.15, 6.0, 12.0)
    assert element(**SETTINGS, acceleration_factor=0.8, running_time_constant_s=2400) == ThermalElement(
        1.15, 6.0, 12.0, 0.8, 2400.0
    )


def test_it_is_written_and_read_again(tmp_path: Path) -> None:
    given = ThermalElement(1.15, 6.0, 12.0, full_load_current_A=2.1)
    path = write_motor(tmp_path / "M.toml", replace(REFERENCE, thermal=given))
    assert read_motor(path).thermal == given


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"service_factor": 2.0}, "service_factor"),
        ({"locked_rotor_current": 60.0}, "2.5 to 12 times the full-load current"),
        ({"locked_rotor_hot_s": None}, "locked_rotor_hot_s"),
        ({"running_time_constant_s": 3.0}, "running_time_constant_s"),
        ({"full_load_current_A": 2100.0}, "full_load_current_A"),
        ({"service_facto": 1.15}, "service_facto"),
    ],
)
def test_what_no_relay_has_is_refused(changes: dict[str, Any], said: str) -> None:
    settings = {key: value for key, value in (SETTINGS | changes).items() if value is not None}
    with pytest.raises(MotorFileError, match=said):
        element(**settings)
