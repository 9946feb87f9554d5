"""Figures of a supply against the waveforms that they were made of, and against other methods."""

from dataclasses import replace
from math import cos, sqrt

import numpy as np
import pytest

from core.recordings import RecordingError
from core.supply.errors import NoSupplyError
from core.supply.measuring import measure_supply
from testing.machines.motors import REFERENCE
from tests.core.supply.waveforms import Sines, phase_amplitude, recording

RATED_V = REFERENCE.nameplate.rated_voltage_V
VOLTS = Sines(phase_amplitude(RATED_V))
AMPS = Sines(10.0, lag=0.6)
HARMONICS = {5: 0.03, 7: 0.02, 11: 0.01, 13: 0.008, 25: 0.005}


def iec_unbalance(lines_V: tuple[float, float, float]) -> float:
    """IEC 61000-4-30, 5.7.1: of the three rms line voltages alone."""
    squares = [one**2 for one in lines_V]
    beta = sum(one**2 for one in squares) / sum(squares) ** 2
    return sqrt((1.0 - sqrt(3.0 - 6.0 * beta)) / (1.0 + sqrt(3.0 - 6.0 * beta)))


@pytest.mark.parametrize("order", [1.0, -1.0], ids=["abc", "acb"])
@pytest.mark.parametrize("frequency_hz", [49.2, 50.0, 60.03])
def test_a_pure_supply_is_what_it_is(frequency_hz: float, order: float) -> None:
    found = measure_supply(recording(VOLTS, AMPS, frequency_hz=frequency_hz, order=order), REFERENCE)

    assert found.frequency_hz == pytest.approx(frequency_hz, abs=1e-6)
    assert found.line_voltages_V == pytest.approx((RATED_V,) * 3, rel=1e-9)
    assert found.line_currents_A == pytest.approx((10.0 / sqrt(2.0),) * 3, rel=1e-9)
    assert found.voltage_deviation == pytest.approx(0.0, abs=1e-9)
    assert found.voltage_unbalance_iec == pytest.approx(0.0, abs=1e-9)
    assert found.derating == 1.0
    assert found.thd_voltage == pytest.approx(0.0, abs=1e-8)
    # Whole blocks of samples are not quite whole cycles.
    power_W = sqrt(3.0) * RATED_V * 10.0 / sqrt(2.0) * cos(0.6)
    assert found.active_power_W == pytest.approx(power_W, rel=1e-4)
    assert found.power_factor == pytest.approx(cos(0.6), rel=1e-4)
    assert found.reasons == ()


def test_unbalance_agrees_with_the_formula_of_the_three_voltages() -> None:
    uneven = replace(VOLTS, negative=0.03)
    found = measure_supply(recording(uneven, replace(AMPS, negative=0.2)), REFERENCE)

    assert found.voltage_unbalance_iec == pytest.approx(0.03, rel=1e-6)
    assert found.voltage_unbalance_iec == pytest.approx(iec_unbalance(found.line_voltages_V), rel=1e-6)
    mean = sum(found.line_voltages_V) / 3.0
    largest = max(abs(one - mean) for one in found.line_voltages_V)
    assert found.voltage_unbalance_nema == pytest.approx(largest / mean)
    assert found.current_unbalance == pytest.approx(0.2, rel=1e-6)


def test_above_five_percent_it_says_that_the_motor_is_not_to_run() -> None:
    found = measure_supply(recording(replace(VOLTS, negative=0.07), AMPS), REFERENCE)

    assert found.derating is None
    assert "advises against" in found.reasons[0]


def test_harmonics_are_those_of_a_transform_over_whole_cycles() -> None:
    record = recording(replace(VOLTS, harmonics=HARMONICS), replace(AMPS, harmonics={5: 0.1, 9: 0.02}))
    found = measure_supply(record, REFERENCE)

    lines_V = record.samples[3] - record.samples[4]
    lines = np.abs(np.fft.rfft(lines_V))[100 : 26 * 100 : 100]  # 100 cycles in 2 s
    assert found.voltage_harmonics == pytest.approx(tuple(lines / lines[0]), abs=1e-9)
    assert found.thd_voltage == pytest.approx(float(np.linalg.norm(lines[1:]) / lines[0]), rel=1e-6)
    assert found.current_harmonics[4] == pytest.approx(0.1, rel=1e-6)
    assert found.current_harmonics[8] == pytest.approx(0.02, rel=1e-6)
    assert len(found.voltage_harmonics) == len(found.current_harmonics) == 25
    assert found.thd_current == pytest.approx(sqrt(0.1**2 + 0.02**2), rel=1e-6)


def test_what_is_no_harmonic_does_not_leak_into_harmonics() -> None:
    """A Fourier transform of whole cycles shows 0.04 % of this interharmonic at the third harmonic."""
    between = {137.0: 0.05, 231.3: 0.05, 1213.0: 0.02}
    record = recording(replace(VOLTS, interharmonics=between), AMPS, frequency_hz=50.03, duration_s=10.0)
    found = measure_supply(record, REFERENCE)

    assert max(found.voltage_harmonics[1:]) < 2e-4


def test_a_frequency_that_wanders_takes_nothing_from_high_harmonics() -> None:
    record = recording(replace(VOLTS, harmonics=HARMONICS), AMPS, wander_hz=0.03, duration_s=10.0)
    found = measure_supply(record, REFERENCE)

    pure = measure_supply(recording(replace(VOLTS, harmonics=HARMONICS), AMPS), REFERENCE)
    assert found.voltage_harmonics == pytest.approx(pure.voltage_harmonics, rel=0.01, abs=1e-5)
    assert found.frequency_hz == pytest.approx(50.0, abs=0.02)


def test_noise_raises_no_harmonic_much() -> None:
    found = measure_supply(recording(VOLTS, AMPS, noise=0.01, duration_s=10.0), REFERENCE)

    # 2.5e-2 of a phase's amplitude is the noise of a line voltage; over 100,000 samples 1e-4 is left of it.
    assert max(found.voltage_harmonics[1:]) < 3e-4
    assert found.frequency_hz == pytest.approx(50.0, abs=1e-4)


@pytest.mark.parametrize("duration_s", [0.0605, 0.25, 0.4321, 1.28])
def test_short_records_tell_the_same(duration_s: float) -> None:
    volts, amps = replace(VOLTS, harmonics=HARMONICS), replace(AMPS, negative=0.02)
    record = recording(volts, amps, frequency_hz=49.9, duration_s=duration_s)
    found = measure_supply(record, REFERENCE)

    assert found.frequency_hz == pytest.approx(49.9, abs=2e-3)
    assert found.current_unbalance == pytest.approx(0.02, abs=1e-5)
    assert found.thd_voltage == pytest.approx(float(np.linalg.norm([*HARMONICS.values()])), rel=1e-3)


def test_a_slow_recorder_tells_fewer_harmonics_and_says_so() -> None:
    record = recording(replace(VOLTS, harmonics={5: 0.03}), AMPS, sample_rate_hz=800.0)
    found = measure_supply(record, REFERENCE)

    assert len(found.voltage_harmonics) == 7
    assert found.thd_voltage == pytest.approx(0.0306, abs=1e-3)
    assert "up to the 7th" in found.reasons[0]


def test_two_line_voltages_suffice() -> None:
    record = recording(replace(VOLTS, negative=0.02), AMPS)
    a, b, c = record.samples[3:]
    channels = [replace(record.channels[3], name=name, phase=name.lower()[1:]) for name in ("VAB", "VBC")]
    channels = [replace(one, quantity=one.quantity.LINE_VOLTAGE) for one in channels]
    lines = replace(
        record,
        samples=np.vstack([record.samples[:3], a - b, b - c]),
        channels=(*record.channels[:3], *channels),
    )

    assert measure_supply(lines, REFERENCE).line_voltages_V == pytest.approx(
        measure_supply(record, REFERENCE).line_voltages_V
    )


def test_a_motor_that_stands_has_a_supply_and_no_currents() -> None:
    found = measure_supply(recording(VOLTS, replace(AMPS, amplitude=1e-4)), REFERENCE)

    assert found.line_voltages_V == pytest.approx((RATED_V,) * 3)
    assert found.line_currents_A is None
    assert (found.thd_current, found.active_power_W, found.power_factor) == (None, None, None)
    assert found.current_harmonics == ()
    assert "switched off" in found.reasons[-1]


def test_a_current_that_changes_is_told() -> None:
    record = recording(VOLTS, AMPS)
    record.samples[:3] *= np.linspace(1.0, 0.5, record.samples.shape[1])

    assert "changes by" in measure_supply(record, REFERENCE).reasons[-1]


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (lambda x: x[:, :400], "cycles"),
        (lambda x: np.where(np.arange(x.shape[1]) == 5, np.nan, x), "samples"),
        (lambda x: x * np.array([[1.0]] * 3 + [[1e-3]] * 3), "voltages"),
        (lambda x: np.random.default_rng(0).normal(size=x.shape), "voltages"),
        (lambda x: x * 1e290, "samples"),
    ],
    ids=["short", "missing", "no supply", "noise alone", "far too large"],
)
def test_what_is_no_supply_is_refused_in_words(change: object, named: str) -> None:
    record = recording(VOLTS, AMPS)
    assert callable(change)
    changed = change(record.samples)

    with pytest.raises(NoSupplyError, match=named):
        measure_supply(replace(record, samples=changed), REFERENCE)


def test_a_record_without_voltages_is_refused() -> None:
    record = recording(VOLTS, AMPS)
    currents = replace(record, samples=record.samples[:3], channels=record.channels[:3])

    with pytest.raises(RecordingError, match="voltages"):
        measure_supply(currents, REFERENCE)


def test_figures_are_json_with_lists() -> None:
    document = measure_supply(recording(VOLTS, AMPS), REFERENCE).as_dict()

    assert isinstance(document["line_voltages_V"], list)
    assert document["reasons"] == []
