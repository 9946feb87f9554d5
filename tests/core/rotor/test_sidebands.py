"""The fit of sidebands in the supply's frame, against a joint fit to the samples."""

from math import pi, sqrt

import numpy as np

from core.diagnosis.acceptance import accept
from core.machines.parameters import Motor
from core.rotor.baseband import baseband_of
from core.rotor.sidebands import fit_lines
from testing.machines.disturbed_records import record_of
from testing.machines.motors import REFERENCE

RATE_HZ, FREQUENCY_HZ, DISTANCE_HZ = 5_000.0, 50.02, 2.3


def _record(duration_s: float, seed: int = 0) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Currents with sidebands of 1 % below and 0.4 % above, both sequences of harmonics, offset and noise."""
    t = np.arange(round(duration_s * RATE_HZ)) / RATE_HZ
    w, distance = 2.0 * pi * FREQUENCY_HZ, 2.0 * pi * DISTANCE_HZ
    volts = REFERENCE.nameplate.rated_voltage_V * np.exp(1j * w * t)
    volts *= 1.0 + 0.02 * np.exp(-6j * w * t) + 0.01 * np.exp(-2j * w * t)
    amps = 2.0 * np.exp(1j * (w * t - 0.8))
    amps *= 1.0 + 0.01 * np.exp(1j * (1.0 - distance * t)) + 0.004 * np.exp(1j * (distance * t - 0.5))
    amps += 0.05 * np.exp(-5j * w * t) + 0.03 * np.exp(7j * w * t) + 0.04 * np.exp(-1j * w * t)
    phases = np.array([0.0, 2.0 * pi / 3.0, -2.0 * pi / 3.0])[:, np.newaxis]
    rows = [sqrt(2.0 / 3.0) * (x * np.exp(-1j * phases)).real for x in (amps, volts)]
    rows[0] += 0.005
    return np.vstack(rows) + 1e-3 * np.random.default_rng(seed).standard_normal((6, t.size))


def _joint_fit(samples: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> tuple[float, float]:
    """Sidebands over the fundamental, by one least-squares fit of everything to the space vector."""
    clarke = sqrt(2.0 / 3.0) * np.exp(2j * pi / 3.0 * np.arange(3))
    vector = clarke @ samples[:3]
    t = np.arange(vector.size) / RATE_HZ
    lines_hz = [order * FREQUENCY_HZ for order in range(-7, 8)]
    lines_hz += [FREQUENCY_HZ - DISTANCE_HZ, FREQUENCY_HZ + DISTANCE_HZ]
    basis = np.exp(2j * pi * np.outer(t, lines_hz))
    found = np.abs(np.linalg.lstsq(basis, vector)[0])
    return float(found[-2] / found[8]), float(found[-1] / found[8])


def _demodulated(
    motor: Motor, samples: np.ndarray[tuple[int, ...], np.dtype[np.float64]]
) -> tuple[float, float]:
    accepted = accept(record_of(samples, RATE_HZ), motor).accepted
    assert accepted is not None
    baseband = baseband_of(accepted)
    angle = 2.0 * pi * DISTANCE_HZ * baseband.time_s
    lines = fit_lines(baseband, angle, np.ones(1))
    current = abs(baseband.current.mean())
    return float(abs(lines.lower[0, 1]) / current), float(abs(lines.upper[0, 1]) / current)


def test_the_fit_in_the_supply_s_frame_equals_the_joint_fit_to_the_samples() -> None:
    for duration_s in (1.0, 4.0):
        samples = _record(duration_s)
        np.testing.assert_allclose(_demodulated(REFERENCE, samples), _joint_fit(samples), atol=3e-5)
        np.testing.assert_allclose(_demodulated(REFERENCE, samples), (0.01, 0.004), atol=5e-5)


def test_the_voltages_of_a_balanced_supply_stand_still_in_its_frame() -> None:
    accepted = accept(record_of(_record(2.0), RATE_HZ), REFERENCE).accepted
    assert accepted is not None
    baseband = baseband_of(accepted)
    assert np.abs(np.angle(baseband.voltage)).max() < 1e-4
    np.testing.assert_allclose(np.abs(baseband.voltage), REFERENCE.nameplate.rated_voltage_V, rtol=1e-4)
    assert baseband.is_whole
    assert baseband.duration_s > 1.95
