"""The phasors a diagnosis compares, and how far they may be trusted."""

import numpy as np
import pytest
from scipy.signal import lfilter

from core.diagnosis.case import case_of
from core.diagnosis.fundamental import Phasors, axis_phasors, components, fundamental_of
from core.diagnosis.operating_point import load_of
from core.machines.parameters import Motor
from core.signals.clarke import clarke, inverse_clarke
from core.signals.sequence import PhaseSequence
from testing.machines.motors import ALL, REFERENCE
from testing.machines.phase_circuits import recording, running

RATE = 10_000.0
SAMPLES = 5_000


def phasors(
    disturbance: np.ndarray[tuple[int, ...], np.dtype[np.float64]], samples: int = SAMPLES
) -> Phasors:
    """Current phasors of 10 A forwards at 30 degrees and 1 A backwards at -50, with something beside."""
    angle = 2.0 * np.pi * 50.0 / RATE * np.arange(samples)
    vector = 10.0 * np.exp(1j * (angle + np.pi / 6.0)) + np.exp(-1j * (angle + np.deg2rad(50.0)))
    current = np.stack([vector.real, vector.imag]) + disturbance
    voltage = 300.0 * np.stack([np.cos(angle), np.sin(angle)])
    phases = inverse_clarke(current)
    return fundamental_of(case_of(REFERENCE, phases, voltage, RATE, 50.0, PhaseSequence.ABC)).current


@pytest.mark.parametrize("samples", [1_000, 1_037, 5_000, 4_999])
def test_both_sequences_are_found_beside_harmonics(samples: int) -> None:
    angle = 2.0 * np.pi * 50.0 / RATE * np.arange(samples)
    harmonics = np.stack([0.5 * np.cos(5.0 * angle + 1.0) + 0.3, 0.5 * np.cos(7.0 * angle)])
    found = phasors(harmonics, samples)
    assert abs(found.forward) == pytest.approx(10.0, rel=1e-9)
    assert abs(found.backward) == pytest.approx(1.0, rel=1e-8)
    # Forwards and backwards turn against each other: their angles' sum does not depend on the first sample.
    assert np.angle(found.forward * found.backward) == pytest.approx(np.deg2rad(30.0 - 50.0), abs=1e-8)
    assert np.trace(found.covariance) < 1e-12


@pytest.mark.parametrize("correlated_cycles", [0.0, 1.0, 3.0])
def test_the_covariance_is_that_of_noise_of_any_colour(correlated_cycles: float) -> None:
    """Estimates of 200 records scatter as each of them says, also where noise goes on for cycles.

    What is correlated over three of 25 cycles is seen with an error of its own; it may be missed by half.
    """
    random = np.random.default_rng(5)
    keep = np.exp(-1.0 / (correlated_cycles * RATE / 50.0)) if correlated_cycles else 0.0
    angle = 2.0 * np.pi * 50.0 / RATE * np.arange(SAMPLES)
    found, claimed = [], []
    for _ in range(200):
        noise = lfilter([np.sqrt(1.0 - keep**2)], [1.0, -keep], random.standard_normal((2, SAMPLES + 2_000)))
        slow = noise[0, 2_000:] + 1j * noise[1, 2_000:]
        backward = slow * np.exp(-1j * angle)
        record = phasors(0.1 * np.stack([backward.real, backward.imag]))
        found.append(record.components[2:])
        claimed.append(np.diag(record.covariance)[2:])
    ratio = np.sqrt(np.var(found, axis=0).mean() / np.mean(claimed))
    assert 0.75 < ratio < (1.15 if correlated_cycles == 0.0 else 1.5)


def test_components_and_axis_phasors_are_each_other_s_inverse() -> None:
    values = np.array([3.0, -1.0, 0.2, 0.7])
    np.testing.assert_allclose(components(axis_phasors(values)), values)


@pytest.mark.parametrize("motor", ALL, ids=[motor.name for motor in ALL])
@pytest.mark.parametrize("load", [0.0, 0.5, 1.0])
def test_the_load_follows_from_the_phasors(motor: Motor, load: float) -> None:
    record = recording(running(motor, load))
    rate, hertz = record.sample_rate_hz, motor.nameplate.rated_frequency_Hz
    case = case_of(motor, record.samples[:3], clarke(record.samples[3:6]), rate, hertz, PhaseSequence.ABC)
    assert load_of(fundamental_of(case), motor) == pytest.approx(load, abs=0.02)
