"""Sidebands of one phase, in records as those of the public set: 1 s at 5 kHz."""

from math import log10

import numpy as np
import pytest
from numpy.typing import NDArray

from core.rotor.one_phase import one_phase_sidebands
from core.signals.errors import SignalError
from testing.machines.motors import REFERENCE
from testing.machines.rotor_records import FREQUENCY_HZ, RotorCase, one_phase

RATE_HZ = 5_000.0
ONE_BAR = 1.0 / 28.0
LOADS = (0.3, 0.5, 0.9)


def _current(load_level: float, broken_share: float, seed: int) -> tuple[NDArray[np.float64], float]:
    """One phase in steps of 20 mA with a spike now and then, and the slip."""
    case = RotorCase(REFERENCE, load_level=load_level, broken_share=broken_share, noise=0.02)
    current = np.round(one_phase(case.record(1.0, RATE_HZ, seed=seed)) / 0.02) * 0.02
    random = np.random.default_rng(seed)
    current[random.integers(0, current.size, 3)] += 1.0
    return current, case.slip()


def _hann(current: NDArray[np.float64], slip: float) -> float:
    """Amplitude near the lower sideband over the greatest, of a Fourier transform under a Hann window."""
    window = np.hanning(current.size)
    spectrum = np.abs(np.fft.rfft((current - current.mean()) * window))
    f = np.fft.rfftfreq(current.size, 1.0 / RATE_HZ)
    near = np.abs(f - (1.0 - 2.0 * slip) * FREQUENCY_HZ) <= 1.0
    return float(spectrum[near].max() / spectrum.max())


def test_a_joint_fit_tells_broken_from_healthy_where_a_hann_transform_does_not() -> None:
    joint, hann = [], []
    for load_level in LOADS:
        healthy, slip = _current(load_level, 0.0, seed=1)
        broken, broken_slip = _current(load_level, ONE_BAR, seed=2)
        levels = [
            one_phase_sidebands(current, RATE_HZ, s, 50.0).lower
            for current, s in ((healthy, slip), (broken, broken_slip))
        ]
        joint.append(20.0 * log10(levels[1] / levels[0]))
        hann.append(20.0 * log10(_hann(broken, broken_slip) / _hann(healthy, slip)))
    assert min(joint) > 6.0
    assert hann[0] < 1.0
    assert all(ours > theirs for ours, theirs in zip(joint, hann, strict=True))


def test_sidebands_that_are_known_are_measured_beside_harmonics_and_an_offset() -> None:
    t = np.arange(5_000) / RATE_HZ
    w = 2.0 * np.pi * 49.97
    current = 0.05 + 2.0 * np.cos(w * t + 0.3) + 0.1 * np.cos(5.0 * w * t)
    current += 0.02 * np.cos(w * (1.0 - 0.08) * t + 1.0) + 0.01 * np.cos(w * (1.0 + 0.08) * t)
    current += 0.002 * np.random.default_rng(3).standard_normal(t.size)
    found = one_phase_sidebands(current, RATE_HZ, 0.041, 50.0)
    assert found.frequency_hz == pytest.approx(49.97, abs=1e-3)
    assert found.lower == pytest.approx(0.010, abs=4e-4)
    assert found.upper == pytest.approx(0.005, abs=4e-4)
    assert found.noise < 2e-4
    assert found.distance_hz == pytest.approx(0.08 * 49.97, abs=0.2)


def test_a_record_too_short_for_its_slip_is_refused_with_the_time_it_takes() -> None:
    current, _ = _current(0.25, 0.0, seed=4)
    with pytest.raises(SignalError, match=r"it takes 2\.3 s"):
        one_phase_sidebands(current, RATE_HZ, 0.0065, 50.0)
    with pytest.raises(SignalError, match="finite"):
        one_phase_sidebands(np.full(5_000, np.nan), RATE_HZ, 0.05, 50.0)
    with pytest.raises(SignalError, match="flows"):
        one_phase_sidebands(np.zeros(5_000), RATE_HZ, 0.05, 50.0)
