"""Broken bars against a cage computed bar by bar, against linear theory and against published rules."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.parameters import Motor
from ied_sim.motor.cage import Cage, cage_loops
from ied_sim.motor.load import Load
from ied_sim.motor.plant import METERING_STEP_RATE_HZ, MotorPlant
from ied_sim.motor.rotor import RotorLoops, three_coils
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE
from tests.ied_sim.motor.bar_by_bar import BarByBar
from tests.ied_sim.motor.plants import plant

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

RATE_HZ = 2_000.0


def lines(motor: MotorPlant, orders: tuple[int, ...] = (0, -1, 1)) -> tuple[Complex, float]:
    """Space phasors of the current at f + 2 k s f for each k of `orders`, and the slip."""
    settling_s = 2 * motor.settling_s
    run = motor.operation(20.0, 4.0, RATE_HZ, settling_s=settling_s, step_rate_hz=METERING_STEP_RATE_HZ)
    frequency_Hz = motor.supply.frequency_Hz
    slip = 1 - run.speed_rad_s.mean() * motor.motor.nameplate.pole_pairs / (2 * pi * frequency_Hz)
    times = np.arange(run.speed_rad_s.size) / RATE_HZ
    around = np.array([-3, -2, -1, 0, 1, 2, 3])
    basis = np.exp(2j * pi * frequency_Hz * np.outer(times, 1 + 2 * slip * around))
    phasor = np.exp(2j * pi / 3 * np.arange(3)) @ run.currents_A
    found = np.linalg.lstsq(basis, phasor, rcond=None)[0]
    return found[[int(np.flatnonzero(around == order)[0]) for order in orders]], float(slip)


def answer(rotor: RotorLoops, slip_Hz: float) -> Complex:
    """What the stator sees of the rotor at one slip frequency, on two axes."""
    impedance = rotor.resistance / (2j * pi * slip_Hz) + rotor.leakage + rotor.gap
    seen: Complex = rotor.axes @ np.linalg.solve(impedance, rotor.axes.T)
    return seen


@pytest.mark.parametrize("bars", [24, 28, 45])
@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_a_whole_cage_is_three_coils_at_every_slip(motor: Motor, bars: int) -> None:
    cage = cage_loops(motor.parameters, 2, Cage(bars), 0.0)
    assert cage.axes.shape == (2, 2)
    for slip_Hz in (0.2, 2.0, 20.0, 50.0):
        expected = answer(three_coils(motor.parameters), slip_Hz)
        assert answer(cage, slip_Hz) == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("broken", "places"), [(1, (3,)), (3, (3, 4, 5)), (2, (3, 8))])
def test_a_start_is_that_of_the_cage_bar_by_bar(broken: int, places: tuple[int, ...]) -> None:
    """From rest to rated speed, to 0.1 % of what the broken bars change at all."""
    reference = BarByBar()
    motor = reference.motor()
    healthy_plant = plant(motor, level=reference.load_torque / motor.nameplate.rated_torque_Nm)
    rings = reference.R_ring / (2 * np.sin(pi * 2 / 28) ** 2)
    cage = Cage(28, rings / (rings + reference.R_bar), places)
    ours = replace(healthy_plant, cage=cage, broken_bars=broken / 28).start_up(0.0, 0.6, RATE_HZ)
    healthy = healthy_plant.start_up(0.0, 0.6, RATE_HZ)
    times = np.arange(ours.speed_rad_s.size) / RATE_HZ
    currents, speed = reference.start(healthy_plant.supply, places, times)
    whole, _ = reference.start(healthy_plant.supply, (), times)
    assert np.abs(healthy.currents_A - whole).max() < 2e-4 * np.abs(whole).max()
    effect = np.abs(currents - whole).max()
    assert effect > 0.02 * np.abs(whole).max()
    assert np.abs(ours.currents_A - currents).max() < 0.001 * effect
    assert ours.speed_rad_s == pytest.approx(speed, abs=0.01)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("load_inertia", [0.0, 10.0])
def test_the_ratio_of_the_sidebands_is_the_one_of_inertia(motor: Motor, load_inertia: float) -> None:
    """A small asymmetry throws a voltage back at -2 s f; torque, speed and the upper line follow from it."""
    load = Load(0.8, inertia_kgm2=load_inertia * motor.parameters.inertia_kgm2)
    cracked = replace(plant(motor, load=load), broken_bars=0.2 / 28)
    (_, lower, upper), slip = lines(cracked)
    expected = sideband_ratio(cracked, slip)
    assert abs(upper) / abs(lower) == pytest.approx(expected, rel=0.03)


def sideband_ratio(motor: MotorPlant, slip: float) -> float:
    """|upper| / |lower| of a voltage at -2 s f in the rotor, from the equations linearised at a slip."""
    x, p = motor.motor.parameters, motor.motor.nameplate.pole_pairs
    w = 2 * pi * motor.supply.frequency_Hz
    L_m = x.magnetising_inductance_H
    inverse = np.linalg.inv(np.array([[x.stator_leakage_H + L_m, L_m], [L_m, x.rotor_leakage_H + L_m]]))
    R = np.diag([x.stator_resistance_ohm, x.rotor_resistance_ohm])
    turning = np.diag([w, slip * w])
    flux = np.linalg.solve(R @ inverse + 1j * turning, np.array([1.0, 0.0]))
    # Per volt of the stator; the linear equations scale with the square of the voltage in the torque.
    volts = motor.supply.line_voltage_V * (1.0 if motor.motor.nameplate.connection == "delta" else 3**-0.5)
    flux = flux * volts * 2**0.5

    def real(matrix: Array | Complex) -> Array:
        return np.block([[np.real(matrix), -np.imag(matrix)], [np.imag(matrix), np.real(matrix)]])

    # States: fluxes (real parts of stator and rotor, imaginary parts) and the electrical speed.
    A = np.zeros((5, 5))
    A[:4, :4] = real(-(R @ inverse + 1j * turning))
    A[:4, 4] = [0.0, np.real(1j * flux[1]), 0.0, np.imag(1j * flux[1])]
    current = inverse @ flux
    # torque = 3/2 p Im(conj(psi_s) i_s)
    i = real(inverse)
    torque = np.zeros(4)
    torque += 1.5 * p * (flux[0].real * i[2] - flux[0].imag * i[0])
    torque[0] += 1.5 * p * current[0].imag
    torque[2] -= 1.5 * p * current[0].real
    A[4, :4] = torque * p / motor.inertia_kgm2
    # e^(-j 2 s w t) in the rotor: real part cos, imaginary part -sin; as the real part of z e^(j 2 s w t).
    drive = np.array([0.0, 1.0, 0.0, 1j, 0.0])
    z = np.linalg.solve(2j * slip * w * np.eye(5) - A, drive)
    found = i @ z[:4]
    upper, lower = (found[0] + 1j * found[2]) / 2, (np.conj(found[0]) + 1j * np.conj(found[2])) / 2
    return float(abs(upper) / abs(lower))


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_a_healthy_cage_makes_no_sidebands(motor: Motor) -> None:
    (first, lower, upper), _ = lines(plant(motor, level=0.8))
    assert max(abs(lower), abs(upper)) < 1e-8 * abs(first)


def test_one_bar_makes_about_the_published_sideband() -> None:
    """Thomson's rule for n neighbours at constant speed: sin a / (2 p (2 pi - a)), a = 2 pi p n / N."""
    for broken in (1, 2, 3):
        heavy = Load(0.75, inertia_kgm2=50 * REFERENCE.parameters.inertia_kgm2)
        (first, lower, _), _ = lines(replace(plant(load=heavy), broken_bars=broken / 28))
        a = 2 * pi * 2 * broken / 28
        rule = np.sin(a) / (4 * (2 * pi - a))
        assert 20 * np.log10(abs(lower) / abs(first) / rule) == pytest.approx(0, abs=6)


def test_bars_a_quarter_of_a_wave_apart_hide_each_other() -> None:
    """With p = 2 and N = 32, bars 4 apart stand 90 electrical degrees apart: the asymmetries cancel."""
    beside, apart = (
        lines(replace(plant(MEDIUM, level=0.8), cage=Cage(32, places=(0, second)), broken_bars=2 / 32))[0]
        for second in (1, 4)
    )
    assert abs(apart[1]) < 0.1 * abs(beside[1])


def test_a_crack_grows_into_a_broken_bar() -> None:
    found = []
    for broken in (0.25, 0.5, 0.999, 1.0):
        (first, lower, _), _ = lines(replace(plant(LARGE, level=0.8), broken_bars=broken / 28))
        found.append(abs(lower / first))
    assert found == sorted(found)
    assert found[2] == pytest.approx(found[3], rel=0.01)


def test_broken_bars_develop_over_time() -> None:
    developing = replace(plant(), broken_bars=((0.0, 0.0), (100.0, 2 / 28)))
    assert developing.broken_share(50.0) == pytest.approx(1 / 28)
    assert developing.rotor(0.0).axes.shape == (2, 2)
    assert developing.rotor(100.0).axes.shape[1] > 2


def test_too_few_bars_for_the_rotors_leakage_are_refused() -> None:
    with pytest.raises(ValueError, match="12 bars are too few for 4 pole pairs"):
        cage_loops(MEDIUM.parameters, 4, Cage(12), 1 / 12)
