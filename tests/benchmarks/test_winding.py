"""Equations of shorted turns inside one coil: what they follow from, and how near all coils come to them."""

from dataclasses import replace
from math import degrees, pi, radians

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.winding.cases import WINDINGS, Case
from benchmarks.winding.one_slip import TURN, Terminals, psi_of
from benchmarks.winding.over_time import followed
from benchmarks.winding.records import Trial
from benchmarks.winding.table import fits
from core.condition.kinds import Kind
from core.machines.parameters import Connection, Motor
from testing.machines.rated_motors import rated_motor
from testing.machines.slot_fault_records import USUAL, drawn_case

Complex = NDArray[np.complex128]
K = np.sqrt(2 / 3)
CLARKE = K * np.array([[1, -0.5, -0.5], [0, np.sqrt(3) / 2, -np.sqrt(3) / 2]])


def unit(angle: float) -> NDArray[np.float64]:
    return np.array([np.cos(angle), np.sin(angle)])


def by_fluxes(
    motor: Motor,
    slip: float,
    voltage: Complex,
    *,
    phase: int,
    mu: float,
    path: float,
    kappa: float,
    delta: float,
) -> Complex:
    """Winding currents of a, b, c by the flux equations in Clarke components.

    psi_m = L_m (i_s - k n_c mu i_f + i_r), psi_s = L_ls (i_s - k n mu i_f) + psi_m,
    psi_x2 = mu (L_ls (i_x - lambda i_f) + k n_c . psi_m). The rotor is L_m and A at s and 2 - s beside it.
    """
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    jw, L_m, L_ls = 1j * w, machine.magnetising_inductance_H, machine.stator_leakage_H
    R_s, own = machine.stator_resistance_ohm, kappa + (1 - kappa) * mu
    link = 1 / 0.9598
    n, n_c = unit(2 * pi / 3 * phase), link * unit(2 * pi / 3 * phase + delta)

    def beside(s: float) -> complex:
        rotor = machine.rotor_resistance_ohm / s + jw * machine.rotor_leakage_H
        return complex(jw * L_m * rotor / (jw * L_m + rotor))

    # A field that turns forward is (1, -j), one that turns backward (1, j): A acts on each by its own slip.
    forward, backward = np.array([1, -1j]) / np.sqrt(2), np.array([1, 1j]) / np.sqrt(2)
    A = beside(slip) * np.outer(forward, forward.conj()) + beside(2 - slip) * np.outer(
        backward, backward.conj()
    )
    z = R_s + jw * L_ls
    star = motor.nameplate.connection is Connection.STAR
    M = np.zeros((4, 4), complex)  # i_s alpha, beta; i_0 of a delta; i_f
    M[:2, :2] = z * np.eye(2) + A
    M[:2, 3] = -K * mu * (z * n + A @ n_c)
    M[2, 2], M[2, 3] = 1.0, 0.0 if star else -mu / 3
    # mu (z i_x + k n_c . d psi_m) = (r_f + mu R_s + mu lambda jw L_ls) i_f
    M[3, :2] = mu * K * (z * n + n_c @ A)
    M[3, 2] = mu * z
    r_f = path * mu * R_s
    M[3, 3] = -(r_f + mu * R_s + jw * mu * own * L_ls) - mu**2 * K**2 * n_c @ A @ n_c
    found = np.linalg.solve(M, np.array([*(CLARKE @ voltage), 0, 0]))
    return np.asarray(CLARKE.T @ found[:2] + found[2], np.complex128)


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("phase", [0, 1, 2])
def test_terminal_quantities_follow_from_the_flux_equations(connection: Connection, phase: int) -> None:
    motor, slip = rated_motor(7.5, connection=connection), 0.02
    mu, path, kappa, delta = 0.06, 0.7, 0.4, radians(20)
    V1, V2 = 230.0, 5.0 * np.exp(1j)
    terminals = Terminals.of(motor, slip, V1, V2)
    fortescue = np.array([[1, 1, 1], [1, TURN**2, TURN], [1, TURN, TURN**2]])
    windings_V = fortescue @ np.array([0, terminals.voltage.positive, terminals.voltage.negative])
    lines = [
        np.linalg.solve(fortescue, current - np.roll(current, 1) if terminals.delta else current)
        for current in (
            by_fluxes(motor, slip, windings_V, phase=phase, mu=level, path=path, kappa=kappa, delta=delta)
            for level in (mu, 1e-12)
        )
    ]
    change = terminals.change(phase, mu / (1 + path), psi_of(kappa, mu, path), delta, 1 / 0.9598)
    assert change == pytest.approx((lines[0] - lines[1])[1:], rel=1e-6)


@pytest.mark.parametrize("case", [WINDINGS[0], WINDINGS[6]], ids=lambda case: case.name)
def test_all_coils_come_near_the_equations_of_two_numbers(case: Case) -> None:
    found = fits(case, quick=True)
    large = [one for one in found if one.share >= 0.3]
    assert all(0.6 < one.c < 2.0 for one in large)
    assert max(max(one.misfits) for one in found) < 0.09
    assert max(abs(one.axis_off) for one in found) < 3
    assert max(max(one.on_axis) for one in found) > 0.5


def test_a_motor_with_all_its_coils_is_followed_to_phase_and_axis() -> None:
    found = followed(Trial(700_900, 160.0, USUAL, 0.02))
    assert found.case.fault is not None
    for told in (found.without, found.given):
        assert told.kinds == (Kind.SHORTED_TURNS,)
        assert told.phase == "abc"[found.case.fault.phase]
        assert told.level == pytest.approx(found.case.equivalent_level, rel=0.5)
    assert found.without.axis_deg is None
    assert found.given.axis_deg == pytest.approx(degrees(found.case.axis_rad))


def test_records_of_one_motor_have_its_channels_and_noise_of_their_own() -> None:
    case = drawn_case(5, level=None, power_kW=7.5, sensors=USUAL)
    one, other = (replace(case, record=k) for k in (0, 1))
    assert (one.measured_phasors().line_current == other.measured_phasors().line_current).all()
    assert (one.steady_recording().samples != other.steady_recording().samples).any()
