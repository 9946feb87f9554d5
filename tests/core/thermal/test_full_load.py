"""The full-load current against the simulated motor's, and the bounds of rises with gaps."""

from math import sqrt

import numpy as np
import pytest

from core.machines.parameters import Motor
from core.thermal.bounded_rises import bounded_rises
from core.thermal.course import CurrentStep
from core.thermal.full_load import full_load_current_A
from core.thermal.two_bodies import TwoBodies
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.motors import ALL

BODIES = TwoBodies()


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_the_full_load_current_is_that_of_the_simulated_motor(motor: Motor) -> None:
    plate = motor.nameplate
    supply = Supply(plate.rated_voltage_V, plate.rated_frequency_Hz)
    plant = MotorPlant(motor, supply, Load(1.0), Sensors(1e4, 1e5))
    currents = plant.operation(0.0, 0.4, 10_000.0).currents_A

    assert full_load_current_A(motor) == pytest.approx(sqrt(float(np.mean(currents**2))), rel=0.01)


def test_known_time_closes_the_bounds_and_a_gap_opens_them() -> None:
    known = [CurrentStep(900.0, 0.8)] * 40
    closed = bounded_rises(known, BODIES)
    opened = bounded_rises([*known, 3600.0], BODIES)

    assert closed.high.winding_K - closed.low.winding_K < 1.0
    assert opened.low.winding_K < closed.low.winding_K < opened.high.winding_K
    assert bounded_rises([], BODIES).high.winding_K == BODIES.rated_rise_K
