"""What is measured of a start, against the simulator's own speed and against plain arithmetic."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from core.machines.parameters import Motor
from core.recordings import Recording
from core.starts.errors import NoStartError
from core.starts.measuring import MOST_POINTS, measure_start
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.motors import ALL, LARGE, MEDIUM, REFERENCE
from testing.machines.starts import TRUE_RATE_HZ, StartRecord

CYCLE_S = 0.02


def reached_s(motor: Motor, load: float, duration_s: float, share: float) -> float:
    """Return when the simulated shaft reaches a share of its final speed."""
    plate = motor.nameplate
    supply = Supply(plate.rated_voltage_V, plate.rated_frequency_Hz)
    plant = MotorPlant(motor, supply, Load(load), Sensors(1.0, 1.0))
    speed = plant.start_up(0.0, duration_s, TRUE_RATE_HZ).speed_rad_s
    return float(np.argmax(speed >= share * speed[-1])) / TRUE_RATE_HZ


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("busbar", [False, True], ids=["behind the contactor", "at the busbar"])
def test_acceleration_lasts_until_the_shaft_is_near_its_speed(motor: Motor, busbar: bool) -> None:
    record = StartRecord(load_level=0.5, duration_s=1.5, busbar=busbar, snr_db=40.0).of(motor)

    start = measure_start(record, motor)

    assert start.is_from_rest
    assert start.acceleration_s is not None
    early_s, late_s = (reached_s(motor, 0.5, 1.5, share) for share in (0.85, 1.0))
    assert early_s - CYCLE_S <= start.acceleration_s <= late_s + 2.5 * CYCLE_S
    assert start.i2t_over_s == start.acceleration_s


def test_a_heavier_load_takes_longer_and_heats_more() -> None:
    light, heavy = (measure_start(StartRecord(load_level=load).of(MEDIUM), MEDIUM) for load in (0.1, 1.0))

    assert light.acceleration_s is not None
    assert heavy.acceleration_s is not None
    assert heavy.acceleration_s > light.acceleration_s
    assert heavy.i2t_A2s > light.i2t_A2s


def test_i2t_is_the_integral_of_the_mean_square() -> None:
    record = StartRecord(before_s=0.0, duration_s=0.5).of(LARGE)
    start = measure_start(record, LARGE)

    samples = round(start.i2t_over_s * record.sample_rate_hz)
    by_hand = (
        sum(float(np.sum(row[:samples] ** 2)) for row in record.samples[:3]) / 3.0 / record.sample_rate_hz
    )

    assert start.i2t_A2s == pytest.approx(by_hand, rel=0.01)


def test_peak_and_crest_are_those_of_the_samples() -> None:
    record = StartRecord().of(REFERENCE)
    start = measure_start(record, REFERENCE)

    assert start.crest_current_A == pytest.approx(np.abs(record.samples[:3]).max(), rel=0.01)
    assert start.peak_current_A == pytest.approx(max(start.curve.current_A), rel=0.15)
    assert start.running_current_A is not None
    assert start.peak_current_A > 3.0 * start.running_current_A


def test_the_mean_current_is_that_of_the_samples_of_the_run_up() -> None:
    record = StartRecord(snr_db=60.0).of(REFERENCE)
    start = measure_start(record, REFERENCE)

    assert start.acceleration_s is not None
    assert start.mean_current_A is not None
    assert start.running_current_A is not None
    assert start.running_current_A < start.mean_current_A < start.peak_current_A
    rows = record.samples[:3]
    beginning = int(np.flatnonzero(np.abs(rows).max(axis=0) > 0.1 * np.abs(rows).max())[0])
    during = rows[:, beginning : beginning + round(start.acceleration_s * record.sample_rate_hz)]
    assert start.mean_current_A == pytest.approx(float(np.sqrt(np.mean(during**2))), rel=0.02)


@pytest.mark.parametrize("lines", [False, True], ids=["phase voltages", "two line voltages"])
def test_the_lowest_voltage_is_that_of_the_start_not_of_the_time_before(lines: bool) -> None:
    record = StartRecord(lines=lines).of(MEDIUM)
    samples = record.samples.copy()
    dip = slice(round(0.06 * record.sample_rate_hz), round(0.12 * record.sample_rate_hz))
    samples[3:, dip] *= 0.85

    start = measure_start(replace(record, samples=samples), MEDIUM)

    assert start.lowest_voltage_V == pytest.approx(0.85 * MEDIUM.nameplate.rated_voltage_V, rel=0.01)


def test_a_record_that_ends_within_the_start_tells_no_acceleration_time() -> None:
    start = measure_start(StartRecord(duration_s=0.1).of(LARGE), LARGE)

    assert start.is_from_rest
    assert start.acceleration_s is None
    assert start.mean_current_A is None
    assert start.running_current_A is None
    assert start.i2t_over_s == pytest.approx(0.1, abs=0.01)


def test_a_record_that_begins_within_the_start_tells_no_acceleration_time_but_the_rest() -> None:
    record = StartRecord(before_s=0.0, duration_s=1.0).of(LARGE)
    cut = round(0.15 * record.sample_rate_hz)
    late = replace(record, samples=record.samples[:, cut:], trigger_index=0)

    start = measure_start(late, LARGE)

    assert not start.is_from_rest
    assert start.acceleration_s is None
    assert start.running_current_A is not None
    assert start.peak_current_A > 1.5 * start.running_current_A


def test_a_long_start_has_a_bounded_curve() -> None:
    rate_hz, cycles = 400.0, 5_000
    t = np.arange(round(cycles * rate_hz / 50.0)) / rate_hz
    amps = np.where(t < 80.0, 60.0, 10.0) * sqrt(2.0)
    amps[t < 1.0] = 0.0
    angle = 2.0 * np.pi * 50.0 * t
    currents = [amps * np.sin(angle - k * 2.0 * np.pi / 3.0 + 0.3) for k in range(3)]
    short = StartRecord(duration_s=0.1).of(MEDIUM)
    record = Recording(np.vstack(currents), rate_hz, 0, short.channels[:3], source="long")

    start = measure_start(record, MEDIUM)

    assert start.acceleration_s == pytest.approx(79.0, abs=0.05)
    assert start.peak_current_A == pytest.approx(60.0, rel=0.02)
    assert start.i2t_A2s == pytest.approx(79.0 * 60.0**2, rel=0.01)
    assert start.lowest_voltage_V is None
    assert start.curve.voltage_V is None
    assert len(start.curve.current_A) <= MOST_POINTS
    assert start.curve.step_s * len(start.curve.current_A) == pytest.approx(99.0, abs=0.5)


@pytest.mark.parametrize(
    ("spoil", "field"),
    [
        (lambda x: np.where(np.arange(x.shape[1]) == 7, np.nan, x), "samples"),
        (lambda x: x[:, :500], "duration"),
        (lambda x: np.zeros_like(x), "currents"),
    ],
    ids=["missing samples", "two cycles", "no current"],
)
def test_what_shows_no_start_is_refused(spoil: object, field: str) -> None:
    record = StartRecord(before_s=0.0, duration_s=0.3).of(MEDIUM)
    assert callable(spoil)

    with pytest.raises(NoStartError) as refused:
        measure_start(replace(record, samples=spoil(record.samples)), MEDIUM)

    assert refused.value.field == field
