"""Local times as UTC: every hour of a year, the hour that is there twice, the hour that is not there."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from core.recordings import read
from core.recordings.comtrade.writer import write as write_comtrade
from core.recordings.local_time import in_utc, utc_of
from core.recordings.waveform import Channel, Quantity, Recording
from core.time_stamps import nanoseconds

HOUR_NS = 3600 * 10**9
BERLIN, KOLKATA, LORD_HOWE = map(ZoneInfo, ("Europe/Berlin", "Asia/Kolkata", "Australia/Lord_Howe"))


def written(text: str) -> int:
    """The number that a local clock shows, as if it were UTC [ns]."""
    return nanoseconds(f"{text}Z")


def local(utc_ns: int, zone: ZoneInfo) -> int:
    """What a clock of this zone shows [ns]."""
    at = datetime.fromtimestamp(utc_ns // 10**9, zone)
    return round(at.replace(tzinfo=UTC).timestamp()) * 10**9 + utc_ns % 10**9


@pytest.mark.parametrize("zone", [BERLIN, KOLKATA, LORD_HOWE, ZoneInfo("America/New_York"), ZoneInfo("UTC")])
def test_every_half_hour_of_a_year_comes_back(zone: ZoneInfo) -> None:
    begin_ns = nanoseconds("2026-01-01T00:00:00Z") + 123_456_789
    times = [begin_ns + k * HOUR_NS // 2 for k in range(2 * 24 * 365)]
    assert [utc_of(local(time_ns, zone), zone, time_ns + 20 * 10**9).ns for time_ns in times] == times


def test_summer_and_winter() -> None:
    assert utc_of(written("2026-07-01T12:00:00"), BERLIN).ns == nanoseconds("2026-07-01T10:00:00Z")
    assert utc_of(written("2026-01-01T12:00:00"), BERLIN).ns == nanoseconds("2026-01-01T11:00:00Z")
    assert utc_of(written("2026-01-01T12:00:00"), KOLKATA).ns == nanoseconds("2026-01-01T06:30:00Z")


@pytest.mark.parametrize(
    ("near", "utc", "which"),
    [
        ("2026-10-25T00:30:03Z", "2026-10-25T00:30:00Z", "first"),
        ("2026-10-25T01:30:03Z", "2026-10-25T01:30:00Z", "second"),
        ("2026-10-25T09:00:00Z", "2026-10-25T01:30:00Z", "second"),
        (None, "2026-10-25T00:30:00Z", "first"),
    ],
)
def test_the_hour_that_is_there_twice(near: str | None, utc: str, which: str) -> None:
    near_ns = None if near is None else nanoseconds(near)
    found = utc_of(written("2026-10-25T02:30:00"), BERLIN, near_ns)
    assert found.ns == nanoseconds(utc)
    assert found.doubt == f"2026-10-25 02:30:00 is there twice in Europe/Berlin: the {which} is taken"


def test_the_hour_that_is_not_there_is_of_a_clock_that_was_not_set_yet() -> None:
    found = utc_of(written("2026-03-29T02:30:00"), BERLIN, nanoseconds("2026-03-29T01:30:02Z"))
    assert found.ns == nanoseconds("2026-03-29T01:30:00Z")
    assert found.doubt is not None
    assert "2026-03-29 02:30:00 is not there in Europe/Berlin" in found.doubt


def recording(start_ns: int) -> Recording:
    return Recording(
        samples=np.sin(np.arange(200) / 5)[np.newaxis],
        sample_rate_hz=1000.0,
        start_time_ns=start_ns,
        channels=(Channel("IA", Quantity.CURRENT, "a", "A", 10.0),),
        trigger_index=50,
        nominal_frequency_hz=50.0,
    )


def test_a_file_of_1999_is_taken_for_local_time(tmp_path: Path) -> None:
    write_comtrade(
        tmp_path / "E.CFG", recording(written("2026-07-01T12:00:00")), revision=1999, data_format="ASCII"
    )
    read_as_utc = read(tmp_path / "E.CFG")
    found = in_utc(read_as_utc, BERLIN)
    assert found.start_time_ns == nanoseconds("2026-07-01T10:00:00Z")
    assert found.trigger_time_ns == nanoseconds("2026-07-01T10:00:00.05Z")
    assert found.warnings == read_as_utc.warnings


def test_a_file_of_2013_tells_its_zone_by_itself(tmp_path: Path) -> None:
    write_comtrade(
        tmp_path / "E.CFG",
        recording(written("2026-07-01T12:00:00")),
        revision=2013,
        data_format="ASCII",
        utc_offset_min=120,
    )
    found = read(tmp_path / "E.CFG")
    assert found.start_time_ns == nanoseconds("2026-07-01T10:00:00Z")
    assert in_utc(found, BERLIN) is found


def test_a_file_of_2013_without_its_last_lines_is_taken_for_local_time(tmp_path: Path) -> None:
    path = tmp_path / "E.CFG"
    write_comtrade(path, recording(written("2026-07-01T12:00:00")), revision=2013, data_format="ASCII")
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-2]))
    found = read(path, lenient=True)
    assert in_utc(found, BERLIN).start_time_ns == nanoseconds("2026-07-01T10:00:00Z")


def test_what_is_in_doubt_is_a_warning_of_the_recording() -> None:
    read_as_utc = replace(recording(written("2026-10-25T02:30:00")), warnings=("another",))
    found = in_utc(read_as_utc, BERLIN, nanoseconds("2026-10-25T01:30:09Z"))
    assert found.start_time_ns == nanoseconds("2026-10-25T01:30:00Z")
    assert found.warnings == (
        "another",
        "time: 2026-10-25 02:30:00 is there twice in Europe/Berlin: the second is taken",
    )
