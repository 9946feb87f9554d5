"""Figures in another unit are refused, and the error names the unit that was probably given."""

import math
import tomllib
from collections.abc import Mapping

import pytest

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table

MOTOR = """
[nameplate]
rated_power_W = 500000
rated_voltage_V = 11000
rated_frequency_Hz = 50
pole_pairs = 2

[parameters]
stator_resistance_ohm = 1.9
rotor_resistance_ohm = 1.6
stator_leakage_H = 0.058
rotor_leakage_H = 0.058
stator_self_inductance_H = 1.6
inertia_kgm2 = 12
"""


def motor_with(changes: Mapping[str, Mapping[str, float]], *, nameplate_alone: bool = False) -> str | None:
    """What the refusal of a changed motor takes for meant."""
    table = tomllib.loads(MOTOR)
    assert motor_from_table(table, name="M", source="m.toml")
    for name, values in changes.items():
        table[name].update(values)
    if nameplate_alone:
        del table["parameters"]
    with pytest.raises(MotorFileError) as refusal:
        motor_from_table(table, name="M", source="m.toml")
    assert refusal.value.nearest is None or refusal.value.nearest in str(refusal.value)
    return refusal.value.nearest


@pytest.mark.parametrize(
    ("changes", "meant"),
    [
        ({"nameplate": {"rated_voltage_V": 11}}, "rated_voltage_V = 11000, for kV were given in place of V"),
        ({"nameplate": {"rated_power_W": 500}}, "rated_power_W = 500000, for kW were given in place of W"),
        (
            {"nameplate": {"rated_power_W": 500, "rated_voltage_V": 11}},
            "rated_voltage_V = 11000, rated_power_W = 500000, for kV and kW were given",
        ),
        ({"nameplate": {"rated_power_W": 0.5}}, "rated_power_W = 500000, for MW were given in place of W"),
        (
            {"parameters": {"stator_leakage_H": 58, "rotor_leakage_H": 58, "stator_self_inductance_H": 1600}},
            "stator_leakage_H = 0.18462, rotor_leakage_H = 0.18462, stator_self_inductance_H = 3.39531, "
            "for X1, X2' and Xm in ohm were given in place of H; or "
            "stator_leakage_H = 0.058, rotor_leakage_H = 0.058, stator_self_inductance_H = 1.6, "
            "for mH were given in place of H",
        ),
        (
            {
                "parameters": {
                    key: 2 * math.pi * 50 * henry
                    for key, henry in (
                        ("stator_leakage_H", 0.058),
                        ("rotor_leakage_H", 0.058),
                        ("stator_self_inductance_H", 1.5 * 1.6),
                    )
                }
            },
            "stator_leakage_H = 0.058, rotor_leakage_H = 0.058, stator_self_inductance_H = 1.6, "
            "for X1, X2' and Xm in ohm were given in place of H; or "
            "stator_leakage_H = 0.0182212, rotor_leakage_H = 0.0182212, "
            "stator_self_inductance_H = 0.753982, for mH were given in place of H",
        ),
        (
            {"parameters": {"stator_leakage_H": 2 * math.pi * 50 * 0.058}},
            "stator_leakage_H = 0.058, for X1 in ohm was given in place of H; or "
            "stator_leakage_H = 0.0182212, for mH were given in place of H",
        ),
        (
            {"parameters": dict.fromkeys(("stator_leakage_H", "rotor_leakage_H"), 2 * math.pi * 50 * 0.058)},
            "stator_leakage_H = 0.058, rotor_leakage_H = 0.058, for X1 and X2' in ohm were given in place of "
            "H; or stator_leakage_H = 0.0182212, rotor_leakage_H = 0.0182212, "
            "for mH were given in place of H",
        ),
        (
            {"parameters": {"stator_self_inductance_H": 1.5 * 2 * math.pi * 50 * 1.6}},
            "stator_self_inductance_H = 1.6, for Xm in ohm was given in place of H; or "
            "stator_self_inductance_H = 0.753982, for mH were given in place of H",
        ),
        (
            {"parameters": {"stator_resistance_ohm": 1900}},
            "stator_resistance_ohm = 1.9, for mohm were given in place of ohm",
        ),
        ({"parameters": {"stator_resistance_ohm": 1e9}}, None),
        ({"nameplate": {"rated_voltage_V": 11, "pole_pairs": 0}}, None),
    ],
)
def test_one_unit_for_another(changes: Mapping[str, Mapping[str, float]], meant: str | None) -> None:
    assert motor_with(changes) == meant


@pytest.mark.parametrize(("voltage_kV", "power_W"), [(11, 75e3), (11, 500e3), (3.3, 400e3), (0.4, 4e3)])
def test_kilovolts_of_a_nameplate_alone(voltage_kV: float, power_W: float) -> None:
    changes = {"nameplate": {"rated_voltage_V": voltage_kV, "rated_power_W": power_W}}
    meant = f"rated_voltage_V = {voltage_kV * 1000:g}, for kV were given in place of V"
    assert motor_with(changes, nameplate_alone=True) == meant


def test_every_error_of_a_motor_is_told() -> None:
    table = tomllib.loads(MOTOR)
    table["parameters"]["rotor_leackage_H"] = table["parameters"].pop("rotor_leakage_H")
    table["nameplate"] |= {"rated_frequency_Hz": "50", "poles": 4}
    table["limit"] = {}
    with pytest.raises(MotorFileError) as refusal:
        motor_from_table(table, name="M", source="m.toml")
    errors = [refusal.value, *refusal.value.others]
    assert [(error.field, error.nearest) for error in errors] == [
        ("limit", "limits"),
        ("[nameplate] rated_frequency_Hz", None),
        ("[nameplate] poles", "pole_pairs"),
        ("[parameters] rotor_leackage_H", "rotor_leakage_H"),
    ]
