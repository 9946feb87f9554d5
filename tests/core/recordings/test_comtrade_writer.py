"""What is written is read back, by our reader and by the `comtrade` package, sample for sample."""

import struct
import time
from dataclasses import replace
from pathlib import Path

import comtrade as oracle
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.recordings import Channel, Quantity, Recording, comtrade, read

CHANNELS = (
    Channel("IA", Quantity.CURRENT, "a", "A", 20.0),
    Channel("IB", Quantity.CURRENT, "b", "A", 20.0),
    Channel("IC", Quantity.CURRENT, "c", "A", 20.0),
    Channel("VAB", Quantity.LINE_VOLTAGE, "ab", "V", 700.0),
    Channel("VBC", Quantity.LINE_VOLTAGE, "bc", "V", 700.0),
    Channel("Speed", Quantity.OTHER, None, "rpm", 3000.0),
)
FULL_SCALE = np.array([[c.full_scale] for c in CHANNELS], dtype=np.float64)
RECORDING = Recording(
    samples=FULL_SCALE * np.random.default_rng(3).uniform(-1, 1, (6, 500)),
    sample_rate_hz=10_000.0,
    start_time_ns=1_732_170_600_123_456_000,
    channels=CHANNELS,
    trigger_index=200,
    nominal_frequency_hz=50.0,
    station="FACTORY_A",
    device="A1_SEL710",
)


def test_a_recording_comes_back_within_half_a_count(tmp_path: Path) -> None:
    path = comtrade.write(tmp_path / "HR_10000", RECORDING, header_text="Event: TRIP\r\n")
    assert {file.name for file in tmp_path.iterdir()} == {"HR_10000.CFG", "HR_10000.DAT", "HR_10000.HDR"}
    assert path.with_suffix(".HDR").read_bytes() == b"Event: TRIP\r\n"
    back = read(path)
    assert np.all(np.abs(back.samples - RECORDING.samples) <= FULL_SCALE / 32767 * 0.5001)
    for name in (
        "sample_rate_hz",
        "start_time_ns",
        "trigger_index",
        "nominal_frequency_hz",
        "station",
        "device",
    ):
        assert getattr(back, name) == getattr(RECORDING, name), name
    for written, found in zip(CHANNELS, back.channels, strict=True):
        assert replace(found, full_scale=None) == replace(written, full_scale=None)
        assert found.full_scale == pytest.approx(written.full_scale)


def test_what_has_been_quantised_once_is_not_changed_again(tmp_path: Path) -> None:
    first = read(comtrade.write(tmp_path / "first", RECORDING))
    second = read(comtrade.write(tmp_path / "second", first))
    np.testing.assert_array_equal(second.samples, first.samples)


def test_the_comtrade_package_reads_the_same(tmp_path: Path) -> None:
    path = comtrade.write(tmp_path / "record.cfg", RECORDING)
    ours = read(path)
    theirs = oracle.load(str(path), use_numpy_arrays=True, use_double_precision=True)
    np.testing.assert_array_equal(np.array(theirs.analog), ours.samples)
    assert theirs.analog_channel_ids == [c.name for c in ours.channels]
    assert theirs.cfg.sample_rates == [[10_000.0, 500]]
    assert theirs.cfg.rev_year == "1999"
    np.testing.assert_allclose(theirs.time, np.arange(500) / 10_000, atol=1e-12)
    assert theirs.trigger_time == pytest.approx(0.02)
    start = theirs.start_timestamp
    assert start.isoformat() == "2024-11-21T06:30:00.123456"


def test_a_second_of_six_channels_is_read_within_10_ms(tmp_path: Path) -> None:
    samples = np.tile(RECORDING.samples, 20)
    path = comtrade.write(tmp_path / "R", replace(RECORDING, samples=samples))
    durations = []
    for _ in range(10):
        begin = time.process_time()
        assert read(path).samples.shape == (6, 10_000)
        durations.append(time.process_time() - begin)
    assert min(durations) < 0.01


def test_counts_are_rounded_clipped_and_marked(tmp_path: Path) -> None:
    samples = np.array([[0.0, 0.4, 0.6, -0.6, 32767, 40_000, -40_000, np.inf, np.nan]])
    channel = Channel("IA", Quantity.CURRENT, "a", "A", 32767.0)
    data = comtrade.data_bytes(replace(RECORDING, samples=samples, channels=(channel,), trigger_index=None))
    rows = list(struct.iter_unpack("<IIh", data))
    assert [row[2] for row in rows] == [0, 0, 1, -1, 32767, 32767, -32767, 32767, -32768]
    assert rows[8][:2] == (9, 800)


def test_the_suffix_given_sets_the_case(tmp_path: Path) -> None:
    comtrade.write(tmp_path / "lower.cfg", RECORDING, header_text="")
    comtrade.write(tmp_path / "UPPER.CFG", RECORDING)
    comtrade.write(tmp_path / "with.point", RECORDING)
    assert {file.name for file in tmp_path.iterdir()} == {
        "lower.cfg", "lower.dat", "lower.hdr", "UPPER.CFG", "UPPER.DAT", "with.point.CFG", "with.point.DAT"
    }  # fmt: skip


def test_the_configuration_appears_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    appeared: list[str] = []
    rename = Path.replace

    def watched(self: Path, target: Path) -> Path:
        appeared.append(target.name)
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", watched)
    comtrade.write(tmp_path / "R", RECORDING, header_text="h")
    assert appeared == ["R.HDR", "R.DAT", "R.CFG"]


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"station": "A,B"}, "'A,B' cannot be a field"),
        ({"device": "line\r\nend"}, "cannot be a field"),
        ({"channels": (*CHANNELS[:5], replace(CHANNELS[5], full_scale=None))}, "'Speed' needs a full scale"),
        (
            {"channels": (*CHANNELS[:5], replace(CHANNELS[5], full_scale=np.inf))},
            "'Speed' needs a full scale",
        ),
        ({"trigger_index": 500}, "trigger at sample 500 of a recording of 500"),
        ({"samples": np.zeros((6, 0)), "trigger_index": None}, "trigger at sample 0 of a recording of 0"),
        ({"sample_rate_hz": 0.1}, "at most 4294 s"),
    ],
)
def test_what_the_format_cannot_hold_is_refused(
    tmp_path: Path, changes: dict[str, object], reason: str
) -> None:
    with pytest.raises(ValueError, match=reason):
        comtrade.write(tmp_path / "R", replace(RECORDING, **changes))  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


names = st.text(
    st.characters(codec="utf-8", categories=["L", "N", "P", "S"], exclude_characters=","), max_size=12
)


@settings(deadline=None)
@given(
    counts=arrays(
        np.int16, st.tuples(st.integers(1, 5), st.integers(1, 40)), elements=st.integers(-32767, 32767)
    ),
    full_scale=st.floats(1e-3, 1e6),
    rate_hz=st.floats(1, 200_000),
    start_us=st.integers(0, 4_102_444_800_000_000),
    station=names,
    frequency=st.none() | st.floats(1, 400),
    data=st.data(),
)
def test_round_trip(
    tmp_path_factory: pytest.TempPathFactory,
    *,
    counts: np.ndarray,
    full_scale: float,
    rate_hz: float,
    start_us: int,
    station: str,
    frequency: float | None,
    data: st.DataObject,
) -> None:
    recording = Recording(
        samples=counts * (full_scale / 32767),
        sample_rate_hz=rate_hz,
        start_time_ns=start_us * 1000,
        channels=tuple(Channel(data.draw(names), Quantity.OTHER, None, "W", full_scale) for _ in counts),
        trigger_index=data.draw(st.integers(0, counts.shape[1] - 1)),
        nominal_frequency_hz=frequency,
        station=station,
    )
    back = read(comtrade.write(tmp_path_factory.mktemp("r") / "R", recording))
    np.testing.assert_allclose(back.samples, recording.samples, rtol=1e-12)
    assert back.sample_rate_hz == rate_hz
    assert back.start_time_ns == recording.start_time_ns
    assert back.trigger_index == recording.trigger_index
    assert back.nominal_frequency_hz == frequency
    assert back.station == station
    assert [c.name for c in back.channels] == [c.name for c in recording.channels]
