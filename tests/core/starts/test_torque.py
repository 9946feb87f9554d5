"""Torque, slip and load of a start, against the simulator's own shaft."""

import numpy as np
import pytest

from core.commissioning.start_detection import start_of
from core.machines.air_gap import UNSETTLED_CYCLES
from core.machines.parameters import Motor
from core.recordings import Recording
from core.starts.examined import StartTorque
from core.starts.measuring import measure_start
from core.starts.torque import start_torque
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.motors import ALL, LARGE, REFERENCE
from testing.machines.starts import TRUE_RATE_HZ, StartRecord, with_parameters

RECORD_RATE_HZ = 10_000.0


def torque_of(record: Recording, motor: Motor) -> StartTorque:
    start = start_of(record, motor.nameplate, motor.channels)
    return start_torque(start.air_gap(motor.parameters), motor, measure_start(record, motor).acceleration_s)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("load", [0.1, 0.9])
def test_the_load_of_the_run_up_is_that_of_the_shaft(motor: Motor, load: float) -> None:
    found = torque_of(StartRecord(load_level=load, duration_s=1.5, snr_db=40.0).of(motor), motor)

    rated_Nm = motor.nameplate.rated_torque_Nm
    assert found.load_torque_Nm is not None
    assert found.load_torque_Nm_ci95 is not None
    assert found.load_torque_Nm_ci95[0] <= load * rated_Nm <= found.load_torque_Nm_ci95[1]
    assert found.load_torque_Nm == pytest.approx(load * rated_Nm, abs=0.1 * rated_Nm)
    assert found.running_torque_Nm == pytest.approx(load * rated_Nm, abs=0.02 * rated_Nm)


@pytest.mark.parametrize("sequence", ["abc", "acb"])
def test_the_speed_is_that_of_the_shaft(sequence: str) -> None:
    motor = with_parameters(LARGE, inertia_kgm2=4.0 * LARGE.parameters.inertia_kgm2)
    record = StartRecord(load_level=0.5, duration_s=1.5, snr_db=40.0, sequence=sequence).of(motor)  # type: ignore[arg-type]

    found = torque_of(record, motor)

    supply = Supply(motor.nameplate.rated_voltage_V, 50.0)
    plant = MotorPlant(motor, supply, Load(0.5), Sensors(1.0, 1.0))
    true = plant.start_up(0.0, 1.5, TRUE_RATE_HZ).speed_rad_s / (2.0 * np.pi * 50.0 / 2.0)
    assert found.speed[:UNSETTLED_CYCLES] == (None,) * UNSETTLED_CYCLES
    for number, speed in enumerate(found.speed[UNSETTLED_CYCLES:], UNSETTLED_CYCLES):
        at = round((found.first_s + number * found.step_s) * TRUE_RATE_HZ)
        if at < true.size and speed is not None:
            assert speed == pytest.approx(float(true[at]), abs=0.04)


def test_torque_at_rated_voltage_does_not_follow_the_supply() -> None:
    full, weak = (
        torque_of(StartRecord(load_level=0.2, voltage=share).of(REFERENCE), REFERENCE) for share in (1.0, 0.9)
    )

    assert weak.mean_torque_Nm < 0.9 * full.mean_torque_Nm
    assert weak.torque_at_rated_voltage_Nm == pytest.approx(full.torque_at_rated_voltage_Nm, rel=0.05)


def test_a_record_that_ends_within_the_start_tells_torque_and_no_load() -> None:
    found = torque_of(StartRecord(duration_s=0.15).of(LARGE), LARGE)

    assert found.mean_torque_Nm > 0.0
    assert found.load_torque_Nm is None
    assert found.momentum_Nms is None
    assert found.running_torque_Nm is None
