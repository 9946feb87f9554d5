"""Every format is written and read back, exactly within its quantisation; others read the same."""

from dataclasses import replace
from pathlib import Path

import comtrade as oracle
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.recordings import Channel, Digitals, Quantity, Recording, comtrade, read
from core.recordings.cev.reader import read_event_report
from core.recordings.cev.writer import EventSummary, cev_bytes, write_cev
from core.recordings.comtrade.writer import DataFormat, Revision
from core.units import NANOSECONDS_PER_SECOND

FORMATS: list[tuple[Revision, DataFormat, str]] = [
    (1991, "ASCII", ".cfg"), (1991, "BINARY", ".cfg"), (1999, "ASCII", ".cfg"), (1999, "BINARY", ".CFG"),
    (2013, "ASCII", ".cfg"), (2013, "BINARY", ".cfg"), (2013, "BINARY32", ".cfg"), (2013, "FLOAT32", ".cfg"),
    (2013, "ASCII", ".cff"), (2013, "BINARY", ".cff"), (2013, "BINARY32", ".CFF"), (2013, "FLOAT32", ".cff"),
]  # fmt: skip
names = st.text(
    st.characters(codec="utf-8", categories=["L", "N", "P", "S"], exclude_characters=',"()'),
    min_size=1,
    max_size=8,
)
ascii_names = st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", min_size=1, max_size=8)


@st.composite
def recordings(draw: st.DrawFn, names: st.SearchStrategy[str], start_step_ns: int) -> Recording:
    channels, samples = draw(st.integers(1, 5)), draw(st.integers(1, 40))
    states = draw(st.integers(0, 20))
    scales = draw(st.lists(st.floats(1e-3, 1e6), min_size=channels, max_size=channels))
    unit = st.floats(-1, 1) | st.just(np.nan)
    x = draw(arrays(np.float64, (channels, samples), elements=unit)) * np.array(scales)[:, None]
    bits = draw(arrays(np.bool_, (samples, states)))
    return Recording(
        samples=x,
        sample_rate_hz=draw(st.floats(10, 100_000)),
        start_time_ns=draw(st.integers(0, 3_000_000_000_000_000_000 // start_step_ns)) * start_step_ns,
        channels=tuple(Channel(draw(names), Quantity.OTHER, None, "W", scale) for scale in scales),
        trigger_index=draw(st.integers(0, samples - 1)),
        nominal_frequency_hz=draw(st.none() | st.floats(1, 400)),
        station=draw(names),
        device=draw(names),
        digitals=Digitals.of(tuple(draw(names) for _ in range(states)), bits) if states else None,
    )


def check_same(back: Recording, recording: Recording, quanta: np.ndarray) -> None:
    """Everything alike, values to half a quantum; missing values missing."""
    np.testing.assert_array_equal(np.isnan(back.samples), np.isnan(recording.samples))
    error = np.nan_to_num(np.abs(back.samples - recording.samples))
    assert (error <= 0.5 * quanta[:, None] * (1 + 1e-6)).all(), (error / quanta[:, None]).max()
    assert back.trigger_index == recording.trigger_index
    assert [c.name for c in back.channels] == [c.name for c in recording.channels]
    assert (back.digitals is None) == (recording.digitals is None)
    if back.digitals is not None and recording.digitals is not None:
        assert back.digitals.names == recording.digitals.names
        np.testing.assert_array_equal(back.digitals.packed, recording.digitals.packed)
    assert back.repairs == ()


def quanta_of(recording: Recording, revision: int, data_format: str) -> np.ndarray:
    """What a count stands for in each channel; of FLOAT32 the spacing of its numbers."""
    full_scale = np.array([c.full_scale for c in recording.channels], dtype=np.float64)
    if data_format == "FLOAT32":
        largest = np.nanmax(np.abs(recording.samples), axis=1, initial=1e-30)
        return np.asarray(np.spacing(largest.astype(np.float32)), dtype=np.float64)
    counts = 2**31 - 1 if data_format == "BINARY32" else 32767
    if (revision, data_format) == (1991, "BINARY"):
        counts = 16383
    return np.asarray(full_scale / counts)


@pytest.mark.parametrize(("revision", "data_format", "suffix"), FORMATS)
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_comtrade_round_trip(
    tmp_path_factory: pytest.TempPathFactory,
    revision: Revision,
    data_format: DataFormat,
    suffix: str,
    data: st.DataObject,
) -> None:
    recording = data.draw(recordings(names, start_step_ns=1 if revision == 2013 else 1000))
    path = tmp_path_factory.mktemp("r") / f"R{suffix}"
    back = read(comtrade.write(path, recording, revision=revision, data_format=data_format))
    check_same(back, recording, quanta_of(recording, revision, data_format))
    assert back.sample_rate_hz == recording.sample_rate_hz
    assert back.start_time_ns == recording.start_time_ns
    assert back.nominal_frequency_hz == recording.nominal_frequency_hz
    assert (back.station, back.device) == (recording.station, recording.device)


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_cev_round_trip(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    recording = data.draw(recordings(ascii_names, start_step_ns=1_000_000))
    per_cycle = data.draw(st.sampled_from([4, 16, 32]))
    rate_hz = per_cycle * data.draw(st.sampled_from([50.0, 60.0, 59.98, 49.875]))
    trigger = recording.trigger_index or 0
    recording = replace(recording, sample_rate_hz=rate_hz, nominal_frequency_hz=None)
    summary = EventSummary(
        per_cycle,
        data.draw(st.sampled_from([per_cycle, 4])),
        event=data.draw(ascii_names),
        figures={"IA": data.draw(st.none() | st.floats(0, 1e5))},
        settings=data.draw(st.none() | st.just("FNOM := 60\nRID := A")),
    )
    path = write_cev(tmp_path_factory.mktemp("r") / "R.CEV", recording, summary)
    report = read_event_report(path)
    full_scale = np.array([c.full_scale for c in recording.channels], dtype=np.float64)
    quanta = 10.0 ** -np.maximum(0, np.ceil(-np.log10(full_scale / 32767)))
    if recording.digitals is not None and summary.digital_samples_per_cycle < per_cycle:
        held = np.arange(recording.samples.shape[1]) // (per_cycle // 4) * (per_cycle // 4)
        digitals = recording.digitals
        recording = replace(recording, digitals=Digitals(digitals.names, digitals.packed[held]))
    check_same(report.recording, recording, quanta)
    assert report.recording.sample_rate_hz == pytest.approx(rate_hz, rel=1e-11)
    assert abs(report.recording.trigger_time_ns - recording.trigger_time_ns) <= 1_000_000
    assert report.recording.trigger_index == trigger
    assert report.summary["EVENT"] == summary.event
    assert report.settings == (summary.settings or "")
    assert report.fid == recording.device


@pytest.mark.parametrize(("revision", "data_format", "suffix"), FORMATS)
def test_the_comtrade_package_reads_every_format(
    tmp_path: Path, revision: Revision, data_format: DataFormat, suffix: str
) -> None:
    rng = np.random.default_rng(5)
    recording = Recording(
        samples=rng.uniform(-1, 1, (3, 200)) * np.array([[10.0], [20.0], [700.0]]),
        sample_rate_hz=960.0,
        start_time_ns=1_732_170_600_123_456_000,
        channels=tuple(
            Channel(name, Quantity.OTHER, None, "W", scale)
            for name, scale in (("X", 10.0), ("Y", 20.0), ("Z", 700.0))
        ),
        trigger_index=64,
        nominal_frequency_hz=60.0,
        station="S",
        device="D",
        digitals=Digitals.of(tuple(f"B{k}" for k in range(20)), rng.random((200, 20)) > 0.5),
    )
    path = comtrade.write(tmp_path / f"r{suffix}", recording, revision=revision, data_format=data_format)
    ours = read(path)
    theirs = oracle.load(str(path), use_numpy_arrays=True, use_double_precision=True, ignore_warnings=True)
    np.testing.assert_allclose(np.array(theirs.analog), ours.samples, rtol=1e-6, atol=1e-9)
    assert ours.digitals is not None
    np.testing.assert_array_equal(np.array(theirs.status).T, ours.digitals.unpacked())
    np.testing.assert_allclose(theirs.time, ours.time_s, atol=1e-9)
    assert theirs.rev_year == str(revision)
    assert theirs.ft == data_format


@pytest.mark.parametrize("data_format", ["ASCII", "BINARY"])
def test_samples_that_are_not_evenly_spaced_keep_their_times(tmp_path: Path, data_format: DataFormat) -> None:
    instants = np.concatenate([np.arange(20), 50 + np.arange(20) / 4]) / 1000
    channel = Channel("IA", Quantity.CURRENT, "a", "A", 10.0)
    uneven = Recording(np.ones((1, 40)), 1000.0, 0, (channel,), trigger_index=25, instants_s=instants)
    back = read(comtrade.write(tmp_path / "r.cfg", uneven, data_format=data_format))
    assert back.time_s == pytest.approx(instants, abs=1e-6)
    assert back.trigger_index == 25
    with pytest.raises(ValueError, match="evenly spaced"):
        cev_bytes(uneven, EventSummary(16))
    crowded = replace(uneven, instants_s=instants * 1e-6)
    with pytest.raises(ValueError, match="less than a microsecond"):
        comtrade.data_bytes(crowded)


SMALL = Recording(
    np.ones((1, 4)), 200.0, 0, (Channel("IA", Quantity.CURRENT, "a", "A", 1.0),), trigger_index=0, device="F"
)


@pytest.mark.parametrize(
    ("changes", "options", "reason"),
    [
        ({"digitals": Digitals.of(("A B",), np.ones((4, 1), bool))}, {}, None),
        ({"device": 'F"'}, {}, "cannot be a field"),
        ({"device": "Ü"}, {}, "cannot be a field"),
        ({"channels": (Channel("I(A", Quantity.OTHER, None, "A"),)}, {}, "parentheses"),
        ({"trigger_index": 4}, {}, "trigger at sample 4"),
        ({"samples": np.full((1, 4), np.inf)}, {}, "finite values"),
        ({}, {"digital_samples_per_cycle": 3}, "cannot have 3 relay words"),
        ({}, {"settings": 'RID := "A"'}, "printable ASCII without quotes"),
        ({}, {"figures": {"IA": float("inf")}}, "no number"),
    ],
)
def test_what_an_event_report_cannot_hold(
    changes: dict[str, object], options: dict[str, object], reason: str | None
) -> None:
    recording = replace(SMALL, **changes)  # type: ignore[arg-type]
    summary = replace(EventSummary(4), **options)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=reason or "name of a state"):
        cev_bytes(recording, summary)


@pytest.mark.parametrize(
    ("revision", "data_format", "suffix", "reason"),
    [
        (1991, "BINARY32", ".cfg", "edition 1991 has no format BINARY32, only ASCII, BINARY"),
        (1999, "FLOAT32", ".cfg", "edition 1999 has no format FLOAT32"),
        (2005, "BINARY", ".cfg", "no edition 2005 of COMTRADE, only 1991, 1999, 2013"),
        (1999, "BINARY", ".cff", "a combined file is of the 2013 edition"),
    ],
)
def test_editions_and_their_formats(
    tmp_path: Path, revision: Revision, data_format: DataFormat, suffix: str, reason: str
) -> None:
    with pytest.raises(ValueError, match=reason):
        comtrade.write(tmp_path / f"r{suffix}", SMALL, revision=revision, data_format=data_format)
    late = replace(SMALL, start_time_ns=4_750_000_000 * NANOSECONDS_PER_SECOND)
    with pytest.raises(ValueError, match="two digits of 1991 do not tell the year 2120"):
        comtrade.write(tmp_path / "r.cfg", late, revision=1991)
    assert not list(tmp_path.iterdir())


def test_a_header_is_a_section_of_the_combined_file(tmp_path: Path) -> None:
    path = comtrade.write(tmp_path / "r.cff", SMALL, revision=2013, header_text="EVENT: TRIP")
    assert b"--- file type: HDR ---\r\nEVENT: TRIP\r\n" in path.read_bytes()
    assert read(path).samples.shape == (1, 4)
