"""The benchmark's own machine against the core's models and against circuits in phase variables."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from benchmarks.condition.circuit import BACKWARD, FORWARD, Shorted, Windings, running
from core.machines.candidates import Candidates
from core.machines.parameters import Connection, Motor
from core.machines.running import SteadyRunning
from core.machines.split_winding import SplitWinding
from core.machines.winding_frame import to_winding_frame
from core.signals.sequence import PhaseSequence
from testing.machines import phase_circuits
from testing.machines.motors import LARGE, MEDIUM, REFERENCE, VERY_LARGE

HEAVY = 1e4
"""Times the inertia: the speed stays constant, as the benchmark takes it."""
Complex = NDArray[np.complex128]


def windings_of(motor: Motor) -> Windings:
    machine = motor.parameters
    return Windings(
        np.array([machine.stator_resistance_ohm]),
        np.array([machine.rotor_resistance_ohm]),
        np.array([machine.stator_leakage_H]),
        np.array([machine.rotor_leakage_H]),
        np.array([machine.magnetising_inductance_H]),
        np.ones((1, 3)),
        np.zeros((1, 3), dtype=np.complex128),
        np.ones(1),
        np.ones(1),
    )


def line_currents(
    motor: Motor,
    load: float,
    unbalance: complex,
    fault: tuple[float, float, int] | None = None,
    joint: tuple[int, float] | None = None,
) -> tuple[Complex, float]:
    nameplate = motor.nameplate
    volts = np.sqrt(2 / 3) * nameplate.rated_voltage_V
    lines = np.zeros((1, 3))
    if joint is not None:
        lines[0, joint[0]] = joint[1]
    found = running(
        windings_of(motor),
        volts * (FORWARD + unbalance * BACKWARD)[np.newaxis],
        np.array([nameplate.rated_angular_frequency]),
        np.array([load * nameplate.rated_torque_Nm]),
        pole_pairs=nameplate.pole_pairs,
        delta=nameplate.connection is Connection.DELTA,
        shorted=None if fault is None else Shorted(np.array([fault[0]]), np.array([fault[1]]), fault[2]),
        line_resistance_ohm=lines,
    )
    return found.line_current_A[0], float(found.slip[0])


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE, VERY_LARGE], ids=lambda one: one.name)
@pytest.mark.parametrize("fault", [None, (0.02, 0.0, 1), (0.08, 3.0, 2), (0.01, 1.0, 0)])
@pytest.mark.parametrize("unbalance", [0.0, 0.03 * np.exp(1.1j)])
def test_currents_are_those_of_the_models_of_the_core(
    motor: Motor, fault: tuple[float, float, int] | None, unbalance: complex
) -> None:
    found, slip = line_currents(motor, 0.6, unbalance, fault)

    nameplate = motor.nameplate
    heavy = replace(
        motor, parameters=replace(motor.parameters, inertia_kgm2=HEAVY * motor.parameters.inertia_kgm2)
    )
    voltage = nameplate.rated_voltage_V * np.array([1.0 + unbalance, -1j * (1.0 - unbalance)])
    # A phasor turns into windings as samples do: real and imaginary part one after the other.
    sampled = np.stack([voltage.real, voltage.imag], axis=1)
    _, turned = to_winding_frame(sampled, sampled, PhaseSequence.ABC, nameplate.connection)
    model = SteadyRunning(
        SplitWinding(), heavy, nameplate.rated_angular_frequency, turned[:, 0] + 1j * turned[:, 1]
    )
    turns, path, winding = fault or (0.0, 0.0, 0)
    state = model.state(
        Candidates(
            fault_level=np.array([turns / (1.0 + path)]),
            winding=np.array([winding]),
            load_level=np.array([0.6]),
            time_offset_s=np.zeros(1),
            leakage=np.array([1.0 / (1.0 + path)]),
        )
    )
    lines = np.stack([found.real, found.imag], axis=1)
    axes = np.sqrt(2 / 3) * np.array([[1, -0.5, -0.5], [0, np.sqrt(3) / 2, -np.sqrt(3) / 2]]) @ lines
    ours, _ = to_winding_frame(axes, axes, PhaseSequence.ABC, nameplate.connection)

    np.testing.assert_allclose(
        ours[:, 0] + 1j * ours[:, 1], state.current[:, 0], rtol=2e-4, atol=2e-4 * np.abs(found).max()
    )
    assert slip == pytest.approx(1.0 - state.mean_speed[0] / nameplate.rated_angular_frequency, rel=1e-3)


# The circuits in phase variables have a joint inside the delta, the benchmark in its line: star alone.
@pytest.mark.parametrize(
    ("motor", "joint"),
    [(REFERENCE, None), (REFERENCE, (1, 0.4)), (LARGE, None)],
    ids=["star", "star with a joint", "delta"],
)
def test_currents_are_those_of_circuits_in_phase_variables(
    motor: Motor, joint: tuple[int, float] | None
) -> None:
    turns, path, winding = 0.03, 2.0, 2
    fault = phase_circuits.Fault(turns, winding, path * turns * motor.parameters.stator_resistance_ohm)
    expected = phase_circuits.running(motor, 0.7, fault=fault, unbalance=0.02j, joint=joint)

    found, slip = line_currents(motor, 0.7, 0.02j, (turns, path, winding), joint)

    np.testing.assert_allclose(found / np.sqrt(2), expected.line_current, rtol=1e-9)
    assert slip == pytest.approx(expected.slip, rel=1e-9)


def test_a_joint_in_every_line_of_a_delta_is_resistance_in_every_winding() -> None:
    ohm = 0.05
    plain, _ = line_currents(LARGE, 0.5, 0.01)
    machine = LARGE.parameters
    with_joints = replace(machine, stator_resistance_ohm=machine.stator_resistance_ohm + 3 * ohm)
    thinner = replace(LARGE, parameters=with_joints)
    expected, _ = line_currents(thinner, 0.5, 0.01)

    nameplate = LARGE.nameplate
    volts = np.sqrt(2 / 3) * nameplate.rated_voltage_V
    found = running(
        windings_of(LARGE),
        volts * (FORWARD + 0.01 * BACKWARD)[np.newaxis],
        np.array([nameplate.rated_angular_frequency]),
        np.array([0.5 * nameplate.rated_torque_Nm]),
        pole_pairs=nameplate.pole_pairs,
        delta=True,
        line_resistance_ohm=np.full((1, 3), ohm),
    )

    np.testing.assert_allclose(found.line_current_A[0], expected, rtol=1e-9)
    assert not np.allclose(found.line_current_A[0], plain, rtol=1e-3)
