"""Broken bars: sidebands at (1 - 2 s) f and (1 + 2 s) f, against phasors of two frequencies and DOP853."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.broken_bars import BrokenBars
from core.machines.healthy import HealthyMachine
from core.machines.parameters import Motor
from core.machines.playback import Beginning, Playback, Trajectories, Window
from testing.machines.motors import MEDIUM, REFERENCE
from testing.machines.page_equations import axis_resistance_growth
from tests.core.machines import reference_values as reference
from tests.core.machines.test_accuracy import MARGIN, feed, one_candidate

Array = NDArray[np.float64]
RATE, W_S = reference.RATE_HZ, reference.W_S
SHARE = reference.BROKEN_SHARE


def ten_seconds(motor: Motor, beginning: Beginning = Beginning.STEADY_STATE) -> Trajectories:
    samples = reference.BROKEN_SAMPLES
    volts = feed(motor, RATE, samples, negative=0.0, fifth=0.0)
    window = Window(MARGIN, MARGIN + samples, MARGIN + 1)
    return Playback(BrokenBars(), motor, volts, window, beginning=beginning).trajectories(
        one_candidate(SHARE)
    )


def lines(vector: NDArray[np.complex128], t: Array, mean_speed: float) -> NDArray[np.complex128]:
    """Space-vector amplitudes at f, (1 - 2 s) f, (1 + 2 s) f by least squares."""
    slip_speed = W_S - mean_speed
    turning = np.exp(1j * np.outer(t, W_S + np.array([0.0, -2.0, 2.0, -4.0, 4.0]) * slip_speed))
    return np.asarray(np.linalg.lstsq(turning, vector)[0][:3], dtype=np.complex128)


def lower_sideband(motor: Motor, w: float) -> tuple[float, float]:
    """Lengths of i_s at f and at (1 - 2 s) f at constant speed w, from

    j w_1 psi_s = V - R_s i_s,   j (w_1 - w) psi_r = -R_m i_r - R_a conj(i_r2),   w_1 = w_s
    j w_2 psi_s = -R_s i_s2,     j (w_2 - w) psi_r = -R_m i_r2 - R_a conj(i_r),   w_2 = 2 w - w_s
    """
    p = motor.parameters
    L_m = p.magnetising_inductance_H
    L = np.array([[p.stator_leakage_H + L_m, L_m], [L_m, p.rotor_leakage_H + L_m]])
    growth = axis_resistance_growth(SHARE)
    mean, turning = p.rotor_resistance_ohm * (1 + growth / 2), p.rotor_resistance_ohm * growth / 2
    M = np.zeros((4, 4), dtype=np.complex128)
    for rows, sign, w_1 in ((slice(0, 2), 1j, W_S), (slice(2, 4), -1j, 2 * w - W_S)):
        M[rows, rows] = sign * np.diag([w_1, w_1 - w]) @ L + np.diag([p.stator_resistance_ohm, mean])
    M[1, 3] = M[3, 1] = turning
    current = np.abs(np.linalg.solve(M, [reference.winding_voltage(motor), 0, 0, 0]))
    return float(current[0]), float(current[2])


@pytest.mark.campaign
@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM], ids=lambda motor: motor.name)
def test_the_lower_sideband_is_that_of_theory_at_constant_speed(motor: Motor) -> None:
    heavy = replace(motor, parameters=replace(motor.parameters, inertia_kgm2=1e4))
    track = ten_seconds(heavy)
    half = track.speed.shape[1] // 2
    mean_speed = float(track.speed[0, half:].mean())
    t = np.arange(half, track.speed.shape[1]) / RATE
    found = np.abs(lines(track.current[0, 0, half:] + 1j * track.current[0, 1, half:], t, mean_speed))
    fundamental, lower = lower_sideband(heavy, mean_speed)
    assert lower / fundamental > 0.02
    assert found[0] == pytest.approx(fundamental, rel=1e-4)
    assert found[1] == pytest.approx(lower, rel=2e-3)
    assert found[2] < 1e-3 * lower


@pytest.mark.parametrize("motor", reference.BROKEN_BARS, ids=lambda motor: motor.name)
def test_both_sidebands_agree_with_dop853(motor: Motor) -> None:
    """10 s from rest with the machine's own inertia: waveform and spectrum of the last 5 s."""
    with np.load(reference.FILE) as file:
        expected = file[f"broken-bars {motor.name}"]
    track = ten_seconds(motor, Beginning.REST)
    current, speed = track.current[0][:, reference.BROKEN], track.speed[0, reference.BROKEN]
    t, mean_speed = reference.BROKEN / RATE, float(expected[2].mean())
    found = lines(current[0] + 1j * current[1], t, mean_speed)
    truth = lines(expected[0] + 1j * expected[1], t, mean_speed)
    assert np.abs(truth[1:] / truth[0]).min() > 0.005
    assert np.abs(found) == pytest.approx(np.abs(truth), rel=5e-4)
    assert np.abs(speed / expected[2] - 1.0).max() < 1e-4
    # A millionth in speed is a hundredth of a radian of the rotor's angle after these ten seconds.
    assert np.sqrt(np.mean((current - expected[:2]) ** 2) / np.mean(expected[:2] ** 2)) < 2e-4


def test_no_broken_bar_is_the_healthy_machine() -> None:
    samples = 3_000
    volts = feed(REFERENCE, RATE, samples, negative=0.02, fifth=0.02)
    window = Window(MARGIN, MARGIN + samples, MARGIN + 200)
    measured = np.random.default_rng(0).standard_normal((2, samples + 2 * MARGIN))
    whole, healthy = (Playback(model, REFERENCE, volts, window) for model in (BrokenBars(), HealthyMachine()))
    one = one_candidate(0.0)
    ours, theirs = whole.trajectories(one), healthy.trajectories(one)
    assert ours.current == pytest.approx(theirs.current, abs=1e-9)
    assert ours.speed == pytest.approx(theirs.speed, rel=1e-9)
    assert whole.squared_error(one, measured) == pytest.approx(healthy.squared_error(one, measured))


def test_where_the_broken_bars_stand_only_turns_the_sidebands() -> None:
    samples = 4_000
    volts = feed(MEDIUM, RATE, samples, negative=0.0, fifth=0.0)
    window = Window(MARGIN, MARGIN + samples, MARGIN + 1)
    at, opposite = (
        Playback(BrokenBars(angle), MEDIUM, volts, window).trajectories(one_candidate(0.03)).current[0]
        for angle in (0.4, 0.4 + np.pi)
    )
    beside = Playback(BrokenBars(0.4 + np.pi / 2), MEDIUM, volts, window).trajectories(one_candidate(0.03))
    assert opposite == pytest.approx(at, abs=1e-9)
    assert np.abs(beside.current[0] - at).max() > 0.1
