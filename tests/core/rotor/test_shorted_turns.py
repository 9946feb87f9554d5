"""A rotor beside shorted turns: their current comes off, and what is left is the rotor's."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from core.diagnosis.acceptance import accept
from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose_accepted
from core.diagnosis.verdict import FittedParameters, Verdict
from core.findings.examining import examine
from core.machines.candidates import Candidates
from core.machines.parameters import Connection, Motor
from core.machines.split_winding import SplitWinding
from core.rotor.baseband import Baseband, baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorState
from core.rotor.shorted_turns import without_shorted_turns
from testing.machines.cause_records import CauseCase
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.rotor_records import RotorCase

SEED = 1
ONE_BAR_DB = RotorCase(MEDIUM, broken_share=1.0 / 28.0).asymmetry_dB
WITHIN_DB = 1.5
"""The level of the turns is known within a tenth, and that is as much of their loss."""


@pytest.mark.parametrize("connection", Connection)
@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize(
    ("leakage", "axis_rad", "linkage"), [(0.8, 0.0, 1.0), (0.6, 0.35, 1.04), (0.3, -0.44, 1.05)]
)
def test_what_is_left_is_the_current_of_the_machine_without_them(
    connection: Connection, winding: int, leakage: float, axis_rad: float, linkage: float
) -> None:
    """Solved here at one speed, of the split winding's five circuits with the turns and without."""
    motor = replace(MEDIUM, nameplate=replace(MEDIUM.nameplate, connection=connection))
    w_s, slip, volts = 2.0 * pi * 50.0, 0.02, 400.0

    def drawn(level: float) -> complex:
        one = np.ones(1)
        circuits = SplitWinding().circuits(
            motor,
            Candidates(
                level * one, np.array([winding]), one, 0.0 * one,
                leakage=leakage * one, axis_rad=axis_rad * one, linkage=linkage * one,
            ),
        )  # fmt: skip
        L, R = circuits.inductance[0], circuits.resistance[0]
        turning = np.zeros((5, 5))
        turning[2, 3], turning[3, 2] = -(1.0 - slip) * w_s, (1.0 - slip) * w_s
        impedance = R + 1j * w_s * L - turning @ L
        current = np.linalg.solve(impedance, volts * np.array([1.0, -1j, 0.0, 0.0, 0.0]))
        return complex(current[0] + 1j * current[1]) / 2.0

    with_turns, sound = drawn(0.05), drawn(0.0)
    turns = FittedParameters(0.05, 0, 0.5, 0.0, leakage, axis_rad, linkage)
    found = without_shorted_turns(_steady(volts, with_turns, w_s), motor, turns)
    assert abs(with_turns - sound) > 0.1 * abs(sound)
    assert found.current == pytest.approx(np.full(8, sound), rel=1e-9 if axis_rad == 0.0 else 1e-5)


def test_no_turns_take_nothing_off() -> None:
    record = _steady(400.0, 10.0 - 5.0j, 2.0 * pi * 50.0)
    none = FittedParameters(0.0, 0, 0.5, 0.0, 1.0, 0.0, 1.0)
    assert without_shorted_turns(record, MEDIUM, none) is record


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM], ids=lambda motor: motor.name)
def test_a_broken_bar_is_found_beside_shorted_turns_at_low_load(motor: Motor) -> None:
    case = CauseCase(motor, frozenset({Cause.ROTOR, Cause.SHORTED_TURNS}), 0.4, SEED)
    examined = examine(case.record(), case.known())
    assert examined.diagnosis.phase == "b"
    assert examined.rotor is not None
    assert examined.rotor.state is RotorState.FAULT
    assert examined.rotor.severity_dB == pytest.approx(ONE_BAR_DB, abs=WITHIN_DB)
    assert examined.rotor.severity_dB_ci95 is not None
    low, high = examined.rotor.severity_dB_ci95
    assert low < ONE_BAR_DB < high


def test_shorted_turns_alone_make_no_uneven_rotor() -> None:
    case = CauseCase(MEDIUM, frozenset({Cause.SHORTED_TURNS}), 0.4, SEED)
    examined = examine(case.record(), case.known())
    assert examined.rotor is not None
    assert examined.rotor.state is RotorState.HEALTHY


def test_turns_that_cannot_be_excluded_take_nothing_off() -> None:
    """They would take a part of the load with them, and a broken cage would look worse than it is."""
    case = RotorCase(LARGE, 0.5, broken_share=3.0 / 28.0)
    acceptance = accept(case.record(5.0), LARGE)
    accepted, diagnosis = acceptance.accepted, diagnose_accepted(acceptance)
    assert accepted is not None
    assert diagnosis.fit is not None
    suspected = replace(
        diagnosis,
        verdict=Verdict.WATCH,
        theta_f=1,
        mu_f_ci95=(0.003, 0.012),
        fit=replace(diagnosis.fit, mu_f=0.007, leakage=1.0 / 6.0),
    )
    found = examine_rotor(baseband_of(accepted), accepted, suspected)
    assert found.severity_dB == pytest.approx(case.asymmetry_dB, abs=1.0)


def _steady(volts: float, current: complex, w_s: float) -> Baseband:
    points = np.arange(8)
    return Baseband(
        time_s=points / 200.0,
        angular_frequency=np.full(8, w_s),
        voltage=np.full(8, volts + 0j),
        current=np.full(8, current),
        cycle_s=2.0 * pi / w_s,
        is_whole=True,
        spikes=0,
    )
