"""Turns bridged by a resistance, on records of independent phase circuits: phase, level, load, verdict."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.accuracy.resistive_paths import GOOD, LOADS, PathDraw, judge_path
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.machines.parameters import Motor
from testing.machines.motors import ALL, LARGE, REFERENCE, VERY_LARGE
from testing.machines.phase_circuits import FORTESCUE, Fault, recording, running

IDS = [motor.name for motor in ALL]
GAINS = (1.005, 0.995, 1.003)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
@pytest.mark.parametrize(
    ("turns", "ratio", "load", "unbalance"),
    [(0.12, 2.0, 0.05, 0.03), (0.11, 2.0, 0.3, 0.03j), (0.10, 1.0, 0.15, 0.0), (0.06, 0.5, 0.9, -0.03)],
)
def test_a_path_is_no_dead_short_with_a_long_offset(
    motor: Motor, reverse: bool, turns: float, ratio: float, load: float, unbalance: complex
) -> None:
    path = Fault(turns, 1, ratio * turns * motor.parameters.stator_resistance_ohm)
    truth = running(motor, load, fault=path, unbalance=unbalance, reverse=reverse)
    record = recording(truth, noise=0.002, current_delay_s=30e-6, current_gains=GAINS)
    result = diagnose(record, motor)
    # At full load a joint in another phase comes nearest to the turns of the smallest motor.
    is_close = motor is REFERENCE and load > 0.5
    assert result.verdict in ({Verdict.FAULT, Verdict.WATCH} if is_close else {Verdict.FAULT})
    assert result.reasons[0].startswith("shorted turns in phase b")
    assert result.phase == "b"
    level = turns / (1.0 + ratio)
    assert result.mu_f is not None
    assert result.mu_f_ci95 is not None
    assert result.mu_f_ci95[0] <= level <= result.mu_f_ci95[1] or result.mu_f == pytest.approx(level, rel=0.1)
    # The loss in a path is no load, but path and leakage are not told apart.
    assert result.load_level == pytest.approx(load, abs=0.1)
    assert result.load_level_ci95 is not None
    assert result.load_level_ci95[0] <= load <= result.load_level_ci95[1]
    assert result.time_offset_s == pytest.approx(30e-6, abs=200e-6)


def test_the_interval_covers_paths_and_dead_shorts_where_both_hold() -> None:
    """A path of a quarter turns the current less than a voltage channel within its class may."""
    level = 0.05 / 1.25
    path = Fault(0.05, 2, 0.25 * 0.05 * REFERENCE.parameters.stator_resistance_ohm)
    dead = Fault(level, 2)
    for fault in (path, dead):
        result = diagnose(recording(running(REFERENCE, 0.5, fault=fault), noise=0.002), REFERENCE)
        assert result.mu_f_ci95 is not None
        assert result.mu_f_ci95[0] <= level <= result.mu_f_ci95[1]
        assert result.mu_f_ci95[1] - result.mu_f_ci95[0] > 0.1 * level


@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 2.0])
def test_phase_verdict_and_interval_hold_where_the_leakage_limits_the_current(ratio: float) -> None:
    """A path hardly changes the current there, so the level alone says little."""
    turns = 0.08
    path = Fault(turns, 1, ratio * turns * VERY_LARGE.parameters.stator_resistance_ohm)
    truth = running(VERY_LARGE, 0.6, fault=path, unbalance=0.02j)
    result = diagnose(recording(truth, noise=0.002, current_delay_s=30e-6, current_gains=GAINS), VERY_LARGE)
    level = turns / (1.0 + ratio)
    assert result.verdict is Verdict.FAULT
    assert result.phase == "b"
    assert result.load_level == pytest.approx(0.6, abs=0.1)
    assert result.mu_f_ci95 is not None
    low, high = result.mu_f_ci95
    assert low <= level <= high
    assert high - low > 0.4 * level


@pytest.mark.parametrize(
    ("motor", "share"), [(REFERENCE, 0.675), (VERY_LARGE, 0.985)], ids=["0.8 kW", "250 kW"]
)
def test_the_current_of_bridged_turns_goes_with_the_impedance_of_their_loop(
    motor: Motor, share: float
) -> None:
    """The page on the diagnosis gives |R_s + j X_ls| / |R_s (1 + p) + j X_ls|, and these shares for p = 1."""
    turns = 0.002
    found = []
    for path_ohm in (0.0, turns * motor.parameters.stator_resistance_ohm):
        truth = running(motor, 0.5, fault=Fault(turns, 0, path_ohm))
        found.append(abs((np.linalg.inv(FORTESCUE) @ truth.line_current)[2]))
    assert found[1] / found[0] == pytest.approx(share, abs=0.01)


def test_dead_shorted_turns_stay_dead_shorted_with_parameters_off() -> None:
    """Warm windings and a wrong inductance are no path: level and load stay near."""
    machine = LARGE.parameters
    warm = replace(
        LARGE,
        parameters=replace(
            machine,
            stator_resistance_ohm=1.08 * machine.stator_resistance_ohm,
            rotor_resistance_ohm=1.08 * machine.rotor_resistance_ohm,
            stator_self_inductance_H=0.93 * machine.stator_self_inductance_H,
        ),
    )
    truth = running(warm, 0.4, fault=Fault(0.08, 0), unbalance=0.02)
    result = diagnose(recording(truth, noise=0.002), LARGE)
    assert result.verdict is Verdict.FAULT
    assert result.phase == "a"
    assert result.mu_f == pytest.approx(0.08, rel=0.1)
    assert result.load_level == pytest.approx(0.4, abs=0.05)


@pytest.mark.parametrize("angle_deg", range(0, 360, 60))
def test_the_load_of_a_path_is_never_far_below_zero(angle_deg: int) -> None:
    unbalance = 0.03 * np.exp(1j * np.radians(angle_deg))
    fault = Fault(0.12, 0, 2.0 * 0.12 * REFERENCE.parameters.stator_resistance_ohm)
    truth = running(REFERENCE, 0.05, fault=fault, unbalance=complex(unbalance))
    result = diagnose(recording(truth, noise=0.002, current_gains=GAINS), REFERENCE)
    assert result.verdict is Verdict.FAULT
    assert result.load_level == pytest.approx(0.05, abs=0.07)


@pytest.mark.campaign
@pytest.mark.parametrize("loads", LOADS)
@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 2.0])
def test_windings_integrated_in_time_tell_the_same(ratio: float, loads: tuple[float, float]) -> None:
    """Other records than those of the accuracy page, with the ripple of the speed."""
    outcomes = [judge_path(PathDraw(ratio, loads, GOOD, index)) for index in range(1_000, 1_006)]
    assert [one.condition for one in outcomes if not one.right] == []
