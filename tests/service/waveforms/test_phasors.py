"""Phasors at a cursor and spectra, of recordings whose truth is known."""

from cmath import phase
from dataclasses import replace
from math import degrees

import numpy as np
import pytest

from core.machines.parameters import Motor
from core.recordings import Recording
from core.signals.sequence import PhaseSequence
from service.waveforms.opened import Opened, shown_channels
from service.waveforms.phasors import NoPhasorsError, phasors_at
from service.waveforms.spectra import NoSpectrumError, spectrum_of
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running


def shown(record: Recording, motor: Motor | None = REFERENCE) -> Opened:
    """Return a recording as if it had been read."""
    return Opened(record, motor, shown_channels(record.channels, motor))


@pytest.mark.parametrize("reverse", [False, True])
def test_phasors_and_components_are_those_of_the_circuit(reverse: bool) -> None:
    truth = running(REFERENCE, 0.6, unbalance=0.02, reverse=reverse)
    found = phasors_at(shown(recording(truth)), 0.3)
    assert found.frequency_hz == pytest.approx(50.0, abs=1e-3)
    assert not found.is_assumed
    assert found.sequence is (PhaseSequence.ACB if reverse else PhaseSequence.ABC)
    sizes = {one.name: abs(one.value) for one in found.phases}
    for k, name in enumerate("abc"):
        assert sizes[f"I{name}"] == pytest.approx(abs(truth.line_current[k]), rel=1e-3)
        assert sizes[f"V{name}"] == pytest.approx(abs(truth.phase_voltage[k]), rel=1e-3)
    assert found.reference == "V1"
    assert degrees(phase(found.component("V1") or 0)) == pytest.approx(0.0, abs=1e-6)
    assert found.ratio("V2", "V1") == pytest.approx(0.02, rel=1e-2)
    assert found.component("V0") == pytest.approx(0.0, abs=0.1)
    assert found.active_power_W is not None
    assert 0.6 < found.active_power_W / (0.6 * REFERENCE.nameplate.rated_power_W) < 1.7
    assert found.power_factor is not None
    assert 0.3 < found.power_factor < 1.0


def test_a_cursor_beyond_the_ends_takes_the_nearest_whole_cycle() -> None:
    record = recording(running(REFERENCE, 0.5))
    assert phasors_at(shown(record), -5.0).at_s == pytest.approx(0.00995)
    assert phasors_at(shown(record), 99.0).at_s == pytest.approx(record.duration_s - 0.01005)


def test_without_voltages_angles_count_from_the_current() -> None:
    record = recording(running(REFERENCE, 0.5))
    bare = replace(record, samples=record.samples[:3], channels=record.channels[:3])
    found = phasors_at(shown(bare), 0.2)
    assert found.reference == "I1"
    assert found.component("V1") is None
    assert found.power_factor is None
    assert found.ratio("V2", "V1") is None


def test_what_has_no_phasors_says_why() -> None:
    record = recording(running(REFERENCE, 0.5))
    with pytest.raises(NoPhasorsError, match="one current channel for each"):
        phasors_at(shown(replace(record, samples=record.samples[3:], channels=record.channels[3:])), 0.1)
    short = replace(record, samples=record.samples[:, :50], nominal_frequency_hz=50.0)
    with pytest.raises(NoPhasorsError, match="less than a cycle"):
        phasors_at(shown(short), 0.0)
    missing = record.samples.copy()
    missing[0, 3000] = np.nan
    with pytest.raises(NoPhasorsError, match="missing"):
        phasors_at(shown(replace(record, samples=missing)), 0.3)


def test_the_spectrum_shows_a_swinging_load_at_twice_the_slip() -> None:
    record = recording(running(REFERENCE, 0.6), seconds=4.0, noise=1e-4)
    t = record.time_s
    slip = 0.04
    swing = 1.0 + 0.02 * np.cos(2 * np.pi * 2 * slip * 50.0 * t)
    samples = np.vstack([record.samples[:3] * swing, record.samples[3:]])
    speed_rpm = 60.0 * 50.0 / REFERENCE.nameplate.pole_pairs * (1.0 - slip)
    motor = replace(REFERENCE, nameplate=replace(REFERENCE.nameplate, rotor_bars=28))
    found = spectrum_of(shown(replace(record, samples=samples), motor), 2000, speed_rpm=speed_rpm)
    assert found.slip == pytest.approx(slip, abs=1e-4)
    levels = {one.line.label: one.level_dB for one in found.lines}
    assert levels["f"] == pytest.approx(0.0, abs=0.3)
    assert levels["(1−2s)f"] == pytest.approx(-40.0, abs=1.0)
    assert levels["(1+2s)f"] == pytest.approx(-40.0, abs=1.0)
    assert levels["5f"] < -60.0
    assert levels["slots +f"] < -60.0
    assert found.tells_sidebands
    assert found.frequency_hz.size <= 2000
    assert found.level_dB.max() == pytest.approx(0.0)


def test_a_short_recording_says_that_sidebands_cannot_be_told() -> None:
    found = spectrum_of(shown(recording(running(REFERENCE, 0.3))), 500, speed_rpm=1485.0)
    assert not found.tells_sidebands
    assert {"(1−2s)f", "(1+2s)f"}.isdisjoint(one.line.label for one in found.lines), "the supply's leakage"
    assert found.seconds_for_sidebands == pytest.approx(4.0, rel=0.01)
    unknown = spectrum_of(shown(recording(running(REFERENCE, 0.3)), None), 500, speed_rpm=1485.0)
    assert unknown.slip is None
    assert not unknown.tells_sidebands


def test_no_spectrum_without_currents() -> None:
    record = recording(running(REFERENCE, 0.5))
    with pytest.raises(NoSpectrumError):
        spectrum_of(shown(replace(record, samples=record.samples[3:], channels=record.channels[3:])), 10)
