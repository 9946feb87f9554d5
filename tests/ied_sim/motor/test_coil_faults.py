"""Shorted turns inside one coil: totals, limits, symmetry, balance of power, an independent integrator."""

from dataclasses import replace
from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import null_space

from core.machines.parameters import Connection, Motor, WoundRotor
from ied_sim.motor.coils import Coils, coils_of
from ied_sim.motor.fault import NEGLIGIBLE_LEVEL_IN_COIL, FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.supply import Supply
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.phase_circuits import running
from testing.machines.rated_motors import rated_motor
from testing.machines.slot_faults import CoilFault, SteadyCoils, sequences_of
from tests.ied_sim.motor.plants import plant

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LAP = SlotWinding("lap", 36, 2, 8)
CONCENTRIC = SlotWinding("concentric", 36, 1)
BRANCHED = SlotWinding("lap", 36, 2, 8, branches=2)
RINGS = replace(rated_motor(160), wound_rotor=WoundRotor(240.0, 98.0))
TURN = np.exp(2j * pi / 3)
INNER = CoilFault(phase=1, coil=3, share=0.4, path_ratio=0.3)


def wound(motor: Motor, winding: SlotWinding, fault: CoilFault, *, supply: Supply, load: Load) -> MotorPlant:
    """A simulated motor with a fault in a coil."""
    turns = fault.of(motor, winding)
    course = FaultCourse(
        turns.phase, ((0.0, turns.turns),), turns.resistance_ohm, 0.0, turns.coil, turns.branches
    )
    return replace(plant(motor, supply=supply, load=load, fault=course), winding=winding)


def supply_of(motor: Motor, sequence: str = "abc") -> Supply:
    return Supply(
        motor.nameplate.rated_voltage_V,
        50.0,
        unbalance=0.02,
        unbalance_angle_rad=0.7,
        sequence="abc" if sequence == "abc" else "acb",
    )


def phasors(currents: Array, sample_rate_hz: float) -> Complex:
    """Fundamental rms phasors of whole cycles of 50 Hz, over the last axis."""
    samples = currents.shape[-1]
    turn = np.exp(-2j * pi * 50.0 * np.arange(samples) / sample_rate_hz)
    return np.asarray(sqrt(2) / samples * currents @ turn, np.complex128)


@pytest.mark.parametrize("motor", [REFERENCE, LARGE, rated_motor(160), rated_motor(1200)], ids=str)
@pytest.mark.parametrize("winding", [LAP, CONCENTRIC, BRANCHED, SlotWinding("lap", 48, 2, 10)])
def test_coils_have_the_totals_of_the_parameters(motor: Motor, winding: SlotWinding) -> None:
    coils, machine = coils_of(motor, winding), motor.parameters
    phases = (coils.of_phase[:, None] == np.arange(3)) / coils.branches
    other_H, other_ohm = coils.quasi_static(phases)
    leakage = coils.leakage_inductance(phases) + other_H
    resistance = coils.resistance_ohm * phases.T @ phases + other_ohm
    # Of a current that sums to nothing.
    assert leakage[0, 0] - leakage[0, 1] == pytest.approx(machine.stator_leakage_H, rel=1e-12)
    assert resistance[0, 0] - resistance[0, 1] == pytest.approx(machine.stator_resistance_ohm, rel=1e-12)
    assert coils.fields[0] @ phases == pytest.approx(TURN ** np.arange(3), abs=1e-12)


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
def test_a_healthy_motor_is_the_same_with_and_without_its_slots(motor: Motor) -> None:
    without = plant(motor).operation(0.0, 0.02, 10_000)
    with_slots = replace(plant(motor), winding=LAP).operation(0.0, 0.02, 10_000)
    assert np.array_equal(without.currents_A, with_slots.currents_A)
    steady = SteadyCoils.of(motor, LAP, quasi_static=True).running(0.5, unbalance=0.02)
    expected = running(motor, 0.5, unbalance=0.02)
    assert steady.line_current == pytest.approx(expected.line_current, rel=1e-9)
    assert steady.slip == pytest.approx(expected.slip, rel=1e-9)


@pytest.mark.parametrize("winding", [LAP, CONCENTRIC, BRANCHED], ids=["lap", "concentric", "branches"])
@pytest.mark.parametrize("fault", [replace(INNER, share=1e-6), replace(INNER, path_ratio=1e6)])
def test_few_turns_and_a_path_of_great_resistance_leave_the_motor_healthy(
    winding: SlotWinding, fault: CoilFault
) -> None:
    healthy = SteadyCoils.of(MEDIUM, winding).running(0.5).line_current
    faulted = SteadyCoils.of(MEDIUM, winding, fault).running(0.5).line_current
    assert 0 < np.abs(faulted - healthy).max() < 1e-5 * np.abs(healthy).max()


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("winding", [LAP, CONCENTRIC, BRANCHED], ids=["lap", "concentric", "branches"])
def test_the_same_fault_in_the_next_phase_turns_the_negative_sequence_by_120_degrees(
    motor: Motor, winding: SlotWinding
) -> None:
    healthy = sequences_of(SteadyCoils.of(motor, winding).running(0.5).line_current)
    changes = [
        sequences_of(SteadyCoils.of(motor, winding, replace(INNER, phase=phase)).running(0.5).line_current)
        - healthy
        for phase in range(3)
    ]
    for phase in (1, 2):
        assert changes[phase][1] == pytest.approx(changes[0][1], rel=1e-9)
        assert changes[phase][2] == pytest.approx(changes[0][2] * TURN**phase, rel=1e-9)


def test_a_supply_that_turns_the_other_way_sees_the_axes_mirrored() -> None:
    """Coil 1 of phase a with a-c-b is coil 3 with a-b-c, b and c exchanged."""
    forward = SteadyCoils.of(MEDIUM, LAP, CoilFault(0, 3, 0.4)).running(0.5, unbalance=0.01)
    backward = SteadyCoils.of(MEDIUM, LAP, CoilFault(0, 1, 0.4)).running(0.5, unbalance=0.01, reverse=True)
    # Top and bottom layer are exchanged as well, which leaves a little.
    assert backward.line_current == pytest.approx(forward.line_current[[0, 2, 1]], rel=0.03)
    middle = CoilFault(0, 2, 0.4)
    forward = SteadyCoils.of(MEDIUM, CONCENTRIC, middle).running(0.5, unbalance=0.01)
    backward = SteadyCoils.of(MEDIUM, CONCENTRIC, middle).running(0.5, unbalance=0.01, reverse=True)
    assert backward.line_current == pytest.approx(forward.line_current[[0, 2, 1]], rel=1e-9)


@pytest.mark.parametrize("winding", [LAP, BRANCHED, CONCENTRIC], ids=["lap", "branches", "concentric"])
def test_a_whole_coil_that_is_dead_shorted_has_no_voltage(winding: SlotWinding) -> None:
    whole = SteadyCoils.of(MEDIUM, winding, CoilFault(1, 3, 1.0))
    operation = whole.running(0.5)
    _, loop = whole.currents(operation.phase_voltage, operation.slip)
    coils = whole.coils
    currents = whole.loops.turns @ loop
    voltages = _coil_impedance(coils, operation.slip) @ currents
    shorted = coils.coil(1, 3)
    assert abs(voltages[shorted]) < 1e-9 * np.abs(voltages).max()
    assert abs(currents[shorted]) > 2 * np.abs(np.delete(currents, shorted)).max()


def _coil_impedance(coils: Coils, slip: float) -> Complex:
    """Impedance of all coils, order by order and wave by wave, with rotor currents solved for [ohm]."""
    w, L_s, p = coils.angular_frequency, coils.field_inductance_H, coils.orders[0]
    Z = coils.resistance_ohm * np.eye(len(coils.of_phase)) + 1j * w * coils.leakage
    for v, field, coupling, inductance, resistance in zip(
        coils.orders,
        coils.fields,
        coils.rotor.coupling,
        coils.rotor.inductance,
        coils.rotor.resistance,
        strict=True,
    ):
        for wave, direction in ((field, 1), (field.conj(), -1)):
            s = 1 - direction * v / p * (1 - slip)
            # Per ampere-turn of the wave: the rotor's current, and the voltage that both induce.
            rotor = -1j * s * w * sqrt(coupling) / (resistance + 1j * s * w * inductance)
            Z = Z + 0.5j * w * (L_s + sqrt(coupling) * rotor) * np.outer(wave.conj(), wave)
    return np.asarray(Z, np.complex128)


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("winding", [LAP, BRANCHED, CONCENTRIC], ids=["lap", "branches", "concentric"])
def test_power_that_goes_in_is_lost_or_crosses_the_air_gap(motor: Motor, winding: SlotWinding) -> None:
    faulted = SteadyCoils.of(motor, winding, INNER)
    operation = faulted.running(0.7, unbalance=0.02)
    _, loop = faulted.currents(operation.phase_voltage, operation.slip)
    coils, s, p = faulted.coils, operation.slip, motor.nameplate.pole_pairs
    turns = INNER.of(motor, winding)
    current = faulted.loops.current @ loop
    i_f, share, shorted = loop[-1], INNER.share, coils.coil(INNER.phase, INNER.coil)
    copper = coils.resistance_ohm * (
        np.sum(np.abs(np.delete(current, shorted)) ** 2)
        + (1 - share) * abs(current[shorted]) ** 2
        + share * abs(current[shorted] - i_f) ** 2
    )
    path = turns.resistance_ohm * abs(i_f) ** 2
    coil_currents = faulted.loops.turns @ loop
    others = coils.harmonic_impedance(s, np.eye(len(coils.of_phase)))
    into_others = (coil_currents.conj() @ others @ coil_currents).real
    # The main field's rotor: the loss of each wave in the resistance, and what it pulls, by its current.
    rotor_loss = torque = 0.0
    for wave, direction, slip in ((coils.fields[0], 1, s), (coils.fields[0].conj(), -1, 2 - s)):
        jsw = 1j * slip * coils.angular_frequency
        rotor = (
            -jsw * coils.field_inductance_H / (coils.rotor.resistance[0] + jsw * coils.rotor.inductance[0])
        )
        loss = 0.5 * coils.rotor.resistance[0] * abs(rotor * (wave @ coil_currents)) ** 2
        rotor_loss += loss
        torque += direction * loss / slip * p / coils.angular_frequency
    shaft = torque * (1 - s) * coils.angular_frequency / p
    taken = (operation.phase_voltage @ operation.line_current.conj()).real
    assert taken == pytest.approx(copper + path + into_others + rotor_loss + shaft, rel=1e-10)
    assert torque == pytest.approx(0.7 * motor.nameplate.rated_torque_Nm, rel=1e-9)
    assert torque == pytest.approx(faulted.torque(loop, s), rel=1e-9)
    assert abs(into_others) < 0.05 * taken


@pytest.mark.parametrize("sequence", ["abc", "acb"])
@pytest.mark.parametrize(
    ("motor", "winding", "fault"),
    [
        (REFERENCE, LAP, CoilFault(0, 1, 0.1)),
        (MEDIUM, LAP, INNER),
        (LARGE, CONCENTRIC, CoilFault(2, 5, 0.6, 0.0)),
        (LARGE, BRANCHED, CoilFault(1, 8, 1.0, 0.5)),
        (rated_motor(160), SlotWinding("lap", 48, 2, 10, branches=4), CoilFault(2, 4, 0.3, 2.0)),
        (RINGS, LAP, CoilFault(0, 1, 0.5)),
    ],
)
def test_steady_coils_and_the_simulation_agree(
    motor: Motor, winding: SlotWinding, fault: CoilFault, sequence: str
) -> None:
    """At great inertia: to 1e-3 of what the fault changes with the same quasi-static harmonics, else 1 %."""
    load = Load(0.6, inertia_kgm2=60 * motor.parameters.inertia_kgm2)
    simulated = wound(motor, winding, fault, supply=supply_of(motor, sequence), load=load)
    settling_s = 2 * simulated.settling_s
    currents = phasors(simulated.operation(0.0, 0.04, 10_000, settling_s=settling_s).currents_A, 10_000)
    unbalance, reverse = 0.02 * np.exp(0.7j), sequence == "acb"
    healthy = SteadyCoils.of(motor, winding).running(0.6, unbalance=unbalance, reverse=reverse)
    for quasi_static, within in ((True, 1e-3), (False, 1e-2)):
        steady = SteadyCoils.of(motor, winding, fault, quasi_static=quasi_static)
        expected = steady.running(0.6, unbalance=unbalance, reverse=reverse).line_current
        change = np.abs(expected - healthy.line_current).max()
        assert np.abs(currents - expected).max() < within * change


@pytest.mark.parametrize("sequence", ["abc", "acb"])
@pytest.mark.parametrize(
    ("motor", "winding", "fault"),
    [
        (REFERENCE, LAP, CoilFault(1, 1, 0.3)),
        (LARGE, CONCENTRIC, CoilFault(0, 2, 0.6, 0.2)),
        (LARGE, BRANCHED, CoilFault(2, 11, 0.5)),
    ],
    ids=["lap star", "concentric delta", "branches delta"],
)
def test_a_start_agrees_with_all_coil_parts_integrated_to_eighth_order(
    motor: Motor, winding: SlotWinding, fault: CoilFault, sequence: str
) -> None:
    """Currents of all coil parts under Kirchhoff's laws, the cage in axes that stand still: 1e-4 in 0.1 s."""
    supply, load = supply_of(motor, sequence), Load(0.5)
    ours = wound(motor, winding, fault, supply=supply, load=load).start_up(0.0, 0.1, 10_000).currents_A
    expected = _all_parts(motor, winding, fault, supply, np.arange(ours.shape[1]) / 10_000)
    assert np.abs(ours - expected).max() < 1e-4 * np.abs(expected).max()


def _all_parts(motor: Motor, winding: SlotWinding, fault: CoilFault, supply: Supply, times: Array) -> Array:
    """Line currents by the fluxes of every coil part and of the rotor in the stator's axes, shape (3, n)."""
    coils, machine, p = coils_of(motor, winding), motor.parameters, motor.nameplate.pole_pairs
    n, shorted = len(coils.of_phase), coils.coil(fault.phase, fault.coil)
    # Parts: all coils, of which the faulted one has 1 - share of its turns, then the rest of that, the path.
    share = np.zeros((n, n + 2))
    share[:, :n] = np.eye(n)
    share[shorted, shorted], share[shorted, n] = 1 - fault.share, fault.share
    other_H, other_ohm = coils.quasi_static(share)
    part_ohm = coils.resistance_ohm * np.diag([*share.sum(axis=0)[: n + 1], 0.0]) + other_ohm
    part_ohm[-1, -1] += fault.of(motor, winding).resistance_ohm
    axes = np.vstack(((coils.fields[0] @ share).real, (coils.fields[0] @ share).imag))
    L_s, L_m = machine.stator_self_inductance_H, machine.magnetising_inductance_H
    stator = coils.leakage_inductance(share) + other_H + L_s * axes.T @ axes
    # A rotor current of one ampere on each of two axes is that of 3/2 phases.
    mutual, rotor = L_m * axes, (L_m + machine.rotor_leakage_H) * np.eye(2)

    laws = _kirchhoff(coils, shorted, motor.nameplate.connection)
    free = null_space(laws)
    k = free.shape[1]
    inductance = np.block([[free.T @ stator @ free, free.T @ mutual.T], [mutual @ free, 1.5 * rotor]])
    lines = _line_currents(coils, motor.nameplate.connection)
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    direction = supply.direction

    def currents(y: Array) -> Array:
        return np.asarray(np.linalg.solve(inductance, y[: k + 2]), np.float64)

    def rhs(t: float, y: Array) -> Array:
        i, w = currents(y), y[k + 2]
        parts, i_r, psi_r = free @ i[:k], i[k:], y[k : k + 2]
        # Power at the terminals: voltages work on line currents, so each free current has theirs.
        around = (lines @ free).T @ supply.phase_voltages(np.array([t]))[:, 0]
        flux = around - free.T @ part_ohm @ parts
        rotor_flux = w * J @ psi_r - 1.5 * machine.rotor_resistance_ohm * i_r
        torque = p * (psi_r[1] * i_r[0] - psi_r[0] * i_r[1])
        load = direction * 0.5 * motor.nameplate.rated_torque_Nm
        return np.concatenate((flux, rotor_flux, [(torque - load) * p / machine.inertia_kgm2]))

    solved = solve_ivp(rhs, (0, times[-1]), np.zeros(k + 3), "DOP853", times, rtol=1e-8, atol=1e-10)
    found = np.array([lines @ (free @ currents(y)[:k]) for y in solved.y.T]).T
    return np.asarray(found, np.float64)


def _kirchhoff(coils: Coils, shorted: int, connection: Connection) -> Array:
    """Laws that the currents of all parts obey, one a row: those of a branch in series, path, star point."""
    n = len(coils.of_phase)
    laws = []
    heads = []
    for phase in range(3):
        for branch in range(coils.branches):
            series = np.flatnonzero((coils.of_phase == phase) & (coils.branch == branch))
            heads.append(series[0])
            for one, other in pairwise(series):
                laws.append(np.eye(n + 2)[one] - np.eye(n + 2)[other])
    laws.append(np.eye(n + 2)[shorted] - np.eye(n + 2)[n] - np.eye(n + 2)[n + 1])
    if connection is Connection.STAR:
        laws.append(np.eye(n + 2)[heads].sum(axis=0))
    return np.array(laws)


def _line_currents(coils: Coils, connection: Connection) -> Array:
    """Line currents by the currents of the parts, shape (3, n + 2)."""
    n = len(coils.of_phase)
    phases = np.zeros((3, n + 2))
    for phase in range(3):
        for branch in range(coils.branches):
            phases[phase, np.flatnonzero((coils.of_phase == phase) & (coils.branch == branch))[0]] = 1.0
    return phases if connection is Connection.STAR else phases - np.roll(phases, 1, axis=0)


def test_a_wound_rotor_damps_no_other_order() -> None:
    caged, open_to_others = (
        coils_of(motor, LAP).quasi_static(np.eye(36))[0] for motor in (rated_motor(160), RINGS)
    )
    assert open_to_others[0, 0] > 3 * caged[0, 0]


def test_a_winding_whose_harmonics_leak_more_than_the_motor_is_refused() -> None:
    low = replace(
        MEDIUM,
        parameters=replace(MEDIUM.parameters, stator_leakage_H=0.2 * MEDIUM.parameters.stator_leakage_H),
    )
    with pytest.raises(ValueError, match="other numbers of poles alone"):
        coils_of(low, SlotWinding("lap", 24))


@pytest.mark.parametrize("motor", [REFERENCE, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("path_ratio", [0.0, 9.0])
def test_the_fewest_turns_of_a_coil_that_count_are_stable(motor: Motor, path_ratio: float) -> None:
    level = 1.01 * NEGLIGIBLE_LEVEL_IN_COIL
    fault = CoilFault(1, 2, 12 * level * (1 + path_ratio), path_ratio)
    simulated = wound(motor, LAP, fault, supply=supply_of(motor), load=Load(0.5))
    assert simulated.fault_at(0.0) is not None
    healthy = plant(motor, supply=supply_of(motor)).operation(0.0, 0.02, 10_000, settling_s=0.3).currents_A
    faulted = simulated.operation(0.0, 0.02, 10_000, settling_s=0.3).currents_A
    assert 0 < np.abs(faulted - healthy).max() < 5e-3 * np.abs(healthy).max()
    fewer = replace(fault, share=0.98 * fault.share)
    assert wound(motor, LAP, fewer, supply=supply_of(motor), load=Load(0.5)).fault_at(0.0) is None


def test_bars_may_be_broken_beside_shorted_turns_of_a_coil() -> None:
    whole = wound(MEDIUM, LAP, INNER, supply=supply_of(MEDIUM), load=Load(0.8))
    broken = replace(whole, broken_bars=1 / 28)
    currents = [one.operation(0.0, 1.0, 2_000).currents_A for one in (whole, broken)]
    # Cycle by cycle: the pole-pass lines make the current swing.
    swings = [np.ptp(np.abs(phasors(one[0].reshape(-1, 40), 2_000))) for one in currents]
    assert swings[1] > 5 * swings[0]
