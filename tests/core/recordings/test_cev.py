"""What the reader delivers of Compressed ASCII event reports, what it refuses, and what it mends if asked."""

import re
from datetime import UTC, datetime
from math import nan
from pathlib import Path

import numpy as np
import pytest

from core.recordings import Quantity, Recording, RecordingError, read
from core.recordings.cev.compressed_ascii import checksum
from core.recordings.cev.reader import read_event_report
from core.units import NANOSECONDS_PER_SECOND
from tests.core.recordings.cev_files import REPORT, ROWS, CevFile, line

TRIGGER_NS = int(datetime(2024, 11, 21, 6, 30, tzinfo=UTC).timestamp()) * NANOSECONDS_PER_SECOND + 250_000_000
EXPECTED = np.array(
    [
        [100, -20.5, -100, 20.5, 100, -20.5, -100, 20.5],
        [100, 200, 300, -100, -200, nan, 300, 100],
        [400, -100, -400, nan, 400, -100, -400, 100],
        [2300, 0, -2300, 0, 2300, 0, -2300, 0],
        [60.01, 60.01, 60.02, 60.02, 60.01, 60.01, 60.02, 60.02],
    ]
)


@pytest.mark.parametrize(
    ("fields", "published"),
    [
        ('"FID"', "0143"),
        ('"SETTINGS"', "02E1"),
        ('"MONTH","DAY","YEAR","HOUR","MIN","SEC","MSEC"', "0ACA"),
        ('"IA","IB","IC","IN","IG","TRIG","RLY_BITS"', "0996"),
        ('"No Data Available"', "0668"),
    ],
)
def test_the_checksums_printed_in_the_manuals(fields: str, published: str) -> None:
    assert checksum(f"{fields},".encode("ascii")) == published


def check(recording: Recording) -> None:
    np.testing.assert_allclose(recording.samples, EXPECTED, rtol=1e-12)
    assert recording.sample_rate_hz == 240
    assert recording.trigger_index == 4
    assert recording.trigger_time_ns == TRIGGER_NS
    assert recording.instants_s is None
    assert [(c.name, c.quantity, c.phase, c.unit) for c in recording.channels] == [
        ("IA", Quantity.CURRENT, "a", "A"),
        ("IB", Quantity.CURRENT, "b", "A"),
        ("VAB", Quantity.LINE_VOLTAGE, "ab", "V"),
        ("VC", Quantity.PHASE_VOLTAGE, "c", "V"),
        ("FREQ", Quantity.OTHER, None, "Hz"),
    ]
    assert recording.device == "SEL-710-R300-V0-Z005003-D20150101"
    digitals = recording.digitals
    assert digitals is not None
    assert digitals.names == ("TRIP", "RB01", "RB02", "IN101")
    assert digitals.state("TRIP").tolist() == [True, True, True, True, False, False, False, False]
    assert digitals.state("RB01").tolist() == [False, False, True, True, True, True, True, True]
    assert not digitals.state("RB02").any()
    assert digitals.state("IN101").tolist() == [False, False, True, True, True, True, True, True]


def test_a_report(tmp_path: Path) -> None:
    report = read_event_report(REPORT.write(tmp_path))
    check(report.recording)
    assert report.recording.nominal_frequency_hz == 60
    assert report.recording.repairs == ()
    assert report.fid == "SEL-710-R300-V0-Z005003-D20150101"
    assert report.summary["EVENT"] == "TRIP"
    assert report.summary["LOCATION"] == "$$$$$$$"
    assert report.summary["IA"] == "101.5"
    assert report.settings == SETTINGS_WITH_LINE_FEEDS


SETTINGS_WITH_LINE_FEEDS = "FNOM := 60\nRID := SEL-710\n"


@pytest.mark.parametrize(
    "report",
    [
        REPORT.but(before=b"CEV 2\r\n"),
        REPORT.but(before=b"CEV 2"),
        REPORT.but(before=b"=>>CEV S16\r\r\n\x02"),
        REPORT.but(after=b"\x03\r\n=>"),
        REPORT.but(settings=None),
        REPORT.but(settings=None, after=b"\x03"),
        REPORT.but(settings="", after=b"\r\n\r\n"),
        REPORT.with_head("MONTH", "MONTH_").with_head('"DAY"', '"DAY_"'),
        REPORT.with_head("2024", "24"),
        REPORT.but(rows=[row.replace('">"', ">").replace('"*"', "*") for row in ROWS]),
        REPORT.but(rows=[row.replace('"*"', "").replace('">"', "*") for row in ROWS]),
        REPORT.but(head=[*REPORT.head[:4], '"GROUP"', "1", *REPORT.head[4:]]),
    ],
)
def test_what_surrounds_and_varies(tmp_path: Path, report: CevFile) -> None:
    check(read(report.write(tmp_path, "REPORT.CEV")))


@pytest.mark.parametrize("line_end", [b"\n", b"\r"])
def test_line_ends_changed_by_a_transfer(tmp_path: Path, line_end: bytes) -> None:
    path = REPORT.write(tmp_path)
    path.write_bytes(path.read_bytes().replace(b"\r\n", line_end))
    check(read(path))


def test_states_before_the_first_word_are_those_of_it(tmp_path: Path) -> None:
    rows = [row.replace('"80"', '""') for row in ROWS]
    digitals = read(REPORT.but(rows=rows).write(tmp_path)).digitals
    assert digitals is not None
    assert digitals.state("RB01").tolist() == [True] * 8


def test_without_a_relay_word(tmp_path: Path) -> None:
    head = [*REPORT.head[:6], '"IA","TRIG"']
    recording = read(REPORT.but(head=head, rows=["1,"] * 4 + ['2,">"'] + ["3,"] * 3).write(tmp_path))
    assert recording.digitals is None
    assert recording.samples.tolist() == [[1, 1, 1, 1, 2, 3, 3, 3]]


def first_row(old: str, new: str) -> list[str]:
    assert old in ROWS[0]
    return [ROWS[0].replace(old, new), *ROWS[1:]]


REFUSED: dict[str, tuple[CevFile, str]] = {
    "empty": (REPORT.but(head=(), rows=(), settings=None), "line 1: expected \"FID\" or \"MONTH\", found ''"),
    "no labels": (REPORT.but(head=REPORT.head[:6], rows=(), settings=None), "channel labels: .*TRIG"),
    "cut off": (REPORT.but(rows=ROWS[:7], settings=None), "samples: expected 8, .* found 7 lines"),
    "no samples": (REPORT.but(rows=(), settings=None), "samples: expected 8, .* found 0 lines"),
    "too many samples": (REPORT.but(rows=[*ROWS, ROWS[0]]), "samples: expected 8, .* found 9 lines"),
    "no frequency": (REPORT.with_head('"FREQ","SAM', '"F","SAM'), "line 7, before it, FREQ: .*no such label"),
    "impossible frequency": (REPORT.with_head("60.00,4", "0,4"), "line 6, FREQ: expected a number from 1 to"),
    "frequency unknown": (REPORT.with_head("60.00,4", "$$$$$$$,4"), "line 6, FREQ: .*found '\\$"),
    "no rate": (REPORT.with_head("60.00,4", "60.00,0"), "line 6, SAM/CYC_A: .*found '0'"),
    "month": (REPORT.with_head("11,21", "13,21"), "line 4, MONTH: expected an integer .* 12, found '13'"),
    "no such day": (REPORT.with_head("11,21", "11,31"), "line 4, date: .*day is out of range"),
    "year": (REPORT.with_head("2024", "1066"), "line 4, YEAR: expected 1970 to 2200, found 1066"),
    "fields of the date": (REPORT.with_head("11,21,", "11,"), "line 4: expected 7 fields as line 3, found 6"),
    "no trigger": (REPORT.but(rows=[row.translate({62: None, 42: None}) for row in ROWS]), "TRIG: .*0 lines"),
    "two triggers": (REPORT.but(rows=[row.replace("*", ">") for row in ROWS]), "TRIG: .*found 2 lines"),
    "trigger mark": (REPORT.but(rows=[row.replace("*", "?") for row in ROWS]), "line 14, TRIG: .*'\\?'"),
    "value": (REPORT.but(rows=first_row("0.1", "O.1")), "line 8, IB\\(kA\\): .*'O.1'"),
    "not finite": (REPORT.but(rows=first_row("0.1", "nan")), "line 8, IB\\(kA\\): .*'nan'"),
    "word too short": (REPORT.but(rows=first_row("80", "8")), "line 8, relay word: expected 2 hex"),
    "word no hex": (REPORT.but(rows=first_row("80", "8G")), "line 8, relay word: .*'8G'"),
    "field missing": (REPORT.but(rows=[ROWS[0][:-5], *ROWS[1:]]), "line 8: expected 7 fields .*found 6"),
    "open quote": (REPORT.but(rows=[ROWS[0][:-1], *ROWS[1:]]), "line 8: expected fields between commas"),
    "fields behind the word": (REPORT.with_head('IN101 "', 'IN101 ","X"'), "line 7, channel labels"),
}  # fmt: skip


@pytest.mark.parametrize(("report", "reason"), REFUSED.values(), ids=REFUSED)
def test_refused(tmp_path: Path, report: CevFile, reason: str) -> None:
    with pytest.raises(RecordingError, match=f"^report.cev: {reason}"):
        read(report.write(tmp_path))


def test_a_missing_file_and_a_huge_one(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"r.cev: file: expected a file"):
        read(tmp_path / "r.cev")
    with (tmp_path / "r.cev").open("wb") as file:
        file.truncate(33 << 20)
    with pytest.raises(RecordingError, match="size: expected at most"):
        read(tmp_path / "r.cev")


def test_any_changed_byte_is_noticed(tmp_path: Path) -> None:
    """In the samples: every byte of a line is in its sum."""
    path = REPORT.write(tmp_path)
    content = path.read_bytes()
    start, end = content.index(b"100,0.1"), content.index(b'"SETTINGS"')
    for k in range(start, end):
        if content[k : k + 1] in b"\r\n":
            continue
        path.write_bytes(content[:k] + bytes([content[k] ^ 1]) + content[k + 1 :])
        with pytest.raises(RecordingError, match="line"):
            read(path)


def test_every_truncation_of_the_samples_is_noticed(tmp_path: Path) -> None:
    path = REPORT.write(tmp_path)
    content = path.read_bytes()
    for length in range(content.index(b'"SETTINGS"') - 2):
        path.write_bytes(content[:length])
        with pytest.raises(RecordingError):
            read(path)


def corrupt(report: CevFile, old: bytes, new: bytes) -> bytes:
    content = report.content()
    assert content.count(old) == 1
    return content.replace(old, new)


@pytest.mark.parametrize(
    ("content", "repair"),
    [
        (corrupt(REPORT, b"100,0.1,", b"100,0.10,"), "line 8, checksum: .*: the line is read as it is"),
        (corrupt(REPORT, b"FNOM := 60", b"FNOM := 50"), "settings, checksum: .*: the settings are read as"),
        (corrupt(REPORT, b'RID := SEL-710\r\n"', b"RID :="), "settings: .*: the settings are left out"),
        (REPORT.but(rows=ROWS[:7]).content(), "found 7 lines: 7 samples are read"),
        (REPORT.but(rows=ROWS[:7], settings=None).content() + b"20.5,1e-1", "line 15: .*line is left out"),
        (REPORT.but(rows=[row.replace("*", ">") for row in ROWS]).content(), "2 lines: the date is taken"),
    ],
)  # fmt: skip
def test_lenient(tmp_path: Path, content: bytes, repair: str) -> None:
    path = tmp_path / "report.cev"
    path.write_bytes(content)
    with pytest.raises(RecordingError):
        read(path)
    recording = read(path, lenient=True)
    np.testing.assert_allclose(recording.samples, EXPECTED[:, : recording.samples.shape[1]])
    assert len(recording.repairs) in (1, 2)
    assert re.search(repair, recording.repairs[0])


def test_a_lenient_reader_guesses_no_rate_and_no_value(tmp_path: Path) -> None:
    for report in (
        REPORT.with_head("60.00,4", "0,4"),
        REPORT.but(rows=first_row("0.1", "O.1")),
    ):
        with pytest.raises(RecordingError):
            read(report.write(tmp_path), lenient=True)


def test_the_reference_makes_sound_lines() -> None:
    assert line('"FID"') == b'"FID","0143"\r\n'
