"""Windows as the relay samples them: consistent in time, repeatable, with the errors of their sensors."""

from math import pi, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from ied_sim.monitoring.metering import meter
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL, FaultCourse, TurnFault
from ied_sim.motor.load import Load
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.motors import LARGE, REFERENCE
from tests.ied_sim.motor.plants import plant, short

RATE_HZ = 10_000.0
FINE = Sensors(full_scale_A=10.0, full_scale_V=700.0)


def phasor(samples: NDArray[np.float64], frequency_Hz: float, rate_Hz: float = RATE_HZ) -> complex:
    """Peak phasor at a frequency of which the window holds whole cycles."""
    turn = np.exp(-2j * pi * frequency_Hz / rate_Hz * np.arange(samples.size))
    return complex(2 * np.mean(samples * turn))


def test_a_window_has_six_channels_and_the_samples_asked_for() -> None:
    assert plant().window(3.0, 0.1, RATE_HZ).shape == (6, 1000)
    assert plant().window(3.0, 0.1, 1_600).shape == (6, 160)


def test_windows_are_the_same_every_time_and_agree_where_they_overlap() -> None:
    supply = Supply(380, 50, frequency_drift_Hz=0.03, unbalance=0.01)
    motor = plant(supply=supply, load=Load(0.5, 0.1, 5.0), sensors=FINE)
    window = motor.window(7.0, 0.1, RATE_HZ)
    assert np.array_equal(window, motor.window(7.0, 0.1, RATE_HZ))
    later = motor.window(7.05, 0.05, RATE_HZ)
    difference = np.abs(window[:, 500:] - later).max(axis=1)
    assert (difference[:3] < 2e-3).all()
    assert (difference[3:] < 0.05).all()


def test_noise_is_repeatable_and_differs_from_window_to_window_and_motor_to_motor() -> None:
    noisy = Sensors(10.0, 700.0, noise=0.01)
    first = plant(sensors=noisy, seed=1).window(1.0, 0.02, RATE_HZ)
    assert np.array_equal(first, plant(sensors=noisy, seed=1).window(1.0, 0.02, RATE_HZ))
    assert not np.array_equal(first, plant(sensors=noisy, seed=2).window(1.0, 0.02, RATE_HZ))
    noise = first - plant(sensors=FINE).window(1.0, 0.02, RATE_HZ)
    rated = plant().rated_values
    assert noise.std(axis=1) / rated == pytest.approx([0.01] * 6, rel=0.3)


def test_sensors_scale_shift_delay_and_clip() -> None:
    gains = (0.01, 0.0, 0.0, 0.0, -0.02, 0.0)
    offsets = (0.0, 0.0, 0.05, 0.0, 0.0, 0.0)
    ideal = plant(sensors=FINE).window(1.0, 0.1, RATE_HZ)
    seen = plant(sensors=Sensors(10.0, 700.0, gains, offsets, current_delay_s=200e-6)).window(
        1.0, 0.1, RATE_HZ
    )
    assert abs(phasor(seen[0], 50)) == pytest.approx(1.01 * abs(phasor(ideal[0], 50)), rel=1e-4)
    assert abs(phasor(seen[4], 50)) == pytest.approx(0.98 * abs(phasor(ideal[4], 50)), rel=1e-4)
    assert seen[2].mean() == pytest.approx(0.05 * plant().rated_values[2], rel=1e-2)
    lag = np.angle(phasor(ideal[1], 50) / phasor(seen[1], 50))
    assert lag == pytest.approx(2 * pi * 50 * 200e-6, rel=1e-3)
    clipped = plant(sensors=Sensors(1.0, 700.0)).window(1.0, 0.02, RATE_HZ)
    assert np.abs(clipped[:3]).max() == 1.0


def test_samples_are_multiples_of_the_converter_step() -> None:
    window = plant(sensors=FINE).window(1.0, 0.02, RATE_HZ)
    codes = window[:3] / (10.0 / 32767)
    assert np.abs(codes - np.rint(codes)).max() < 1e-6


def test_supply_has_the_unbalance_harmonics_and_frequency_it_claims() -> None:
    supply = Supply(
        400.0,
        50.0,
        unbalance=0.03,
        unbalance_angle_rad=0.5,
        harmonics=(Harmonic(5, 0.015), Harmonic(7, 0.01)),
    )
    times = np.arange(1000) / RATE_HZ
    voltages = supply.phase_voltages(times)
    a = np.exp(2j * pi / 3)
    positive, negative = np.array([[1, a, a**2], [1, a**2, a]]) / 3
    fundamental, fifth, seventh = (np.array([phasor(v, order * 50) for v in voltages]) for order in (1, 5, 7))
    assert abs(positive @ fundamental) == pytest.approx(400 * sqrt(2 / 3))
    ratio = (negative @ fundamental) / (positive @ fundamental)
    assert ratio == pytest.approx(0.03 * np.exp(0.5j))
    assert abs(negative @ fifth) == pytest.approx(0.015 * abs(positive @ fundamental))
    assert abs(positive @ fifth) < 1e-9
    assert abs(positive @ seventh) == pytest.approx(0.01 * abs(positive @ fundamental))
    assert np.abs(voltages.sum(axis=0)).max() < 1e-9 * 400


def test_phase_is_the_integral_of_the_drifting_frequency() -> None:
    supply = Supply(400.0, 50.0, frequency_drift_Hz=0.5, drift_period_s=40.0)
    step = 1e-6
    for time_s in (0.0, 11.3, 100_000.7):
        times = np.array([time_s, time_s + step])
        alpha, beta, gamma = supply.phase_voltages(times)
        angle = np.unwrap(np.arctan2(gamma - beta, -sqrt(3) * alpha))
        assert abs(angle[1] - angle[0]) / (2 * pi * step) == pytest.approx(supply.frequency(time_s), abs=0.01)


def test_acb_is_the_mirrored_sequence() -> None:
    times = np.arange(200) / RATE_HZ
    forward = Supply(400.0, 50.0).phase_voltages(times)
    backward = Supply(400.0, 50.0, sequence="acb").phase_voltages(times)
    assert backward == pytest.approx(forward[[0, 2, 1]])


def test_equivalent_level_of_a_resistive_path() -> None:
    assert TurnFault(0.05, 0).equivalent_level(8.4) == pytest.approx(0.05)
    assert TurnFault(0.05, 0, 1.0).equivalent_level(8.4) == pytest.approx(8.4 / (1 / 0.05**2 + 8.4 / 0.05))
    assert TurnFault(0.0, 0, 1.0).equivalent_level(8.4) == 0.0


def test_a_developing_fault_grows_from_window_to_window() -> None:
    course = FaultCourse(1, ((10.0, 0.0), (20.0, 0.04), (30.0, 0.1)))
    levels = [course.at(time_s).turns for time_s in (0.0, 10.0, 15.0, 20.0, 25.0, 30.0, 99.0)]
    assert levels == pytest.approx([0.0, 0.0, 0.02, 0.04, 0.07, 0.1, 0.1])
    motor = plant(fault=course)
    early, middle, late = (
        motor.operation(time_s, 0.02, RATE_HZ).currents_A[1].std() for time_s in (5, 15, 25)
    )
    assert early < middle < late


def test_a_fault_below_notice_is_no_fault_in_the_equations() -> None:
    """Otherwise a path of some resistance across hardly any turns would ask for endlessly small steps."""
    motor = plant(fault=short(1e-4, resistance_ohm=5.0))
    assert TurnFault(1e-4, 1, 5.0).equivalent_level(8.4) < NEGLIGIBLE_LEVEL
    assert motor.fault_at(0.0) is None
    assert plant(fault=short(1e-3)).fault_at(0.0) is not None


@pytest.mark.parametrize("sequence", ["abc", "acb"])
def test_metering_of_the_reference_motor(sequence: str) -> None:
    supply = Supply(380.0, 50.0, sequence="abc" if sequence == "abc" else "acb")
    metering = meter(plant(supply=supply, sensors=FINE), 5.0)
    assert metering.frequency_Hz == 50.0
    assert np.abs(metering.currents_A) == pytest.approx([1.203] * 3, abs=2e-3)
    assert np.abs(metering.line_voltages_V) == pytest.approx([380.0] * 3, rel=1e-3)
    positive, negative, zero = np.abs(metering.sequence(metering.currents_A))
    assert positive == pytest.approx(1.203, abs=2e-3)
    assert max(negative, zero) < 1e-3
    stator_loss = 3 * 8.4 * 1.203**2
    air_gap_power = 0.5 * 800  # torque times synchronous speed
    assert metering.complex_power_VA.real == pytest.approx(stator_loss + air_gap_power, rel=2e-3)
    assert metering.complex_power_VA.imag > 0
    assert 0 < metering.power_factor < 1


def test_metering_sees_the_negative_sequence_of_a_fault() -> None:
    healthy = meter(plant(LARGE), 2.0)
    faulted = meter(plant(LARGE, fault=short(0.05)), 2.0)
    assert abs(healthy.sequence(healthy.currents_A)[1]) < 0.1
    assert abs(faulted.sequence(faulted.currents_A)[1]) > 5


def test_the_motor_follows_a_load_that_swings() -> None:
    motor = plant(REFERENCE, load=Load(0.5, 0.2, 8.0))
    heavy, light = (motor.operation(time_s, 0.02, RATE_HZ).speed_rad_s.mean() for time_s in (2.0, 6.0))
    assert heavy < light
