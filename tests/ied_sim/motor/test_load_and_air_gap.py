"""Pulsating loads, inertia and eccentricity: energy, and lines where and as large as theory has them."""

from dataclasses import replace
from math import ceil, pi

import numpy as np
import pytest
from numpy.typing import NDArray

from ied_sim.motor.deep_bars import UNSATURATED
from ied_sim.motor.driving import drive as driven_by
from ied_sim.motor.eccentricity import Eccentricity
from ied_sim.motor.fault import TurnFault
from ied_sim.motor.integration import Loops, integrate
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.saturation import LINEAR_IRON
from ied_sim.motor.supply import Supply
from testing.machines.motors import MEDIUM, REFERENCE
from tests.ied_sim.motor.plants import plant, short

Array = NDArray[np.float64]

RATE_HZ = 2_000.0


def amplitude(samples: Array, frequency_Hz: float, *others_Hz: float) -> float:
    """Amplitude of one line, fitted beside the mean and the other lines."""
    times = np.arange(samples.size) / RATE_HZ
    columns = [np.ones(samples.size)]
    for each_Hz in (frequency_Hz, *others_Hz):
        columns += [np.cos(2 * pi * each_Hz * times), np.sin(2 * pi * each_Hz * times)]
    fitted = np.linalg.lstsq(np.array(columns).T, samples, rcond=None)[0]
    return float(np.hypot(fitted[1], fitted[2]))


def test_no_energy_is_lost_or_made() -> None:
    """What comes in is heat, field, motion and work, with all that can be wrong at once."""
    load = Load(0.7, pulsations=(Pulsation(0.2, per_turn=1.0), Pulsation(0.1, twice_slip=True)))
    motor = replace(
        plant(MEDIUM, load=load, fault=short(0.05)),
        broken_bars=2.5 / 28,
        eccentricity=Eccentricity(0.3, 0.2),
    )
    circuit = motor.circuit(0.0)
    eccentricity, p = motor.eccentricity, MEDIUM.nameplate.pole_pairs
    loops = Loops(
        circuit.leakage,
        circuit.deep_leakage,
        circuit.constant,
        circuit.cosine,
        circuit.sine,
        circuit.resistance,
        p,
        motor.inertia_kgm2,
        eccentricity.static,
        eccentricity.dynamic,
        circuit.stator_current,
        UNSATURATED.share,
        UNSATURATED.knee_A,
        circuit.rotor_current,
        LINEAR_IRON.share,
        LINEAR_IRON.exponent,
        1.0,
    )
    step_s, steps = 1 / 40_000, 12_000
    half_steps = np.arange(2 * steps + 1) * step_s / 2
    drive = driven_by(circuit, motor.supply, motor.load, MEDIUM.nameplate, half_steps, step_s)
    state = np.zeros(circuit.loops + 2)
    currents, speed = integrate(loops, drive, 1, state)

    angle = np.concatenate(([0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * step_s))) * p
    swings = np.cos(drive.pulsation_order * angle[:, None] + drive.pulsation_angle[::2])
    load_torque = drive.load_torque[::2] + swings @ drive.pulsation_torque
    resistance = circuit.resistance
    heat_W = np.einsum("ni,ij,nj->n", currents, resistance, currents)
    put_in_W = np.sum(drive.voltage[::2] * currents, axis=1)
    work_W = load_torque * speed
    motion_J = 0.5 * motor.inertia_kgm2 * speed[-1] ** 2
    field_J = 0.5 * state[:-2] @ currents[-1]
    put_in_J, heat_J, work_J = (
        float(np.sum((each[1:] + each[:-1]) / 2)) * step_s for each in (put_in_W, heat_W, work_W)
    )
    assert put_in_J == pytest.approx(heat_J + work_J + motion_J + field_J, rel=2e-4)
    assert motion_J > 0.05 * put_in_J
    assert isinstance(motor.fault_at(0.0), TurnFault)


@pytest.mark.parametrize("sequence", ["abc", "acb"])
@pytest.mark.parametrize(
    "pulsation",
    [
        Pulsation(0.05, frequency_Hz=6.3),
        Pulsation(0.05, per_turn=1.0),
        Pulsation(0.05, per_turn=0.31),
        Pulsation(0.05, twice_slip=True),
    ],
    ids=["frequency", "shaft", "belt", "twice slip"],
)
def test_a_pulsation_swings_the_speed_at_its_frequency(pulsation: Pulsation, sequence: str) -> None:
    """It is T / |j w J + k|, with k the slope of the motor's torque over its speed, at this load."""
    inertia = 0.5
    supply = Supply(380, 50, sequence="abc" if sequence == "abc" else "acb")
    motor = plant(supply=supply, load=Load(0.6, pulsations=(pulsation,), inertia_kgm2=inertia))
    run = motor.operation(10.0, 8.0, RATE_HZ)
    speed = np.abs(run.speed_rad_s)
    shaft_Hz = speed.mean() / (2 * pi)
    twice_slip_Hz = 2 * (50 - 2 * shaft_Hz)
    frequency_Hz = pulsation.frequency_Hz or pulsation.per_turn * shaft_Hz or twice_slip_Hz
    quiet = [plant(level=level).operation(10.0, 0.2, RATE_HZ).speed_rad_s.mean() for level in (0.55, 0.65)]
    rated = REFERENCE.nameplate.rated_torque_Nm
    slope = 0.1 * rated / (quiet[0] - quiet[1])
    inertia += REFERENCE.parameters.inertia_kgm2
    expected = 0.05 * rated / abs(2j * pi * frequency_Hz * inertia + slope)
    assert amplitude(speed, frequency_Hz) == pytest.approx(expected, rel=0.03)
    currents = run.currents_A[0]
    lines = [amplitude(currents, 50 + side * frequency_Hz, 50, 50 - side * frequency_Hz) for side in (-1, 1)]
    assert min(lines) > 5e-5 * amplitude(currents, 50)


def test_pulsations_of_the_shaft_have_another_phase_in_each_window_and_the_same_every_time() -> None:
    pulsating = plant(load=Load(0.6, pulsations=(Pulsation(0.3, per_turn=1.0),), inertia_kgm2=0.1))
    moments_s = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 10.0)
    windows = [pulsating.operation(at_s, 0.2, RATE_HZ).speed_rad_s for at_s in moments_s]
    assert np.array_equal(windows[0], windows[-1])
    shaft = np.exp(-1j * np.mean(windows) / RATE_HZ * np.arange(windows[0].size))
    phasors = np.array([(window - window.mean()) @ shaft for window in windows[:-1]])
    assert abs(np.mean(phasors / np.abs(phasors))) < 0.8


def test_the_loads_inertia_lengthens_the_start_and_the_windows_know() -> None:
    heavy = plant(load=Load(0.3, inertia_kgm2=9 * REFERENCE.parameters.inertia_kgm2))
    seconds = []
    for motor in (plant(level=0.3), heavy):
        speed = motor.start_up(0.0, 4.0, 500.0).speed_rad_s
        seconds.append(np.flatnonzero(speed > 0.9 * speed[-1])[0] / 500.0)
    assert seconds[1] == pytest.approx(10 * seconds[0], rel=0.1)
    fan = plant(load=Load(0.3, inertia_kgm2=200 * REFERENCE.parameters.inertia_kgm2))
    assert fan.start_memory_s > 10.0
    settled = fan.operation(0.0, 1.0, 500.0).speed_rad_s
    assert np.ptp(settled) < 1e-3 * settled.mean()


def eccentric(static: float, dynamic: float) -> MotorPlant:
    heavy = Load(0.6, inertia_kgm2=30 * MEDIUM.parameters.inertia_kgm2)
    return replace(plant(MEDIUM, load=heavy), eccentricity=Eccentricity(static, dynamic))


def test_mixed_eccentricity_makes_lines_at_f_plus_and_minus_the_shafts() -> None:
    """As large as a modulated magnetising inductance makes them at constant speed, by harmonic balance."""
    motor = eccentric(0.2, 0.15)
    run = motor.operation(0.0, ceil(motor.settling_s), RATE_HZ)
    shaft_Hz = run.speed_rad_s.mean() / (2 * pi)
    sides = (50 - shaft_Hz, 50 + shaft_Hz)
    found = [amplitude(run.currents_A[0], each_Hz, 50, *(set(sides) - {each_Hz})) for each_Hz in sides]
    expected = modulated_lines(motor, shaft_Hz)
    assert found == pytest.approx(expected, rel=0.03)
    assert min(found) > 1e-3 * amplitude(run.currents_A[0], 50, *sides)


def modulated_lines(motor: MotorPlant, shaft_Hz: float) -> list[float]:
    """Stator currents at f - f_r and f + f_r of a machine whose L_m swings with the gap's permeance."""
    x, p = motor.motor.parameters, motor.motor.nameplate.pole_pairs
    turn = np.linspace(0, 2 * pi, 720, endpoint=False)
    static, dynamic = motor.eccentricity.static, motor.eccentricity.dynamic
    permeance = 1 / np.sqrt(1 - static**2 - dynamic**2 - 2 * static * dynamic * np.cos(turn))
    orders = np.arange(-3, 4)
    coefficient = {k: complex(np.mean(permeance * np.exp(-1j * k * turn))) for k in range(-6, 7)}
    gap = x.magnetising_inductance_H * np.array([[coefficient[int(i - j)] for j in orders] for i in orders])
    eye = np.eye(orders.size)
    stator = np.hstack((gap + x.stator_leakage_H * eye, gap))
    rotor = np.hstack((gap, gap + x.rotor_leakage_H * eye))
    w = 2 * pi * (50 + orders * shaft_Hz)
    w_rotor = w - 2 * pi * p * shaft_Hz
    resistance = np.kron(np.diag([x.stator_resistance_ohm, x.rotor_resistance_ohm]), eye)
    equations = resistance + 1j * np.vstack((w[:, None] * stator, w_rotor[:, None] * rotor))
    voltage = np.zeros(2 * orders.size)
    voltage[3] = motor.supply.line_voltage_V * (2 / 3) ** 0.5
    currents = np.abs(np.linalg.solve(equations, voltage))
    return [float(currents[2]), float(currents[4])]


@pytest.mark.parametrize(("static", "dynamic"), [(0.2, 0.0), (0.0, 0.2)])
def test_one_kind_of_eccentricity_alone_makes_no_lines(static: float, dynamic: float) -> None:
    run = eccentric(static, dynamic).operation(0.0, 2.0, RATE_HZ)
    shaft_Hz = run.speed_rad_s.mean() / (2 * pi)
    current = run.currents_A[0]
    assert amplitude(current, 50 - shaft_Hz, 50) < 1e-5 * amplitude(current, 50)
