"""The ranges hold every motor from 100 W to 20 MW, with room to spare."""

import pytest

from core.commissioning.prior import prior_of
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from core.machines.plausibility import plausible_parameters, plausible_power
from testing.machines.motors import ALL

RATINGS = [(100.0, 230.0), (370.0, 690.0), (1e4, 400.0), (3e5, 690.0), (2e6, 6e3), (20e6, 13.8e3)]
"""Rated power [W] and voltage [V]."""


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("frequency_Hz", [16.7, 50.0, 60.0])
@pytest.mark.parametrize("pole_pairs", [1, 2, 12])
@pytest.mark.parametrize(("power_W", "voltage_V"), RATINGS)
def test_what_is_expected_of_a_rating_is_well_inside(
    power_W: float, voltage_V: float, pole_pairs: int, frequency_Hz: float, connection: Connection
) -> None:
    nameplate = Nameplate(power_W, voltage_V, frequency_Hz, pole_pairs, connection)
    assert plausible_power(voltage_V).least < power_W < plausible_power(voltage_V).most
    typical = prior_of(nameplate, None).expected
    for one in plausible_parameters(nameplate):
        room = 3.0
        assert one.least * room < getattr(typical, one.field) < one.most / room


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_known_motors_are_well_inside(motor: Motor) -> None:
    for one in plausible_parameters(motor.nameplate):
        assert one.least * 5 < getattr(motor.parameters, one.field) < one.most / 5


def test_every_parameter_has_its_range() -> None:
    fields = [one.field for one in plausible_parameters(ALL[0].nameplate)]
    assert sorted(fields) == sorted(MachineParameters.__dataclass_fields__)
