"""Windings that are typical of a rating: proposals that such a motor can have, and never its own winding."""

import pytest
from hypothesis import given

from core.machines.motor_file.reader import motor_from_table
from core.machines.parameters import Motor, Nameplate
from core.machines.stator_winding import StatorWinding, check_winding
from core.machines.typical_winding import typical_winding
from testing.machines.plausible_motors import plausible_motors


@pytest.mark.parametrize(
    ("power_W", "voltage_V", "pole_pairs", "words"),
    [
        (4e3, 400, 2, "concentric or lap, one layer, 24 or 36 slots"),
        (15e3, 400, 2, "concentric or lap, one layer or two layers, 24, 36, 48, 60 or 72 slots"),
        (160e3, 400, 2, "lap, two layers, 36, 48, 60 or 72 slots"),
        (90e3, 690, 1, "lap, two layers, 36 or 48 slots"),
        (450e3, 3300, 3, "lap, two layers, 54 or 72 slots"),
        (9e3, 3300, 4, "lap, two layers, 72 or 96 slots"),
        (200e3, 400, 7, "lap, two layers, slots not known"),
    ],
)
def test_what_is_typical_of_a_rating(power_W: float, voltage_V: float, pole_pairs: int, words: str) -> None:
    assert str(typical_winding(Nameplate(power_W, voltage_V, 50.0, pole_pairs))) == words


@given(motor=plausible_motors())
def test_a_motor_of_the_rating_can_have_it(motor: Motor) -> None:
    typical = typical_winding(motor.nameplate)
    assert typical.kinds
    assert typical.layers
    for slots in typical.slots:
        for layers in typical.layers:
            check_winding(StatorWinding(typical.kinds[0], slots, layers), motor.nameplate.pole_pairs)


def test_it_is_never_taken_for_the_motors_own() -> None:
    plate = {"rated_power_W": 4000, "rated_voltage_V": 400, "rated_frequency_Hz": 50, "pole_pairs": 2}
    assert motor_from_table({"nameplate": plate}, name="M1", source="M1.toml").winding is None
