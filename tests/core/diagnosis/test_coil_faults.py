"""Turns shorted inside one coil, on records of circuits for every coil: phase, axis, and what stays open."""

from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents
from core.machines.parameters import Motor, WoundRotor
from core.machines.stator_winding import StatorWinding, WindingKind
from core.recordings import Recording
from ied_sim.motor.slots import SlotWinding
from testing.machines.phase_circuits import FORTESCUE, Operation, recording
from testing.machines.rated_motors import rated_motor
from testing.machines.slot_fault_records import PRECISE, USUAL, SlotFaultCase, drawn_case
from testing.machines.slot_faults import CoilFault

LAP = SlotWinding("lap", 36, 2, 8)
GIVEN = StatorWinding(WindingKind.LAP, 36, 2, 8)
SMALL = replace(rated_motor(7.5), sensors=PRECISE)
LARGE = replace(rated_motor(160.0), sensors=PRECISE)
SLIP = 0.014
IN_PHASE_B = CoilFault(1, 1, 0.9, 0.5), CoilFault(1, 3, 0.6)
"""5 % of the phase's turns, in the first coil of its group through a path, and in the last one."""


def steady_record(motor: Motor, *, turns: SequencePair | None = None, unknown: complex = 0.0) -> Recording:
    """A record of currents in closed form: of shorted turns, or of an asymmetry that is a share of V1."""
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    gap = air_gap(
        complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H),
        w * machine.magnetising_inductance_H,
        machine.rotor_resistance_ohm,
        w * machine.rotor_leakage_H,
        SLIP,
    )
    volts = SequencePair(motor.nameplate.rated_voltage_V / np.sqrt(3) + 0j, 1.0 + 0j)
    found = SequencePair(
        volts.positive / (gap.stator + gap.forward),
        (volts.negative - unknown * volts.positive) / (gap.stator + gap.backward),
    )
    if turns is not None:
        level, psi = 0.03, 1.0
        branch = complex(gap.stator.real, psi * gap.stator.imag) / level
        found = faulty_currents(gap, volts, branch, turns.positive, turns.negative, 0.0, 0)
    voltage, current = (FORTESCUE @ np.array([0.0, *one]) for one in (volts, found))
    return recording(Operation(current, voltage, SLIP), noise=0.002)


@pytest.mark.parametrize("given", [False, True], ids=["no winding data", "winding given"])
@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
@pytest.mark.parametrize("fault", IN_PHASE_B, ids=["-20 degrees", "+20 degrees"])
def test_a_coil_off_its_phases_axis_has_the_right_phase_level_and_axis(
    fault: CoilFault, reverse: bool, given: bool
) -> None:
    case = SlotFaultCase(
        SMALL, LAP, fault, unbalance=0.008j, sensors=PRECISE, noise=0.002, reverse=reverse, seed=3
    )
    motor = replace(SMALL, winding=GIVEN) if given else SMALL
    found = diagnose(case.steady_recording(), motor)
    assert (found.verdict, found.phase) == (Verdict.FAULT, "b")
    assert found.mu_f == pytest.approx(case.equivalent_level, rel=0.15)
    assert found.mu_f_ci95 is not None
    assert found.mu_f_ci95[0] <= case.equivalent_level <= found.mu_f_ci95[1]
    axis = f"the turns lie in coils of the axis {degrees(case.axis_rad):+.0f} degrees of phase b"
    assert [one for one in found.reasons if "axis" in one and "coils" in one] == ([axis] if given else [])


@pytest.mark.parametrize("seed", range(6))
def test_coils_of_any_motor_are_called_and_never_in_another_phase(seed: int) -> None:
    case = drawn_case(seed, level=0.06, sensors=PRECISE)
    found = diagnose(case.steady_recording(), replace(case.motor, sensors=PRECISE))
    assert case.fault is not None
    assert found.verdict is Verdict.FAULT
    assert found.phase == "abc"[case.fault.phase]


def test_in_the_ambiguous_corner_no_phase_is_named_and_the_likely_ones_are_told() -> None:
    """160 kW, 25 degrees off the axis, all leakage with the turns: the angle is one of phase c too."""
    ahead = complex(np.exp(1j * radians(25.0))) / 0.96
    found = diagnose(steady_record(LARGE, turns=SequencePair(ahead, ahead.conjugate())), LARGE)
    assert (found.verdict, found.phase, found.theta_f) == (Verdict.FAULT, None, None)
    assert found.phase_probabilities is not None
    a, b, c = found.phase_probabilities
    assert min(a, c) > 0.05 > b
    assert a + b + c == pytest.approx(1.0)
    assert found.reasons[0].startswith(f"shorted turns in phase a ({100 * a:.0f} %) or c ({100 * c:.0f} %): ")
    assert not any("coils of the axis" in one for one in found.reasons)


@pytest.mark.parametrize("size", [0.02, 0.04])
@pytest.mark.parametrize("angle_deg", range(0, 360, 40))
def test_an_asymmetry_of_unknown_cause_is_no_fault(angle_deg: int, size: float) -> None:
    motor = replace(SMALL, sensors=USUAL)
    unknown = size * complex(np.exp(1j * radians(angle_deg)))
    assert diagnose(steady_record(motor, unknown=unknown), motor).verdict is Verdict.WATCH


def test_an_asymmetry_that_no_turns_explain_is_told_as_of_unknown_cause() -> None:
    motor = replace(SMALL, sensors=USUAL)
    found = diagnose(steady_record(motor, unknown=0.04 * complex(np.exp(1j * radians(40.0)))), motor)
    assert found.hypotheses[0].cause is Cause.ASYMMETRY
    assert (found.phase, found.theta_f) == (None, None)
    assert "further records at other loads" in found.reasons[0]


@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
def test_slip_rings_name_no_phase_and_say_why(reverse: bool) -> None:
    case = SlotFaultCase(LARGE, LAP, CoilFault(1, 3, 0.9), noise=0.002, reverse=reverse, seed=3)
    motor = replace(LARGE, winding=GIVEN, wound_rotor=WoundRotor(400.0, 250.0))
    found = diagnose(case.steady_recording(), motor)
    assert found.verdict in {Verdict.FAULT, Verdict.WATCH}
    assert found.hypotheses[0].cause is Cause.SHORTED_TURNS
    assert (found.phase, found.theta_f, found.phase_probabilities) == (None, None, None)
    assert "in phase" not in found.reasons[0]
    (why,) = [one for one in found.reasons if one.startswith("the phase is not named: a wound rotor")]
    assert "does not damp the harmonics of single coils" in why
    assert not any("coils of the axis" in one for one in found.reasons)
