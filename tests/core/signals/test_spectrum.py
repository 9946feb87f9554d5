"""Spectra of known sines, and where the lines of a motor lie."""

import numpy as np
import pytest

from core.signals.errors import SignalError
from core.signals.spectrum import amplitude_spectrum, lines_of_a_motor

RATE = 5000.0
TIME = np.arange(10_000) / RATE


def test_a_sine_shows_with_its_rms_value_at_its_frequency() -> None:
    x = np.stack([3.0 + 2.0 * np.sin(2 * np.pi * 50.0 * TIME), np.sqrt(2) * np.cos(2 * np.pi * 250.0 * TIME)])
    spectrum = amplitude_spectrum(x, RATE)
    for row, frequency, rms in ((0, 50.0, np.sqrt(2)), (1, 250.0, 1.0)):
        line = int(np.argmax(spectrum.amplitude[row]))
        assert spectrum.frequency_hz[line] == pytest.approx(frequency)
        assert spectrum.amplitude[row, line] == pytest.approx(rms, rel=1e-6)
    assert spectrum.amplitude[0, 0] < 1e-3  # the mean value is left out


def test_lines_nearer_than_the_resolution_run_into_one() -> None:
    def dip(distance_hz: float) -> float:
        both = np.sin(2 * np.pi * 50.0 * TIME) + np.sin(2 * np.pi * (50.0 + distance_hz) * TIME)
        spectrum = amplitude_spectrum(both[np.newaxis], RATE)
        between = (spectrum.frequency_hz > 50.0) & (spectrum.frequency_hz < 50.0 + distance_hz)
        return float(spectrum.amplitude[0, between].min()) if between.any() else 1.0

    resolution_hz = amplitude_spectrum(np.zeros((1, TIME.size)), RATE).resolution_hz
    assert resolution_hz == pytest.approx(1.0)
    assert dip(3.0 * resolution_hz) < 0.05
    assert dip(0.5 * resolution_hz) > 0.3


def test_the_lines_of_a_motor_lie_where_its_slip_and_slots_put_them() -> None:
    lines = {
        one.label: one.frequency_hz
        for one in lines_of_a_motor(50.0, 2500.0, slip=0.03, pole_pairs=2, rotor_bars=28)
    }
    assert lines["(1−2s)f"] == pytest.approx(47.0)
    assert lines["(1+2s)f"] == pytest.approx(53.0)
    assert lines["slots −f"] == pytest.approx(629.0)
    assert lines["slots +f"] == pytest.approx(729.0)
    assert lines["5f"] == 250.0
    assert [*lines.values()] == sorted(lines.values())


def test_what_is_not_known_gives_no_lines() -> None:
    assert {one.label for one in lines_of_a_motor(60.0, 500.0)} == {"f", "3f", "5f", "7f"}
    standing = lines_of_a_motor(60.0, 500.0, slip=0.0, pole_pairs=2)
    assert [one.label for one in standing] == ["f", "3f", "5f", "7f"]


def test_missing_values_and_too_few_are_refused() -> None:
    with pytest.raises(SignalError, match="missing values"):
        amplitude_spectrum(np.full((1, 100), np.nan), RATE)
    with pytest.raises(SignalError, match="too few"):
        amplitude_spectrum(np.zeros((1, 3)), RATE)
