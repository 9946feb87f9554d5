"""Envelopes: no peak is lost, and a long record is drawn without being held in memory."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Channel, Quantity, Recording, RecordingError, read, read_envelope, reading
from core.recordings.cev.writer import EventSummary, write_cev
from core.recordings.comtrade.writer import DataFormat, Revision, write
from core.recordings.envelope import IntervalsOf, envelope_of
from core.recordings.errors import RecordingTooLongError
from tests.core.recordings.comtrade_files import RECORD_1999
from tests.core.recordings.test_effort import peak_bytes
from tests.core.recordings.test_written_formats import FORMATS


def wide(channels: int, samples: int, *, missing: bool = True) -> Recording:
    rng = np.random.default_rng(7)
    values = rng.uniform(-1, 1, (channels, samples))
    if missing:
        values[rng.random(values.shape) < 0.2] = np.nan
        values[0] = np.nan
    return Recording(
        samples=values,
        sample_rate_hz=10_000.0,
        start_time_ns=1_760_000_000_000_000_000,
        channels=tuple(Channel(f"I{k}", Quantity.CURRENT, None, "A", 1.0) for k in range(channels)),
        trigger_index=samples // 2,
    )


def always(intervals: int) -> IntervalsOf:
    """So many for any recording."""
    return lambda *_: intervals


def extremes(values: np.ndarray, intervals: int) -> tuple[list[float], list[float]]:
    """By the definition, sample by sample."""
    starts = [k * values.size // intervals for k in range(intervals)]
    parts = [values[a:b] for a, b in zip(starts, [*starts[1:], values.size], strict=True)]
    present: Sequence[np.ndarray] = [part[~np.isnan(part)] for part in parts]
    return (
        [part.min() if part.size else np.nan for part in present],
        [part.max() if part.size else np.nan for part in present],
    )


def test_extremes_are_those_of_each_interval() -> None:
    recording = wide(5, 1003)
    envelope = envelope_of(recording, always(100))
    for values, lowest, highest in zip(recording.samples, envelope.lowest, envelope.highest, strict=True):
        starts = np.linspace(0, 1003, 100, endpoint=False).astype(int)
        np.testing.assert_array_equal(lowest, np.fmin.reduceat(values, starts))
        np.testing.assert_array_equal(highest, np.fmax.reduceat(values, starts))
    even = envelope_of(wide(2, 1000), always(40))
    low, high = extremes(wide(2, 1000).samples[1], 40)
    np.testing.assert_array_equal((even.lowest[1], even.highest[1]), (low, high))


@pytest.mark.parametrize(("revision", "data_format", "suffix"), FORMATS)
@pytest.mark.parametrize("intervals", [1, 7, 3000])
def test_read_block_by_block_it_is_the_same(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    revision: Revision,
    data_format: DataFormat,
    suffix: str,
    intervals: int,
) -> None:
    path = write(tmp_path / f"r{suffix}", wide(40, 3000), revision=revision, data_format=data_format)
    whole = read_envelope(path, always(intervals))
    monkeypatch.setattr(reading, "MOST_VALUES_HELD", 1)
    monkeypatch.setattr("core.recordings.comtrade.data._BLOCK_BYTES", 20_000)
    monkeypatch.setattr("core.recordings.comtrade.ascii_samples._BLOCK_BYTES", 20_000)
    parts = read_envelope(path, always(intervals))
    assert whole.lowest.shape == parts.lowest.shape == (40, intervals)
    np.testing.assert_array_equal(parts.lowest, whole.lowest)
    np.testing.assert_array_equal(parts.highest, whole.highest)
    np.testing.assert_array_equal(parts.times_s, whole.times_s)
    assert replace(parts, lowest=0, highest=0, times_s=0) == replace(whole, lowest=0, highest=0, times_s=0)  # type: ignore[arg-type]  # arrays are compared above


def test_a_negative_factor_exchanges_the_extremes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    negative = RECORD_1999.but(
        analog=tuple(line.replace(",0.01,", ",-0.01,") for line in RECORD_1999.analog),
        stamps=(0, 1000, 2000, 9000, 10_000),
    )
    (tmp_path / "r.cfg").write_text(negative.configuration())
    (tmp_path / "r.dat").write_bytes(negative.data())
    whole = read_envelope(tmp_path / "r.cfg", always(2))
    monkeypatch.setattr(reading, "MOST_VALUES_HELD", 1)
    parts = read_envelope(tmp_path / "r.cfg", always(2))
    assert (parts.lowest <= parts.highest).all()
    np.testing.assert_array_equal(parts.lowest, whole.lowest)
    np.testing.assert_array_equal(parts.times_s, whole.times_s)


@pytest.mark.parametrize(("data_format", "samples"), [("BINARY", 5000), ("ASCII", 1000)])
def test_a_long_record_is_never_in_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, data_format: DataFormat, samples: int
) -> None:
    path = write(tmp_path / "r.cfg", wide(400, samples, missing=False), data_format=data_format)
    monkeypatch.setattr(reading, "MOST_VALUES_HELD", 1)
    held = 400 * samples * 8
    assert peak_bytes(lambda: read_envelope(path, always(10))) < 0.6 * held


def test_a_recording_beyond_the_length_asked_for_is_refused_before_it_is_held(tmp_path: Path) -> None:
    short = wide(6, 1000, missing=False)
    summary = EventSummary(samples_per_cycle=200)
    for path in (write(tmp_path / "r.cfg", short), write_cev(tmp_path / "r.cev", short, summary)):
        assert read(path, most_values=10_000).samples.shape == (6, 1000)
        with pytest.raises(RecordingTooLongError, match="at most 9999 values"):
            read(path, most_values=9999)


def test_more_samples_than_times_are_held_for_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "r.cfg", wide(1, 1000))
    monkeypatch.setattr(reading, "MOST_VALUES_HELD", 1)
    monkeypatch.setattr("core.recordings.comtrade.envelope.MOST_SAMPLES", 999)
    with pytest.raises(RecordingError, match="1000 samples"):
        read_envelope(path, always(10))
