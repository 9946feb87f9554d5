"""Rotors that displace their current, and leakage that saturates, against another integrator."""

from dataclasses import fields, replace
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from core.machines.candidates import LoadLaw
from core.machines.deep_bar_starts import DeepBarCandidates, DeepBarStartPlayback
from core.machines.deep_bars import DeepBars, LeakageSaturation
from core.machines.parameters import Motor
from core.machines.starting import StartPlayback, start_candidate
from core.machines.supply import supply
from testing.machines.motors import LARGE, MEDIUM

Array = NDArray[np.float64]
RATE_HZ, SECONDS, FIRST = 10_000.0, 0.4, 40
LOAD = 0.5


def voltage_of(motor: Motor) -> Array:
    """A balanced supply on Clarke axes: the vector's length is sqrt 3 times the winding's rms voltage."""
    t = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    length = np.sqrt(3.0) * motor.nameplate.winding_voltage_V
    turning = length * np.exp(1j * 2.0 * pi * 50.0 * t)
    return np.array([turning.real, turning.imag])


def playback_of(motor: Motor, kind: type[StartPlayback]) -> StartPlayback:
    volts = voltage_of(motor)
    whole = supply(volts, RATE_HZ, 50.0, np.zeros(2, np.complex128))
    return kind(motor.nameplate, whole, FIRST, (FIRST, volts.shape[1] - 10), LoadLaw.QUADRATIC)


def candidate(motor: Motor, bars: DeepBars, saturation: LeakageSaturation) -> DeepBarCandidates:
    plain = start_candidate(motor.parameters, LOAD)
    known = {one.name: getattr(plain, one.name) for one in fields(plain)}
    change = (
        bars.resistance_ratio,
        bars.leakage_share,
        *(getattr(saturation, f.name) for f in fields(saturation)),
    )
    names = ("resistance_ratio", "leakage_share", "saturating_share", "knee_current_A", "knee_sharpness")
    return DeepBarCandidates(**known, **{n: np.array([v]) for n, v in zip(names, change, strict=True)})


def integrated(motor: Motor, bars: DeepBars, saturation: LeakageSaturation) -> Array:
    """The start by DOP853: currents are solved for by iteration, in a frame that turns with the supply."""
    machine, plate = motor.parameters, motor.nameplate
    R_o, R_i, L_c, L_i = bars.loops(machine.rotor_resistance_ohm, machine.rotor_leakage_H)
    L_m, w = machine.magnetising_inductance_H, 2.0 * pi * 50.0
    volts = np.sqrt(3.0) * plate.winding_voltage_V + 0j
    rated = plate.rated_torque_Nm / plate.pole_pairs

    def currents(psi: NDArray[np.complex128], guess: float) -> NDArray[np.complex128]:
        for _ in range(60):
            f = saturation.factor(guess / np.sqrt(3.0))
            L = np.array(
                [
                    [f * machine.stator_leakage_H + L_m, L_m, L_m],
                    [L_m, f * L_c + L_m, f * L_c + L_m],
                    [L_m, f * L_c + L_m, f * L_c + L_m + L_i],
                ]
            )
            i = np.linalg.solve(L, psi)
            if abs(abs(i[0]) - guess) < 1e-9 * (1.0 + guess):
                break
            guess = abs(i[0])
        return np.asarray(i)

    def rates(_t: float, x: Array) -> Array:
        psi, speed = x[:3] + 1j * x[3:6], x[6]
        i = currents(psi, 10.0)
        e = np.array([volts, 0.0, 0.0]) - np.array([machine.stator_resistance_ohm, R_o, R_i]) * i
        e -= 1j * np.array([w, w - speed, w - speed]) * psi
        torque = L_m * (np.conj(i[1] + i[2]) * i[0]).imag
        gain = plate.pole_pairs**2 / machine.inertia_kgm2
        load = LOAD * rated * (speed / plate.rated_angular_frequency) ** 2
        return np.array([*e.real, *e.imag, gain * (torque - load)])

    t = (np.arange(FIRST, round(SECONDS * RATE_HZ) - 10) - FIRST) / RATE_HZ
    found = solve_ivp(rates, (0.0, t[-1]), np.zeros(7), "DOP853", t, rtol=1e-9, atol=1e-9)
    turned = np.exp(1j * w * (t + FIRST / RATE_HZ))
    stator = np.array([currents(x[:3] + 1j * x[3:6], 10.0)[0] for x in found.y.T]) * turned
    return np.array([stator.real, stator.imag])


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=["star", "delta"])
def test_a_start_agrees_with_dop853(motor: Motor) -> None:
    bars = DeepBars(2.8, 0.55)
    saturation = LeakageSaturation(0.35, motor.nameplate.rated_power_W / 400.0, 2.2)
    (found,) = (
        playback_of(motor, DeepBarStartPlayback).trajectories(candidate(motor, bars, saturation)).current
    )
    truth = integrated(motor, bars, saturation)
    assert np.abs(found - truth).max() < 1e-3 * np.abs(truth).max()
    assert np.sqrt(np.mean((found - truth) ** 2)) < 1e-4 * np.abs(truth).max()


def test_loops_that_hardly_differ_are_one_loop() -> None:
    bars, none = DeepBars(1.0001, 0.9999), LeakageSaturation(0.0, 1e6)
    deep = playback_of(MEDIUM, DeepBarStartPlayback).trajectories(candidate(MEDIUM, bars, none)).current[0]
    plain = (
        playback_of(MEDIUM, StartPlayback).trajectories(start_candidate(MEDIUM.parameters, LOAD)).current[0]
    )
    assert np.abs(deep - plain).max() < 1e-3 * np.abs(plain).max()


def test_the_parameters_are_those_of_a_small_slip_and_the_change_that_of_a_great_one() -> None:
    loops = DeepBars(2.5, 0.6).loops(0.5, 2e-3)
    slow, fast = loops.impedance(1e-3), loops.impedance(1e9)
    assert slow.real == pytest.approx(0.5, rel=1e-6)
    assert slow.imag / 1e-3 == pytest.approx(2e-3, rel=1e-6)
    assert fast.real == pytest.approx(2.5 * 0.5, rel=1e-6)
    assert fast.imag / 1e9 == pytest.approx(0.6 * 2e-3, rel=1e-6)


def test_the_negative_sequence_sees_more_resistance_and_less_leakage() -> None:
    plain, deep = MEDIUM.backward_rotor, replace(MEDIUM, deep_bars=DeepBars(2.5, 0.5)).backward_rotor
    assert plain == (1.0, 1.0)
    assert 1.1 < deep.resistance_ratio < 2.5
    assert 0.5 < deep.leakage_share < 1.0


def test_leakage_falls_from_all_of_it_to_what_does_not_saturate() -> None:
    saturation = LeakageSaturation(0.4, 30.0, 3.0)
    assert saturation.factor(0.0) == 1.0
    assert saturation.factor(1e6) == pytest.approx(0.6, abs=1e-4)
    falling = [saturation.factor(current) for current in np.linspace(0.0, 300.0, 50)]
    assert falling == sorted(falling, reverse=True)
