"""Shorted turns in a coil with an axis and a leakage of its own, against DOP853 of the page's equations."""

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.candidates import Candidates
from core.machines.parameters import Motor
from core.machines.playback import Beginning, Playback, Window
from core.machines.running import SteadyRunning
from core.machines.split_winding import SplitWinding
from core.machines.supply import Supply, supply
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.page_equations import Coil, integrate
from tests.core.machines import reference_values as reference

Array = NDArray[np.float64]
RATE_HZ = 10_000.0
MARGIN = 3
"""Columns before time zero that a playback's window leaves free."""
WINDING, LOAD_LEVEL = 2, 0.6
OF_ONE_SLOT = np.radians(20.0)
COILS = [
    (0.01, Coil(own_leakage=0.12, axis_rad=OF_ONE_SLOT, linkage=1.04)),
    (0.05, Coil(own_leakage=0.6, axis_rad=-OF_ONE_SLOT, linkage=1.04)),
    (0.1, Coil(own_leakage=0.3, axis_rad=-OF_ONE_SLOT, linkage=0.96, path_ratio=2.0)),
    (0.1, Coil(own_leakage=0.05)),
    (0.05, Coil(own_leakage=1.7, axis_rad=0.4, linkage=1.05)),
    (1e-3, Coil(own_leakage=0.05, axis_rad=0.4, linkage=1.05, path_ratio=0.5)),
]


def candidate(mu: float, coil: Coil) -> Candidates:
    """The level and the leakage that the terminals see, of turns that know share and path."""
    one = np.ones(1)
    through = one / (1.0 + coil.path_ratio)
    return Candidates(
        mu * through, np.array([WINDING]), LOAD_LEVEL * one, 0.0 * one,
        leakage=coil.leakage_of(mu) * through, axis_rad=coil.axis_rad * one, linkage=coil.linkage * one,
    )  # fmt: skip


def feed(motor: Motor, samples: int, *, negative: float, fifth: float) -> Supply:
    """Supply whose column MARGIN is time zero."""
    t = (np.arange(samples + 2 * MARGIN) - MARGIN) / RATE_HZ
    voltage = reference.voltage_at(motor, t, negative=negative, fifth=fifth)
    forward = reference.winding_voltage(motor) * np.array([1.0, -1.0j])
    phasor = (forward + negative * np.exp(0.7j) * forward.conj()) * np.exp(
        -1j * reference.W_S * MARGIN / RATE_HZ
    )
    return supply(voltage, RATE_HZ, 50.0, phasor)


def relative_rms(found: Array, expected: Array) -> float:
    return float(np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2)))


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize(("mu", "coil"), COILS)
def test_a_start_agrees_with_dop853(motor: Motor, mu: float, coil: Coil) -> None:
    """Within 1e-4 relative rms, with 3 % unbalance and 2 % fifth harmonic."""
    samples = 3_000
    volts = feed(motor, samples, negative=reference.NEGATIVE, fifth=reference.FIFTH)
    window = Window(MARGIN, MARGIN + samples, MARGIN + 1)
    playback = Playback(SplitWinding(), motor, volts, window, beginning=Beginning.REST)
    track = playback.trajectories(candidate(mu, coil))
    current, speed = integrate(
        "split-winding", motor, mu, WINDING, LOAD_LEVEL, lambda t: reference.voltage_at(motor, t),
        np.zeros(5), 0.0, np.arange(samples) / RATE_HZ, coil=coil,
    )  # fmt: skip
    assert relative_rms(track.current[0], current) < 1e-4
    assert relative_rms(track.speed[0], speed) < 1e-4


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE, VERY_LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize(("mu", "coil"), COILS)
def test_steady_running_agrees_with_dop853(motor: Motor, mu: float, coil: Coil) -> None:
    """Playback begun in the phasors' steady state, and the page's equations begun at the same currents."""
    samples = 600
    volts = feed(motor, samples, negative=reference.NEGATIVE, fifth=0.0)
    playback = Playback(SplitWinding(), motor, volts, Window(MARGIN, MARGIN + samples, MARGIN + 1))
    one = candidate(mu, coil)
    track = playback.trajectories(one)
    state = playback.steady_state(one)
    assert state.balanced[0]
    rates = SteadyRunning(SplitWinding(), motor, reference.W_S, volts.phasor).rates(one)
    begun = rates.machines.current_from_flux[0] @ state.flux[:, 0]
    begun[4] /= mu
    current, speed = integrate(
        "split-winding", motor, mu, WINDING, LOAD_LEVEL,
        lambda t: reference.voltage_at(motor, t, fifth=0.0), begun, float(state.speed[0]),
        np.arange(samples) / RATE_HZ, coil=coil,
    )  # fmt: skip
    assert relative_rms(track.current[0], current) < 1e-4
    assert np.abs(track.speed[0] / speed - 1.0).max() < 1e-4
    # It is steady: the third cycle repeats the first, fault current and ripple of the speed included.
    assert relative_rms(current[:, 400:], current[:, :200]) < 1e-4


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_no_turns_are_the_healthy_machine_whatever_their_place_and_few_tend_to_it(motor: Motor) -> None:
    samples = 1_000
    volts = feed(motor, samples, negative=0.03, fifth=0.02)
    playback = Playback(SplitWinding(), motor, volts, Window(MARGIN, MARGIN + samples, MARGIN + 1))
    levels = np.array([0.0, 0.0, 1e-12, 1e-8, 1e-6, 1e-4])
    ones = np.ones(levels.size)
    track = playback.trajectories(
        Candidates(
            levels, np.ones(levels.size, np.int64), 0.5 * ones, 0.0 * ones,
            leakage=np.where(levels > 0.0, 12.0 * levels, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
            axis_rad=0.4 * ones, linkage=1.05 * ones,
        )
    )  # fmt: skip
    assert np.array_equal(track.current[0], track.current[1])
    distance = np.abs(track.current - track.current[0]).max(axis=(1, 2))
    allowed = 10.0 * np.abs(track.current[0]).max() * motor.nameplate.rated_power_W
    assert np.isfinite(track.current).all()
    assert (distance <= allowed * levels + 1e-9).all()
    assert distance[-1] > 1e-4


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
def test_turns_without_a_leakage_of_their_own_stay_finite(motor: Motor) -> None:
    """In delta nothing but resistances limits their current then; below, a leakage no coil has is raised."""
    samples = 1_000
    volts = feed(motor, samples, negative=0.0, fifth=0.02)
    playback = Playback(SplitWinding(), motor, volts, Window(MARGIN, MARGIN + samples, MARGIN + 1))
    one = np.ones(3)
    shared = [Coil(0.0).leakage_of(0.1), Coil(0.002).leakage_of(0.1), 0.0]
    track = playback.trajectories(
        Candidates(
            0.1 * one, np.ones(3, np.int64), 0.5 * one, 0.0 * one, leakage=np.array(shared)
        )
    )  # fmt: skip
    assert np.array_equal(track.current[0], track.current[2])
    assert relative_rms(track.current[0], track.current[1]) < 6e-3
