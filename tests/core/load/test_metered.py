"""The load from a relay's metering, against the load that the motor's own equations were given."""

from dataclasses import replace
from math import sqrt

import pytest

from core.load.metered import Metered, load_point
from core.machines.parameters import Motor
from core.operation import Operation
from core.supply.measuring import measure_supply
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.disturbed_records import record_of
from testing.machines.motors import ALL, REFERENCE

AT = 1_000
RATE_HZ = 10_000.0


def metered(motor: Motor, load: float) -> Metered:
    """What is measured of the simulated motor once it runs."""
    plate = motor.nameplate
    supply = Supply(plate.rated_voltage_V, plate.rated_frequency_Hz)
    plant = MotorPlant(
        motor, supply, Load(load), Sensors(10.0 * rated_current(motor), 2.0 * plate.rated_voltage_V)
    )
    found = measure_supply(record_of(plant.window(0.0, 0.4, RATE_HZ), RATE_HZ), motor)
    return Metered(AT, found.line_currents_A, found.line_voltages_V, found.active_power_W, found.frequency_hz)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("load", [0.25, 1.0])
def test_the_load_is_the_torque_of_the_shaft(motor: Motor, load: float) -> None:
    point = load_point(metered(motor, load), motor)

    assert point.operation is Operation.RUNNING
    # Friction and the rotor's own losses are part of what crosses the air gap.
    assert point.load_level == pytest.approx(load, abs=0.03)


def test_a_power_of_the_wrong_sign_counts_as_drawn() -> None:
    values = metered(REFERENCE, 0.5)
    assert values.active_power_W is not None

    assert load_point(replace(values, active_power_W=-values.active_power_W), REFERENCE) == load_point(
        values, REFERENCE
    )


def test_without_current_it_stands_and_without_a_word_nothing_is_known() -> None:
    amps = 1e-3 * REFERENCE.nameplate.rated_power_W / REFERENCE.nameplate.rated_voltage_V / sqrt(3.0)
    standing = Metered(AT, (amps, amps, amps), None, None, None)

    assert load_point(standing, REFERENCE).operation is Operation.NOT_RUNNING
    assert load_point(replace(standing, currents_A=None), REFERENCE).operation is None
    assert load_point(replace(standing, currents_A=(5.0, 5.0, 5.0)), REFERENCE).load_level is None
