"""The winding model against published figures, an independent integrator and the split-winding equations."""

import time
from math import pi, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from core.machines.parameters import Connection, Motor
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL, TurnFault
from ied_sim.motor.plant import HIGHEST_STEP_RATE_HZ, RATE_PER_STEP, MotorPlant, rated_current
from ied_sim.motor.supply import Harmonic, Supply
from ied_sim.motor.windings import highest_fault_resistance, winding_circuit
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from tests.ied_sim.motor.plants import plant, short

Array = NDArray[np.float64]
RPM = 30 / pi
RECORDED_S = 0.5


def rms(samples: Array) -> Array:
    values: Array = np.sqrt(np.mean(samples**2, axis=-1))
    return values


@pytest.mark.parametrize(
    ("level", "speed_rpm", "current_A"),
    [
        (0.0, 1500.0, 1.012),
        (0.25, 1480.7, 1.056),
        (0.5, 1460.4, 1.203),
        (0.75, 1438.6, 1.429),
        (1.0, 1415.2, 1.714),
    ],
)
def test_reference_motor_runs_at_its_known_operating_points(
    level: float, speed_rpm: float, current_A: float
) -> None:
    operation = plant(level=level).operation(0.0, 0.1, 10_000)
    assert operation.speed_rad_s.mean() * RPM == pytest.approx(speed_rpm, abs=0.051)
    assert rms(operation.currents_A) == pytest.approx([current_A] * 3, abs=0.0006)


def test_ten_percent_of_phase_b_shorted_draws_the_published_currents() -> None:
    operation = plant(fault=short(0.1)).operation(0.0, 0.1, 10_000)
    assert rms(operation.currents_A) == pytest.approx([1.542, 2.378, 1.619], abs=0.0006)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_no_shorted_turns_is_exactly_the_healthy_motor(motor: Motor) -> None:
    healthy = plant(motor).operation(0.0, 0.05, 10_000)
    unfaulted = plant(motor, fault=short(0.0)).operation(0.0, 0.05, 10_000)
    assert np.array_equal(healthy.currents_A, unfaulted.currents_A)
    circuit = winding_circuit(motor, TurnFault(0.0, 1))
    assert circuit.loops == plant(motor).circuit(0.0).loops


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
def test_few_shorted_turns_disturb_in_proportion(motor: Motor) -> None:
    healthy = plant(motor).operation(0.0, 0.04, 10_000).currents_A
    disturbance = [
        rms(plant(motor, fault=short(turns)).operation(0.0, 0.04, 10_000).currents_A - healthy).max()
        for turns in (1e-4, 1e-3)
    ]
    assert disturbance[1] / disturbance[0] == pytest.approx(10, rel=0.01)


@pytest.mark.parametrize("sequence", ["abc", "acb"])
@pytest.mark.parametrize(
    ("motor", "fault"),
    [
        (REFERENCE, None),
        (REFERENCE, TurnFault(0.05, 1)),
        (MEDIUM, TurnFault(0.02, 2, 0.05)),
        (MEDIUM, TurnFault(0.01, 0, 0.5)),
        (LARGE, TurnFault(0.1, 0)),
    ],
)
def test_start_up_agrees_with_an_eighth_order_integrator(
    motor: Motor, fault: TurnFault | None, sequence: str
) -> None:
    """0.15 s from rest: the hardest the equations get, to 1e-5 of the largest current."""
    supply = Supply(
        motor.nameplate.rated_voltage_V,
        50.0,
        unbalance=0.02,
        unbalance_angle_rad=0.7,
        harmonics=(Harmonic(5, 0.015, 0.2), Harmonic(7, 0.01, -0.6)),
        sequence="abc" if sequence == "abc" else "acb",
    )
    course = None if fault is None else short(fault.turns, fault.phase, fault.resistance_ohm)
    ours = plant(motor, supply=supply, fault=course).start_up(0.0, 0.15, 10_000).currents_A
    circuit = winding_circuit(motor, fault)
    m, p = circuit.loops, motor.nameplate.pole_pairs
    load_torque = supply.direction * 0.5 * motor.nameplate.rated_torque_Nm

    def rhs(t: float, y: Array) -> Array:
        q = np.linalg.solve(circuit.inductance(y[m + 1]), y[:m])
        slope = circuit.sine * np.cos(y[m + 1]) - circuit.cosine * np.sin(y[m + 1])
        flux_rate = circuit.drive @ supply.phase_voltages(np.array([t]))[:, 0] - circuit.resistance @ q
        acceleration = (p * q @ slope @ q / 2 - load_torque) / motor.parameters.inertia_kgm2
        return np.array([*flux_rate, acceleration, p * y[m]])

    times = np.arange(ours.shape[1]) / 10_000
    theirs = solve_ivp(rhs, (0, times[-1]), np.zeros(m + 2), "DOP853", times, rtol=1e-10, atol=1e-12)
    loop_currents = np.array([np.linalg.solve(circuit.inductance(y[m + 1]), y[:m]) for y in theirs.y.T])
    expected = circuit.line_currents(loop_currents)
    assert np.abs(ours - expected).max() < 1e-5 * np.abs(expected).max()


def test_circuit_reproduces_the_split_winding_equations() -> None:
    """PHYSICS section 4 (Tallam 2002) written out in Clarke components, with a fault resistance."""
    motor, mu, r_f, phase = REFERENCE, 0.08, 0.9, 2
    x, p = motor.parameters, motor.nameplate.pole_pairs
    L_m, k = x.magnetising_inductance_H, sqrt(2 / 3)
    n = np.array([np.cos(2 * pi / 3 * phase), np.sin(2 * pi / 3 * phase)])
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    T = k * np.array([[1, -0.5, -0.5], [0, sqrt(3) / 2, -sqrt(3) / 2]])
    eye, column, row = np.eye(2), n[:, None], n[None, :]
    # Fluxes (psi_s, psi_r, psi_x2) of the currents (i_s, i_r, i_f).
    stator = np.hstack(
        ((x.stator_leakage_H + L_m) * eye, L_m * eye, -(x.stator_leakage_H + L_m) * k * mu * column)
    )
    rotor = np.hstack((L_m * eye, (x.rotor_leakage_H + L_m) * eye, -L_m * k * mu * column))
    share = x.stator_leakage_H * np.hstack((k * row, 0 * row, [[-1.0]]))
    share += k * L_m * np.hstack((row, row, [[-k * mu]]))
    inductance = np.vstack((stator, rotor, mu * share))
    supply = Supply(380.0, 50.0)

    def currents(y: Array) -> Array:
        solved: Array = np.linalg.solve(inductance, y[:5]).astype(np.float64)
        return solved

    def rhs(t: float, y: Array) -> Array:
        i = currents(y)
        i_s, i_r, i_f, w = i[:2], i[2:4], i[4], y[5]
        v_s = T @ supply.phase_voltages(np.array([t]))[:, 0]
        psi_r = y[2:4]
        i_turns = i_s - k * n * mu * i_f
        torque = p * (psi_r[1] * i_r[0] - psi_r[0] * i_r[1])
        rates = [
            *(v_s - x.stator_resistance_ohm * i_turns),
            *(w * J @ psi_r - x.rotor_resistance_ohm * i_r),
            r_f * i_f - mu * x.stator_resistance_ohm * (k * n @ i_s - i_f),
            (torque - 0.5 * motor.nameplate.rated_torque_Nm) * p / x.inertia_kgm2,
        ]
        return np.array(rates)

    times = np.arange(2000) / 10_000
    theirs = solve_ivp(rhs, (0, times[-1]), np.zeros(6), "DOP853", times, rtol=1e-9, atol=1e-11)
    expected = T.T @ np.array([currents(y)[:2] for y in theirs.y.T]).T
    ours = plant(fault=short(mu, phase, r_f)).start_up(0.0, 0.2, 10_000).currents_A
    assert np.abs(ours - expected).max() < 1e-5 * np.abs(expected).max()


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("level", [0.0, 1.0])
def test_windows_begin_settled(motor: Motor, level: float) -> None:
    faulted = plant(motor, level=level, fault=short(0.1))
    usual = faulted.operation(0.0, 0.02, 10_000).currents_A
    longer = faulted.operation(0.0, 0.02, 10_000, settling_s=4.0).currents_A
    assert np.abs(usual - longer).max() < 1e-4 * np.abs(longer).max()


def test_line_currents_of_a_three_wire_motor_add_up_to_nothing() -> None:
    for motor in (REFERENCE, LARGE):
        currents = plant(motor, fault=short(0.1)).operation(0.0, 0.02, 10_000).currents_A
        assert np.abs(currents.sum(axis=0)).max() < 1e-9 * np.abs(currents).max()


def test_a_delta_fault_of_phase_a_shows_between_terminals_a_and_b() -> None:
    """What the shorted winding draws comes in at a and leaves at b: line c carries the least of it."""
    healthy = plant(LARGE).operation(0.0, 0.02, 10_000).currents_A
    faulted = plant(LARGE, fault=short(0.01, 0)).operation(0.0, 0.02, 10_000).currents_A
    extra = rms(faulted - healthy)
    assert extra[2] < 0.05 * extra[0]
    assert extra[0] == pytest.approx(extra[1], rel=0.05)


def test_with_acb_the_motor_turns_backwards_and_terminals_keep_their_windings() -> None:
    forward = plant(fault=short(0.1, 2)).operation(0.0, 0.1, 10_000)
    supply = Supply(380.0, 50.0, sequence="acb")
    backward = plant(supply=supply, fault=short(0.1, 2)).operation(0.0, 0.1, 10_000)
    assert backward.speed_rad_s.mean() == pytest.approx(-forward.speed_rad_s.mean(), rel=1e-6)
    assert rms(backward.currents_A) == pytest.approx(rms(forward.currents_A)[[1, 0, 2]], rel=1e-6)


def test_star_and_delta_of_equal_impedance_draw_the_same() -> None:
    star = MEDIUM.parameters
    tripled = type(star)(
        3 * star.stator_resistance_ohm,
        3 * star.rotor_resistance_ohm,
        3 * star.stator_leakage_H,
        3 * star.rotor_leakage_H,
        3 * star.stator_self_inductance_H,
        star.inertia_kgm2,
    )
    nameplate = MEDIUM.nameplate
    delta = Motor("delta twin", type(nameplate)(7_500, 400, 50, 2, Connection.DELTA), tripled)
    in_star = plant(MEDIUM).operation(0.0, 0.02, 10_000).currents_A
    in_delta = plant(delta).operation(0.0, 0.02, 10_000).currents_A
    assert np.abs(in_star - in_delta).max() < 1e-6 * np.abs(in_star).max()


def test_settling_and_recording_is_fast_enough_for_real_time() -> None:
    faulted = plant(fault=short(0.05))
    faulted.operation(0.0, 0.01, 10_000)
    fastest_s = min(_seconds(faulted) for _ in range(5))
    assert fastest_s < RECORDED_S  # about a tenth of it; a slow machine takes half


def _seconds(motor_plant: MotorPlant) -> float:
    begin = time.thread_time()
    motor_plant.operation(0.0, RECORDED_S, 10_000)
    return time.thread_time() - begin


def test_rated_current_is_near_that_of_the_known_motor() -> None:
    assert rated_current(REFERENCE) == pytest.approx(1.714, rel=0.05)


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_the_stiffest_fault_a_scenario_may_have_is_stable(motor: Motor) -> None:
    """The highest resistance across the fewest turns that still count: nearly healthy, and no more."""
    highest_ohm = highest_fault_resistance(motor.parameters, HIGHEST_STEP_RATE_HZ * RATE_PER_STEP)
    turns = 1.01 * sqrt(NEGLIGIBLE_LEVEL * highest_ohm / motor.parameters.stator_resistance_ohm)
    stiff = plant(motor, fault=short(turns, resistance_ohm=highest_ohm))
    assert stiff.fault_at(0.0) is not None
    faulted = stiff.operation(0.0, 0.02, 10_000, settling_s=0.3).currents_A
    healthy = plant(motor).operation(0.0, 0.02, 10_000, settling_s=0.3).currents_A
    assert 0 < np.abs(faulted - healthy).max() < 1e-3 * np.abs(healthy).max()
