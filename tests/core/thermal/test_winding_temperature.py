"""Temperatures of windings against those that the simulator's windings have, through recordings."""

from dataclasses import replace
from math import pi

import pytest

from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass
from core.thermal.winding_temperature import stator_resistance_ohm, winding_temperature
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from ied_sim.motor.warming import Warming
from testing.machines.disturbed_records import record_of
from testing.machines.motors import ALL, MEDIUM, REFERENCE

RATE_HZ = 8_000.0
GOOD = SensorClass(1e-3, 1e-3, 2e-6, 2e-6)


def observed(
    motor: Motor, load: float, hotter_K: float, *, gain: float = 0.0, noise: float = 0.0
) -> Observation:
    """A record of a motor whose windings are so much hotter. gain: error of all current channels."""
    plate = motor.nameplate
    plant = MotorPlant(
        motor,
        Supply(plate.rated_voltage_V, plate.rated_frequency_Hz),
        Load(load),
        Sensors(
            10.0 * rated_current(motor),
            2.0 * plate.rated_voltage_V,
            gain_errors=(gain,) * 3 + (0.0,) * 3,
            noise=noise,
        ),
        warming=Warming(rise_K=0.0, ambient_K=hotter_K),
    )
    found = observe(record_of(plant.window(10.0, 1.1, RATE_HZ), RATE_HZ), motor)
    assert found is not None
    return found


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("slip", [0.005, 0.02, 0.06])
def test_the_resistance_is_that_of_the_circuit(motor: Motor, slip: float) -> None:
    """The circuit is written out here with its resistances; the estimator knows its inductances alone."""
    machine, w = motor.parameters, 2.0 * pi * 50.0
    rotor = machine.rotor_resistance_ohm / slip + 1j * w * machine.rotor_leakage_H
    magnetising = 1j * w * machine.magnetising_inductance_H
    whole = 1.3 * machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H
    whole += rotor * magnetising / (rotor + magnetising)

    assert stator_resistance_ohm(whole, 50.0, machine) == pytest.approx(1.3 * machine.stator_resistance_ohm)


def test_an_impedance_of_no_motor_has_no_resistance() -> None:
    assert stator_resistance_ohm(1.0 + 1e-6j, 50.0, REFERENCE.parameters) is None
    assert stator_resistance_ohm(1.0 + 1e6j, 50.0, REFERENCE.parameters) is None


@pytest.mark.parametrize("hotter_K", [-20.0, 40.0, 80.0])
@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_the_rise_is_that_of_the_simulated_winding(motor: Motor, hotter_K: float) -> None:
    motor = replace(motor, sensors=GOOD)
    # The simulator's copper is that of 20 degrees: 1/0.00393 K there, as 234.5 + 20.
    found = winding_temperature(
        observed(motor, 0.8, hotter_K), observed(motor, 0.8, 0.0), motor, reference_C=20.0
    )

    assert found.rise_K is not None
    assert found.rise_K_ci95 is not None
    low, high = found.rise_K_ci95
    assert low <= hotter_K <= high
    assert found.rise_K == pytest.approx(hotter_K, abs=3.0)


def test_standing_errors_of_sensors_and_parameters_cancel_at_a_like_load() -> None:
    motor = replace(MEDIUM, sensors=GOOD)
    wrong = replace(
        motor,
        parameters=replace(
            motor.parameters,
            stator_self_inductance_H=1.05 * motor.parameters.stator_self_inductance_H,
            stator_leakage_H=0.95 * motor.parameters.stator_leakage_H,
        ),
    )
    hot, ref = (observed(motor, 0.8, kelvin, gain=0.001, noise=1e-3) for kelvin in (50.0, 0.0))
    found = winding_temperature(hot, ref, wrong, reference_C=20.0)

    assert found.rise_K_ci95 is not None
    low, high = found.rise_K_ci95
    assert low <= 50.0 <= high


def test_another_load_and_poor_sensors_are_told_apart_from_a_temperature() -> None:
    motor = replace(REFERENCE, sensors=SensorClass(0.03, 0.03, 100e-6, 100e-6))
    found = winding_temperature(observed(motor, 0.9, 30.0), observed(motor, 0.1, 0.0), motor)

    assert found.rise_K is None
    assert "like load" in found.reasons[0]


def test_records_of_other_sensors_are_not_compared() -> None:
    record = observed(REFERENCE, 0.5, 0.0)

    found = winding_temperature(record, replace(record, recorder="another"), REFERENCE)

    assert found.rise_K is None
    assert "sensors" in found.reasons[0]
