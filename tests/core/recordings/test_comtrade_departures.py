"""What recorders write beside the standard: what is read with a warning, and what only leniently."""

from pathlib import Path

import comtrade as oracle
import numpy as np
import pytest

from core.recordings import Recording, RecordingError, read, read_envelope
from core.recordings.errors import UnknownTimeError
from tests.core.recordings.comtrade_files import (
    ANALOG_LINES,
    RECORD_1991,
    RECORD_1999,
    RECORD_2013,
    ComtradeFile,
)

SPARES = (
    *ANALOG_LINES,
    "5,SPARE 1,,,A,0,0,0,0,0,0,0,S",
    "6,SPARE 2,,,V,0.000,-2.5,,-32767,32767,1,1,P",
    "7,UREF,,,kV,0,0.1,0,0,0,400,100,S",
)
ROWS = tuple((*row, k, -k, 99) for k, row in enumerate(RECORD_1999.rows))
WITH_SPARES = RECORD_1999.but(counts="9,7A,2D", analog=SPARES, rows=ROWS)


def lenient_alone(path: Path, *notes: str) -> Recording:
    with pytest.raises(RecordingError):
        read(path)
    recording = read(path, lenient=True)
    assert len(recording.repairs) == len(notes), recording.repairs
    for repair, note in zip(recording.repairs, notes, strict=True):
        assert note in repair, repair
    return recording


@pytest.mark.parametrize("data_format", ["BINARY", "ASCII"])
def test_a_constant_channel_has_the_value_b_and_is_named(tmp_path: Path, data_format: str) -> None:
    path = WITH_SPARES.but(data_format=data_format).write(tmp_path)
    recording = read(path)
    np.testing.assert_array_equal(recording.samples[4:, 2], [0.0, -2.5, 400.0])
    assert np.ptp(recording.samples[4:], axis=1).max() == 0.0
    assert [channel.is_constant for channel in recording.channels] == [False] * 4 + [True] * 3
    (warning,) = recording.warnings
    assert "constant: 'SPARE 1' (0 A), 'SPARE 2' (-2.5 V), 'UREF' (0.1 kV)" in warning
    theirs = oracle.load(str(path), ignore_warnings=True, use_double_precision=True)
    np.testing.assert_allclose(recording.samples[4], theirs.analog[4])
    sound = read(RECORD_1999.write(tmp_path, name="sound.cfg", data_name="sound.dat"))
    np.testing.assert_array_equal(recording.samples[:4], sound.samples)
    assert sound.warnings == ()
    drawn = read_envelope(path, lambda _, samples: samples)
    np.testing.assert_array_equal(drawn.highest[4:, 0], [0.0, -2.5, 400.0])


def test_constants_of_1991_and_missing_counts(tmp_path: Path) -> None:
    """A channel without a value in any sample (0xFFFF) has the value b all the same."""
    analog = (*RECORD_1991.analog, "5,SPARE,,,A,0,3,0,0,0")
    rows = tuple((*row, -1) for row in RECORD_1991.rows)
    path = RECORD_1991.but(counts="7,5A,2D", analog=analog, rows=rows).write(tmp_path)
    np.testing.assert_array_equal(read(path).samples[4], 3.0)


def test_a_hundred_spares_are_counted(tmp_path: Path) -> None:
    spares = tuple(f"{k},S{k},,,V,0,0,0,0,0,1,1,P" for k in range(5, 105))
    rows = tuple((*row, *[0] * 100) for row in RECORD_1999.rows)
    path = RECORD_1999.but(counts="106,104A,2D", analog=(*ANALOG_LINES, *spares), rows=rows).write(tmp_path)
    (warning,) = read(path).warnings
    assert "'S16' (0 V) and 88 more" in warning
    assert len(warning) < 400


@pytest.mark.parametrize("year", ["1998", "2000", "2005", "2012"])
def test_years_between_the_editions_are_read_as_1999(tmp_path: Path, year: str) -> None:
    recording = read(RECORD_1999.but(identification=f"P,R,{year}").write(tmp_path))
    (warning,) = recording.warnings
    assert f"found '{year}': read as the edition of 1999" in warning
    np.testing.assert_array_equal(recording.samples, read(RECORD_1999.write(tmp_path)).samples)


@pytest.mark.parametrize(
    "record",
    [
        RECORD_1999.but(identification="SIM,RACK 1,0"),
        RECORD_1999.but(identification="SIM,RACK 1,"),
        RECORD_1999.but(identification="SIM,RACK 1"),
        RECORD_1991.but(identification="SIM,RACK 1,0"),
        RECORD_2013.but(identification="SIM,RACK 1,0", tail=("1", "-3,-3", "0,0")),
    ],
)
def test_revision_0_is_told_by_the_layout(tmp_path: Path, record: ComtradeFile) -> None:
    recording = lenient_alone(record.write(tmp_path), "the edition is told by the layout")
    sound = read(RECORD_1999.write(tmp_path))
    np.testing.assert_array_equal(recording.samples, sound.samples)
    assert recording.trigger_index == 2
    ahead_h = -3 if len(record.tail) == 3 else 0
    assert recording.start_time_ns == sound.first_time_ns - ahead_h * 3_600_000_000_000


def test_2013_without_its_last_lines(tmp_path: Path) -> None:
    path = RECORD_2013.but(tail=("1",)).write(tmp_path)
    recording = lenient_alone(path, "the times are taken as UTC")
    assert recording.start_time_ns == read(RECORD_1999.write(tmp_path)).start_time_ns
    path = RECORD_2013.but(tail=("1", "+1,+1")).write(tmp_path)
    recording = lenient_alone(path, "the quality of the time is not looked at")
    assert recording.start_time_ns == read(RECORD_1999.write(tmp_path)).first_time_ns - 3_600_000_000_000
    path = RECORD_2013.but(tail=("1", "CET,CET", "0,0")).write(tmp_path)
    assert lenient_alone(path, "the times are unknown").start_time_ns is None


def test_without_time_multiplier(tmp_path: Path) -> None:
    recording = lenient_alone(RECORD_1999.but(tail=()).write(tmp_path), "time multiplier")
    np.testing.assert_array_equal(recording.time_s, read(RECORD_1999.write(tmp_path)).time_s)
    with pytest.raises(RecordingError, match="time multiplier"):
        read(RECORD_1999.but(tail=(), rates=("0", "0,5")).write(tmp_path), lenient=True)


@pytest.mark.parametrize(
    "rates",
    [
        ("2", "1000,5", "1000,5"),
        ("2", "1000,5", "50,0"),
        ("2", "1000,5", "0,5"),
        ("3", "1000,5", "500,5", "50,5"),
        ("2", "500,0", "1000,5"),
    ],
)
def test_rates_without_a_sample_are_left_out(tmp_path: Path, rates: tuple[str, ...]) -> None:
    recording = lenient_alone(RECORD_1999.but(rates=rates).write(tmp_path), "no sample was taken")
    assert recording.sample_rate_hz == 1000
    assert recording.instants_s is None
    assert recording.samples.shape == (4, 5)


@pytest.mark.parametrize("rates", [("2", "1000,5", "500,3"), ("2", "1000,0", "500,0"), ("1", "1000,0")])
def test_other_counts_of_samples_are_no_empty_rates(tmp_path: Path, rates: tuple[str, ...]) -> None:
    with pytest.raises(RecordingError, match="last sample"):
        read(RECORD_1999.but(rates=rates).write(tmp_path), lenient=True)


@pytest.mark.parametrize(
    "start",
    ["31/02/2024,06:30:00.25", "00/00/0000,00:00:00.000000", "  /  /    ,  :  :  ", "21/11/2024,25:00:00.0",
     "21/11/0015,06:30:00.25", "21/11/2024,06:30:00. 25", "never"],
)  # fmt: skip
def test_a_date_that_is_none_is_an_unknown_time(tmp_path: Path, start: str) -> None:
    recording = lenient_alone(RECORD_1999.but(start=start).write(tmp_path), "the time is unknown")
    assert recording.start_time_ns is None
    assert recording.trigger_index is None
    with pytest.raises(UnknownTimeError, match=r"record.cfg: time: expected a date and time"):
        recording.trigger_time_ns  # noqa: B018 - the property refuses
    np.testing.assert_array_equal(recording.samples, read(RECORD_1999.write(tmp_path)).samples)


def test_an_impossible_time_of_the_trigger_alone(tmp_path: Path) -> None:
    recording = lenient_alone(
        RECORD_1999.but(trigger="32/01/2024,00:00:00.0").write(tmp_path), "the time is unknown"
    )
    assert recording.trigger_index is None
    assert recording.trigger_time_ns == read(RECORD_1999.write(tmp_path)).start_time_ns


LENGTH = 60
STEP_NS = 250_000_000
"""Stamps of so many nanoseconds a step run over every 17 samples."""


def long(rates: tuple[str, ...], stamps: list[int], data_format: str, decimals: int = 9) -> ComtradeFile:
    return RECORD_1999.but(
        rates=rates,
        rows=[(k, -k, 0, 1) for k in range(len(stamps))],
        numbers=range(1, len(stamps) + 1),
        stamps=stamps,
        data_format=data_format,
        start="21/11/2024,06:30:00." + "0" * decimals,
        trigger="21/11/2024,06:30:01." + "0" * decimals,
    )


@pytest.mark.parametrize("data_format", ["BINARY", "ASCII"])
@pytest.mark.parametrize("rates", [("1", f"4,{LENGTH}"), ("0", f"0,{LENGTH}")])
@pytest.mark.parametrize("first", [0, 4_000_000_001])
def test_nanoseconds_that_start_again_are_counted_on(
    tmp_path: Path, data_format: str, rates: tuple[str, ...], first: int
) -> None:
    stamps = [(first + k * STEP_NS) % (1 << 32) for k in range(LENGTH)]
    recording = read(long(rates, stamps, data_format).write(tmp_path))
    np.testing.assert_allclose(recording.time_s, 0.25 * np.arange(LENGTH), atol=1e-6)
    (warning,) = recording.warnings
    assert "the time stamps start again" in warning
    assert "4294967296 steps" in warning


@pytest.mark.parametrize("unit_decimals", [6, 9])
def test_any_unit_may_run_over_and_a_gap_stays_a_gap(tmp_path: Path, unit_decimals: int) -> None:
    """Of microseconds after 71 minutes; the gap of seven steps in the middle is kept."""
    step = 250_000_000
    true = [k * step + (7 * step if k >= 30 else 0) for k in range(LENGTH)]
    rate = 4.0 if unit_decimals == 9 else 0.004
    stamps = [stamp % (1 << 32) for stamp in true]
    record = long(("1", f"{rate},{LENGTH}"), stamps, "BINARY", unit_decimals)
    recording = read(record.write(tmp_path))
    np.testing.assert_allclose(recording.time_s * rate, np.array(true) / step, rtol=1e-6)


def test_stamps_with_a_sign_run_over_too(tmp_path: Path) -> None:
    stamps = [(k * STEP_NS + (1 << 31)) % (1 << 32) - (1 << 31) for k in range(LENGTH)]
    recording = read(long(("1", f"4,{LENGTH}"), stamps, "ASCII").write(tmp_path))
    np.testing.assert_allclose(recording.time_s, 0.25 * np.arange(LENGTH), atol=1e-6)


@pytest.mark.parametrize("rates", [("1", "4,20"), ("0", "0,20")])
def test_other_steps_back_are_refused(tmp_path: Path, rates: tuple[str, ...]) -> None:
    stamps = [k * STEP_NS for k in range(17)]
    with pytest.raises(RecordingError, match="time stamp"):
        read(
            long(rates, [*stamps, *(3_000_000_000 + k * STEP_NS for k in range(3))], "BINARY").write(tmp_path)
        )
