"""What changes over days: joints, paths, sensors, temperatures, the supply; against closed forms."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.parameters import Motor
from core.units import SECONDS_PER_DAY
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load, LoadCycle
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import ChannelChange, Sensors
from ied_sim.motor.supply import Supply, SupplyStep, SupplyWander
from ied_sim.motor.wander import Wander
from ied_sim.motor.warming import Warming
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from tests.ied_sim.motor.plants import plant

RATE_HZ = 10_000.0
TURN = np.exp(2j * pi / 3)
DAY = float(SECONDS_PER_DAY)
Phasors = NDArray[np.complex128]


def at_steady_speed(motor: Motor) -> Motor:
    """A motor so heavy that its speed does not follow the torque's ripple, as the closed forms have it."""
    return replace(motor, parameters=replace(motor.parameters, inertia_kgm2=1e3))


STEADY_MEDIUM, STEADY_LARGE = at_steady_speed(MEDIUM), at_steady_speed(LARGE)


def phasors(samples: NDArray[np.float64]) -> Phasors:
    """Phasors of six channels over whole cycles of 50 Hz."""
    angle = 2 * pi * 50.0 * np.arange(samples.shape[1]) / RATE_HZ
    turned: Phasors = 2 / samples.shape[1] * samples @ np.exp(-1j * angle)
    return turned


def sequence(three: Phasors, number: int) -> complex:
    return complex(three[0] + TURN**number * three[1] + TURN ** (2 * number) * three[2]) / 3


def operated(motor_plant: MotorPlant, time_s: float = 1.0) -> tuple[Phasors, float]:
    """Phasors of the true currents and voltages, and the slip."""
    operation = motor_plant.operation(time_s, 0.1, RATE_HZ)
    synchronous = 2 * pi * 50.0 / motor_plant.motor.nameplate.pole_pairs
    true = np.vstack((operation.currents_A, operation.voltages_V))
    return phasors(true), 1 - float(operation.speed_rad_s.mean()) / synchronous


def impedance(motor: Motor, slip: float) -> complex:
    """Impedance of a winding: the stator, and the cage beside the magnetising branch."""
    x, w = motor.parameters, 2 * pi * 50.0
    cage = x.rotor_resistance_ohm / slip + 1j * w * x.rotor_leakage_H
    magnetising = 1j * w * x.magnetising_inductance_H
    branch = cage * magnetising / (cage + magnetising)
    return x.stator_resistance_ohm + 1j * w * x.stator_leakage_H + branch


@pytest.mark.parametrize("phase", [0, 1, 2])
def test_a_joint_takes_its_drop_from_one_phase(phase: int) -> None:
    """V_k = drop_k + Z_k I_k in both sequences; the drop is dR I_x in one phase, none in the others."""
    added_ohm = 0.15 * MEDIUM.parameters.stator_resistance_ohm
    bad = replace(plant(STEADY_MEDIUM, level=0.7), joint=JointCourse(phase, ((0.0, 0.0), (10.0, added_ohm))))
    healthy, _ = operated(bad, 0.0)
    assert abs(sequence(healthy[:3], 2)) < 1e-6 * abs(sequence(healthy[:3], 1))
    seen, slip = operated(bad, 20.0)
    drop = np.zeros(3, complex)
    drop[phase] = added_ohm * seen[phase]
    for number, at_slip in ((1, slip), (2, 2 - slip)):
        expected = (sequence(seen[3:], number) - sequence(drop, number)) / impedance(MEDIUM, at_slip)
        assert sequence(seen[:3], number) == pytest.approx(expected, abs=1e-5 * abs(seen[0]))
    assert abs(sequence(seen[:3], 2)) > 0.002 * abs(sequence(seen[:3], 1))


def test_a_joint_before_a_delta_carries_the_line_current() -> None:
    added_ohm = 0.02
    bad = replace(plant(STEADY_LARGE), joint=JointCourse(2, ((0.0, added_ohm),)))
    seen, slip = operated(bad)
    drop = np.zeros(3, complex)
    drop[2] = added_ohm * seen[2]
    expected = 3 * (sequence(seen[3:], 2) - sequence(drop, 2)) / impedance(LARGE, 2 - slip)
    assert sequence(seen[:3], 2) == pytest.approx(expected, abs=1e-5 * abs(seen[0]))


@pytest.mark.parametrize("path_ratio", [0.0, 1.0, 3.0])
def test_a_path_of_a_ratio_shorts_the_same_equivalent_level_however_far_it_has_grown(
    path_ratio: float,
) -> None:
    """Few turns drive V / (R_s (1 + p) + j X_ls) through the path, of which the line carries mu."""
    x = MEDIUM.parameters
    growing = FaultCourse(1, ((0.0, 0.0), (100.0, 0.01)), 0.0, path_ratio * x.stator_resistance_ohm)
    for time_s, turns in ((20.0, 0.002), (50.0, 0.005)):
        fault = growing.at(time_s)
        assert fault.equivalent_level(x.stator_resistance_ohm) == pytest.approx(turns / (1 + path_ratio))
        seen, _ = operated(plant(MEDIUM, level=0.7, fault=growing), time_s)
        induced = seen[4]
        through = induced / (x.stator_resistance_ohm * (1 + path_ratio) + 2j * pi * 50 * x.stator_leakage_H)
        share = sequence(seen[:3], 2) / (turns * through * TURN**2 / 3)
        assert share == pytest.approx(1.0, abs=0.04)


def test_channels_are_late_by_their_own_delays() -> None:
    fine = Sensors(full_scale_A=100.0, full_scale_V=700.0)
    delays_s = (10e-6, -25e-6, 40e-6, 5e-6, 0.0, -15e-6)
    late = replace(fine, delays_s=delays_s, current_delay_s=30e-6)
    exact, seen = (phasors(plant(MEDIUM, sensors=each).window(1.0, 0.1, RATE_HZ)) for each in (fine, late))
    behind_s = np.array(delays_s) + np.repeat([30e-6, 0.0], 3)
    assert seen / exact == pytest.approx(np.exp(-2j * pi * 50 * behind_s), abs=2e-5)


def test_channels_jump_and_drift_until_they_stop() -> None:
    changes = (
        ChannelChange(3, at_s=2 * DAY, gain=-0.01, delay_s=20e-6),
        ChannelChange(1, at_s=1 * DAY, gain_per_day=0.002, delay_per_day_s=1e-6, until_s=4 * DAY),
    )
    sensors = Sensors(100.0, 700.0, gain_errors=(0.0, 0.005, 0, 0, 0, 0), changes=changes)
    assert sensors.gains(0.0) == pytest.approx([0, 0.005, 0, 0, 0, 0])
    assert sensors.gains(3 * DAY) == pytest.approx([0, 0.009, 0, -0.01, 0, 0])
    assert sensors.gains(9 * DAY) == pytest.approx([0, 0.011, 0, -0.01, 0, 0])
    assert sensors.delays(9 * DAY) == pytest.approx([0, 3e-6, 0, 20e-6, 0, 0])
    drifting = plant(MEDIUM, sensors=sensors)
    before, after = (phasors(drifting.window(days * DAY, 0.1, RATE_HZ)) for days in (0.0, 9.0))
    assert abs(after[3]) / abs(before[3]) == pytest.approx(0.99, abs=1e-4)
    assert abs(after[1]) / abs(before[1]) == pytest.approx(1.011 / 1.005, abs=1e-4)
    assert abs(after[4]) / abs(before[4]) == pytest.approx(1.0, abs=1e-4)


def test_windings_follow_their_load_and_the_day() -> None:
    """A first-order lag: against its own differential equation, stepped."""
    cycle = LoadCycle(((0.0, 0.2), (3600.0, 0.2), (3601.0, 1.0), (7200.0, 1.0)), 7201.0)
    warming = Warming(60.0, 1500.0, idle_share=0.3, ambient_K=5.0, ambient_swing_K=8.0)
    load = Load(0.5, cycle=cycle)
    step_s, rise_K = 5.0, 0.0
    for k in range(4000):
        level = load.level_at((k + 0.5) * step_s)
        rise_K += (60.0 * (0.3 + 0.7 * level**2) - rise_K) * step_s / 1500.0
    end_s = 4000 * step_s
    expected_K = 5.0 + 8.0 * np.sin(2 * pi * end_s / DAY) + rise_K
    assert warming.temperature_K(end_s, load.levels) == pytest.approx(expected_K, abs=0.3)


def test_a_motor_that_stands_cools() -> None:
    contactor = Contactor()
    contactor.open(10_000.0)
    stopped = replace(plant(REFERENCE, level=1.0), warming=Warming(50.0, 600.0), contactor=contactor)
    hot, cooler, cold = (
        stopped.resistance_factors(time_s).stator for time_s in (9_999.0, 10_600.0, 20_000.0)
    )
    assert hot == pytest.approx(1 + 0.00393 * 50, rel=1e-3)
    assert cooler - 1 == pytest.approx((hot - 1) * np.exp(-1), rel=0.02)
    assert cold == pytest.approx(1.0, abs=1e-6)


def test_wander_is_an_autoregressive_process_that_any_moment_can_be_asked_of() -> None:
    wander = Wander(seed=5, stream=1, time_constant_s=3600.0)
    times = np.arange(-3.6e6, 3.6e6, 180.0)
    values = wander.at(times)
    assert values.std() == pytest.approx(1.0, abs=0.05)
    assert abs(values.mean()) < 0.1
    for steps in (10, 20, 40):
        lagged = np.mean(values[steps:] * values[:-steps]) / values.var()
        assert lagged == pytest.approx(np.exp(-steps * 180.0 / 3600.0), abs=0.06)
    between = np.array([12_345.6, 98_765.4])
    assert wander.at(between[1:])[0] == wander.at(between)[1]
    assert np.array_equal(Wander(5, 2, 3600.0).at(times[:20]), values[:20]) is False


def test_a_supply_steps_and_wanders_in_its_sequences() -> None:
    steps = (SupplyStep(DAY, voltage=-0.02, unbalance=0.01j, zero_sequence=0.003),)
    supply = Supply(400.0, 50.0, unbalance=0.005, zero_sequence=0.002, steps=steps)
    for time_s, V1, V2, V0 in ((0.0, 1.0, 0.005, 0.002), (2 * DAY, 0.98, 0.005 + 0.01j, 0.005)):
        # Angles count from the phasor of V1, whose own angle is that of the moment.
        volts = phasors(supply.phase_voltages(time_s + np.arange(1000) / RATE_HZ)) / (400.0 * np.sqrt(2 / 3))
        own = sequence(volts, 1) / abs(sequence(volts, 1))
        assert [sequence(volts, k) / own for k in (1, 2, 0)] == pytest.approx(
            [V1, V2 * V1, V0 * V1], abs=1e-6
        )
    wandering = replace(supply, wander=SupplyWander(0.01, 0.002, 0.001, 3600.0, seed=3))
    seen = wandering.sequences(np.arange(0.0, 7.2e6, 3600.0))
    assert seen.voltage[30:].std() == pytest.approx(0.01, rel=0.1)
    assert seen.unbalance[30:].real.std() == pytest.approx(0.002, rel=0.1)
    assert seen.zero_sequence[30:].imag.std() == pytest.approx(0.001, rel=0.1)


def test_a_motor_settles_after_a_step_as_it_does_without_one() -> None:
    stepping = plant(MEDIUM, supply=Supply(400.0, 50.0, steps=(SupplyStep(100.0, unbalance=0.01),)))
    stepped = plant(MEDIUM, supply=Supply(400.0, 50.0, unbalance=0.01))
    just_after, long_since = (each.operation(101.0, 0.02, RATE_HZ).currents_A for each in (stepping, stepped))
    assert just_after == pytest.approx(long_since, abs=1e-3 * np.abs(long_since).max())
