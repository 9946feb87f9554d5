"""Several sampling rates, and gaps in the time stamps: every sample keeps its time."""

from pathlib import Path

import numpy as np
import pytest

from core.recordings import RecordingError, read
from core.recordings.resampling import evenly_spaced
from tests.core.recordings.comtrade_files import RECORD_1999, RECORD_2013, ComtradeFile


def long_record(count: int, **changes: object) -> ComtradeFile:
    changes = {
        "rates": ("1", f"1000,{count}"),
        "rows": [(k, -k, 2 * k, k % 7) for k in range(count)],
        "numbers": range(1, count + 1),
        "stamps": [1000 * k for k in range(count)],
    } | changes
    return RECORD_1999.but(**changes)


@pytest.mark.parametrize("data_format", ["ASCII", "BINARY"])
def test_a_gap_in_the_time_stamps_is_kept(tmp_path: Path, data_format: str) -> None:
    record = RECORD_1999.but(data_format=data_format, stamps=(0, 1000, 2000, 9000, 10_000))
    recording = read(record.write(tmp_path))
    assert recording.sample_rate_hz == 1000
    assert recording.time_s == pytest.approx([0, 0.001, 0.002, 0.009, 0.010])
    assert recording.duration_s == pytest.approx(0.011)
    assert recording.trigger_index == 2
    assert recording.repairs == ()


def test_several_gaps_and_stamps_missing_beside_them(tmp_path: Path) -> None:
    stamps: list[int | None] = [1000 * k + 5000 * (k >= 10) + 40_000 * (k >= 30) for k in range(40)]
    stamps[12] = stamps[20] = None
    recording = read(long_record(40, stamps=stamps).write(tmp_path))
    gaps = np.flatnonzero(np.diff(recording.time_s) > 0.0015) + 1
    assert gaps.tolist() == [10, 30]
    assert recording.time_s[[9, 10, 12, 39]] == pytest.approx([0.009, 0.015, 0.017, 0.084])


def test_the_trigger_is_found_behind_a_gap(tmp_path: Path) -> None:
    record = RECORD_1999.but(stamps=(0, 1000, 2000, 9000, 10_000), trigger="21/11/2024,06:30:00.259100")
    recording = read(record.write(tmp_path))
    assert recording.trigger_index == 3
    assert recording.trigger_time_ns - recording.first_time_ns == 9_000_000
    late = record.but(trigger="21/11/2024,06:30:00.262000")
    with pytest.raises(RecordingError, match="time of the trigger"):
        read(late.write(tmp_path))


@pytest.mark.parametrize("stamped", [True, False])
def test_several_rates(tmp_path: Path, stamped: bool) -> None:
    times = [0, 1000, 2000, 2250, 2500]
    record = RECORD_1999.but(rates=("2", "1000,3", "4000,5"), stamps=times if stamped else [None] * 5)
    recording = read(record.write(tmp_path))
    assert recording.sample_rate_hz == 1000
    assert recording.time_s * 1e6 == pytest.approx(times)


def test_the_first_step_of_a_new_rate_is_as_the_stamps_tell(tmp_path: Path) -> None:
    record = RECORD_1999.but(rates=("2", "1000,3", "4000,5"), stamps=[0, 1000, 2000, 3000, 3250])
    assert read(record.write(tmp_path)).time_s * 1e6 == pytest.approx([0, 1000, 2000, 3000, 3250])


def test_time_does_not_go_back_where_the_rate_changes(tmp_path: Path) -> None:
    record = RECORD_1999.but(rates=("2", "1000,3", "4000,5"), stamps=[0, 1000, 2000, 1400, 1650])
    with pytest.raises(RecordingError, match="sample 4, time stamp"):
        read(record.write(tmp_path))


def test_rates_beside_times_in_nanoseconds(tmp_path: Path) -> None:
    record = RECORD_2013.but(rates=("2", "1000,2", "500,5"), stamps=[0, 1000, 3000, 5000, 7000])
    assert read(record.write(tmp_path)).time_s * 1e3 == pytest.approx([0, 1, 3, 5, 7])


def test_microseconds_beside_dates_in_nanoseconds(tmp_path: Path) -> None:
    """Editions before 2013 know no nanoseconds; stamps that are nanoseconds by the rate are read as such."""
    dates = {"start": "21/11/2024,06:30:00.250000000", "trigger": "21/11/2024,06:30:00.252000000"}
    recording = read(RECORD_1999.but(**dates).write(tmp_path))
    assert (recording.trigger_index, recording.instants_s) == (2, None)
    (warning,) = recording.warnings
    assert warning.endswith("the time stamps are microseconds, not nanoseconds as the dates are")
    fine = [1_000_000 * k for k in range(5)]
    assert read(RECORD_1999.but(**dates, stamps=fine).write(tmp_path)).warnings == ()
    for record in (RECORD_2013.but(**dates), RECORD_1999.but(**dates, stamps=[10 * k for k in range(5)])):
        with pytest.raises(RecordingError, match="time stamp"):
            read(record.write(tmp_path))


def test_stamps_that_contradict_one_of_the_rates_are_refused(tmp_path: Path) -> None:
    stamps = [1000 * k for k in range(10)] + [9000 + 1000 * k for k in range(1, 31)]
    record = long_record(40, rates=("2", "1000,10", "4000,40"), stamps=stamps)
    with pytest.raises(RecordingError, match=r"sample 12, time stamp: .*4000 Hz"):
        read(record.write(tmp_path))


def test_without_rates_the_stamps_are_the_time(tmp_path: Path) -> None:
    record = RECORD_1999.but(rates=("0", "0,5"), stamps=(100, 1100, 2100, 9100, 10_100))
    recording = read(record.write(tmp_path))
    assert recording.time_s == pytest.approx([0, 0.001, 0.002, 0.009, 0.010])
    assert recording.sample_rate_hz == pytest.approx(1000)


def test_one_lost_sample_among_many_is_a_gap(tmp_path: Path) -> None:
    stamps = [1000 * k + 1000 * (k >= 20) for k in range(40)]
    for rates in (("1", "1000,40"), ("0", "0,40")):
        recording = read(long_record(40, rates=rates, stamps=stamps).write(tmp_path))
        assert recording.time_s * 1e6 == pytest.approx(stamps)


def test_a_rate_that_follows_the_line_is_brought_to_even_spacing(tmp_path: Path) -> None:
    """16 samples a cycle of a line that goes from 50 to 49 Hz; the wave is as steady as the samples."""
    count = 400
    period_us = 1e6 / 16 / np.linspace(50, 49, count - 1)
    t_us = np.concatenate([[0], np.cumsum(period_us)])
    wave = np.cos(2 * np.pi * 60e-6 * t_us)
    record = long_record(
        count,
        rates=("0", f"0,{count}"),
        rows=[(x, 0, 0, 0) for x in np.rint(30_000 * wave).astype(int).tolist()],
        stamps=np.rint(t_us).astype(int).tolist(),
    )
    recording = read(record.write(tmp_path))
    assert recording.instants_s is not None
    even = evenly_spaced(recording)
    assert even.instants_s is None
    assert even.sample_rate_hz == pytest.approx((count - 1) / t_us[-1] * 1e6, rel=1e-6)
    expected = 300 * np.cos(2 * np.pi * 60 * even.time_s)
    assert even.samples[0, 3:-3] == pytest.approx(expected[3:-3], abs=0.3)
    assert even.digitals is not None
    assert even.trigger_index == recording.trigger_index == 2
    assert evenly_spaced(even) is even


@pytest.mark.parametrize(
    "changes",
    [
        {"stamps": (0, 1000, 2000, 9000, 10_000)},
        {"rates": ("2", "1000,3", "4000,5"), "stamps": (0, 1000, 2000, 2250, 2500)},
    ],
)
def test_nothing_is_interpolated_across_a_gap(tmp_path: Path, changes: dict[str, object]) -> None:
    recording = read(RECORD_1999.but(**changes).write(tmp_path))
    with pytest.raises(RecordingError, match=r"record.cfg: sampling: expected one sampling rate and no gap"):
        evenly_spaced(recording)


def test_skew_is_removed_on_each_side_of_a_gap(tmp_path: Path) -> None:
    t_us = np.concatenate([np.arange(60), np.arange(200, 280)]) * 1000
    angle = 2 * np.pi * 50e-6
    record = long_record(
        140,
        analog=(
            "1,IA,A,,A,0.001,0,0,-1,1,1,1,P",
            "2,IB,B,,A,0.001,0,300,-1,1,1,1,P",
            *RECORD_1999.analog[2:],
        ),
        rows=[
            (round(2e4 * np.cos(angle * t)), round(2e4 * np.cos(angle * (t + 300))), 0, 0)
            for t in t_us.tolist()
        ],
        stamps=t_us.tolist(),
    )
    samples = read(record.write(tmp_path)).samples
    inner = np.r_[3:57, 63:137]
    assert samples[1, inner] == pytest.approx(samples[0, inner], abs=0.003)
    assert samples[1] == pytest.approx(samples[0], abs=0.2)
