"""Records of one recorder that overlap, put together."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from core.recordings import Channel, Digitals, Quantity, Recording
from core.recordings.joining import JoinError, join, join_longest, seam

RATE_HZ = 2_000.0
START_NS = 1_700_000_000_000_000_000
CHANNELS = tuple(
    Channel(f"{letter}{phase.upper()}", quantity, phase, unit)
    for letter, quantity, unit in (("I", Quantity.CURRENT, "A"), ("V", Quantity.PHASE_VOLTAGE, "V"))
    for phase in "abc"
)
PEAKS = np.array([10.0] * 3 + [300.0] * 3)[:, None]


def waveform(times_s: NDArray[np.float64], noise: float = 0.0, seed: int = 0) -> NDArray[np.float64]:
    """Three-phase currents with a sideband 1.3 Hz below the line frequency, and voltages."""
    phases = np.array([0.0, -2.0, 2.0, 0.5, -1.5, 2.5])[:, None]
    swing = np.array([0.03] * 3 + [0.0] * 3)[:, None]
    x = np.cos(2 * np.pi * 50.2 * times_s + phases) + swing * np.cos(2 * np.pi * 48.9 * times_s + 3 * phases)
    random = np.random.default_rng(seed)
    samples: NDArray[np.float64] = PEAKS * (x + noise * random.standard_normal(x.shape))
    return samples


def record(begin_s: float, length_s: float = 1.0, *, late_s: float = 0.0, noise: float = 0.0) -> Recording:
    """What a recorder has from `begin_s` on, with a time stamp that is late by `late_s`."""
    times_s = begin_s + np.arange(round(length_s * RATE_HZ)) / RATE_HZ
    bits = (times_s > 1.5)[:, None]
    return Recording(
        samples=waveform(times_s, noise, seed=round(1e6 * (begin_s + 1.0))),
        sample_rate_hz=RATE_HZ,
        start_time_ns=START_NS + round((begin_s + late_s) * 1e9),
        channels=CHANNELS,
        trigger_index=400,
        nominal_frequency_hz=50.0,
        digitals=Digitals.of(("RB01",), bits),
        source=f"{begin_s:g}.CFG",
    )


def series(begins_s: Sequence[float], **kwargs: float) -> list[Recording]:
    return [record(begin_s, **kwargs) for begin_s in begins_s]


def test_joined_records_are_the_record_that_one_long_capture_gives() -> None:
    joined = join(series([0.0, 0.9, 1.8, 2.65]))
    whole = record(0.0, 3.65)
    assert np.abs(joined.recording.samples - whole.samples).max() < 1e-9
    assert joined.recording.start_time_ns == START_NS
    assert joined.recording.trigger_index == 400
    states, expected = joined.recording.digitals, whole.digitals
    assert states is not None
    assert expected is not None
    assert np.array_equal(states.state("RB01"), expected.state("RB01"))
    assert joined.parts == (0, 1, 2, 3)
    assert joined.refusals == ()
    assert [one.overlap_s for one in joined.seams] == pytest.approx([0.1, 0.1, 0.15])


@pytest.mark.parametrize("late_s", [3e-3, -3e-3, 0.4e-3])
def test_waveforms_tell_the_place_to_a_fraction_of_a_sample_whatever_the_stamps_say(late_s: float) -> None:
    between = 0.8 + 0.37 / RATE_HZ
    found = seam(record(0.0, noise=0.003), record(between, late_s=late_s, noise=0.003))
    assert found.offset == pytest.approx(between * RATE_HZ, abs=0.01)
    assert found.stamp_error_s == pytest.approx(late_s, abs=5e-6)
    assert found.difference < 0.01


def test_a_record_on_another_grid_of_samples_is_brought_to_that_of_the_first() -> None:
    joined = join([record(0.0), record(0.8 + 0.37 / RATE_HZ)]).recording
    times_s = np.arange(joined.samples.shape[1]) / RATE_HZ
    away = np.abs(joined.samples - waveform(times_s)) / PEAKS
    assert away[:, :-5].max() < 1e-3  # of the last samples, which have neighbours on one side, 1 %
    assert away.max() < 1e-2


def test_records_of_a_motor_that_stands_are_joined_by_their_voltages() -> None:
    off = [replace(one, samples=one.samples * (PEAKS > 100)) for one in series([0.0, 0.9])]
    assert join(off).recording.duration_s == pytest.approx(1.9)


def test_missing_samples_count_for_nothing() -> None:
    first, second = series([0.0, 0.9])
    second.samples[2, 50:60] = np.nan
    assert join([first, second]).seams[0].offset == pytest.approx(1800.0, abs=0.02)


def another_rate(one: Recording) -> Recording:
    return replace(one, sample_rate_hz=RATE_HZ * 1.001)


def swapped(one: Recording) -> Recording:
    return replace(one, samples=one.samples[[1, 0, 2, 3, 4, 5]])


def renamed(one: Recording) -> Recording:
    return replace(one, channels=one.channels[::-1])


def stepped(one: Recording) -> Recording:
    return replace(one, start_time_ns=(one.start_time_ns or 0) + 8_000_000)


def changed_ratio(one: Recording) -> Recording:
    return replace(one, samples=one.samples * np.array([1.0, 1.0, 1.1, 1.0, 1.0, 1.0])[:, None])


def uneven(one: Recording) -> Recording:
    return replace(one, instants_s=np.arange(one.samples.shape[1]) / RATE_HZ)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (another_rate, "sampling rate: expected 2000 Hz, that of 0.CFG, found 2002 Hz"),
        (swapped, "the clock was set, or they are of another motor"),
        (renamed, "channels: expected those of 0.CFG"),
        (stepped, "the clock was set, or they are of another motor"),
        (changed_ratio, "the clock was set, or they are of another motor"),
        (uneven, "samples: expected one sampling rate throughout"),
    ],
)
def test_records_that_disagree_are_refused(change: Callable[[Recording], Recording], said: str) -> None:
    first, second = series([0.0, 0.9])
    with pytest.raises(JoinError) as refusal:
        join([first, change(second)])
    assert said in str(refusal.value)


@pytest.mark.parametrize("begin_s", [1.0, 0.99, 1.3, -0.2, 0.0])
def test_records_that_do_not_overlap_by_a_cycle_are_refused(begin_s: float) -> None:
    with pytest.raises(JoinError, match="a cycle or more before its end"):
        join([record(0.0), record(begin_s)])


def test_the_longest_run_is_joined_and_the_rest_told() -> None:
    joined = join_longest(series([0.0, 0.9, 2.0, 2.9, 3.8, 5.0]))
    assert joined.parts == (2, 3, 4)
    assert joined.recording.duration_s == pytest.approx(2.8)
    assert joined.recording.start_time_ns == START_NS + 2_000_000_000
    assert len(joined.refusals) == 2
    assert "found 1.100 s after it" in joined.refusals[0]


def test_one_record_is_itself() -> None:
    only = record(0.0)
    alone = join([only])
    assert np.array_equal(alone.recording.samples, only.samples)
    assert (alone.recording.source, alone.seams) == (only.source, ())
    with pytest.raises(ValueError, match="no records"):
        join([])
