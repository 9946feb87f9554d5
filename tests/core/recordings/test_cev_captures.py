"""Event reports as terminals capture and editors save them: several, with words behind, in wide letters."""

import codecs
from pathlib import Path

import numpy as np
import pytest

from core.recordings import RecordingError, read
from core.recordings.cev.reader import read_event_report
from core.recordings.reading import is_recording_name
from tests.core.recordings.cev_files import REPORT, CevFile

SECOND = REPORT.but(rows=[row.replace("100,", "50,") for row in REPORT.rows])
WORDS = b"\r\n\r\n=>>\r\nMOTOR 1   Date: 01/05/26\r\n=>>QUIT\r\n"


@pytest.mark.parametrize("between", [b"", b"\r\n=>CEV 2\r\n\r\n", b"\x03\r\n\x02"])
@pytest.mark.parametrize("settings", [REPORT.settings, None])
def test_of_several_reports_the_first_is_read_or_the_one_asked_for(
    tmp_path: Path, between: bytes, settings: str | None
) -> None:
    path = tmp_path / "capture.cev"
    first, second = (each.but(settings=settings) for each in (REPORT, SECOND))
    path.write_bytes(first.content() + between + second.content())
    found = read(path)
    np.testing.assert_array_equal(found.samples, read(first.write(tmp_path)).samples)
    assert found.warnings == ("capture.cev: 2 event reports: the first is read",)
    asked = read(path, report=2)
    np.testing.assert_array_equal(asked.samples, read(second.write(tmp_path)).samples)
    assert asked.warnings == ()
    assert not any("reports" in warning for warning in read(path, report=1).warnings)
    with pytest.raises(RecordingError, match="event report: expected a number from 1 to 2, found 3"):
        read(path, report=3)


def test_words_behind_are_passed_over_and_quoted(tmp_path: Path) -> None:
    report = read_event_report(REPORT.but(after=WORDS).write(tmp_path))
    assert report.settings == "FNOM := 60\nRID := SEL-710\n"
    (warning,) = report.recording.warnings
    assert "behind the event report is passed over: 'MOTOR 1   Date: 01/05/26'" in warning
    bare = read(REPORT.but(settings=None, after=WORDS).write(tmp_path))
    np.testing.assert_array_equal(bare.samples, report.recording.samples)
    assert "'MOTOR 1   Date: 01/05/26'" in bare.warnings[0]


def test_words_inside_are_refused(tmp_path: Path) -> None:
    path = REPORT.write(tmp_path)
    lines = path.read_bytes().split(b"\r\n")
    path.write_bytes(b"\r\n".join([*lines[:9], b"MOTOR 1", *lines[9:]]))
    with pytest.raises(RecordingError, match="line 10"):
        read(path)


@pytest.mark.parametrize(
    ("mark", "encoding"),
    [(codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"), (b"", "utf-16-le")],
)
@pytest.mark.parametrize("report", [REPORT, REPORT.but(settings="RID := Máquina 1\r\n")])
def test_a_report_in_utf_16(tmp_path: Path, mark: bytes, encoding: str, report: CevFile) -> None:
    path = report.write(tmp_path)
    sound = read_event_report(path)
    path.write_bytes(mark + path.read_bytes().decode("latin-1").encode(encoding))
    found = read_event_report(path)
    np.testing.assert_array_equal(found.recording.samples, sound.recording.samples)
    assert found.settings == sound.settings
    assert "UTF-16" in found.recording.warnings[0]


def test_the_mark_of_utf_8(tmp_path: Path) -> None:
    path = REPORT.write(tmp_path)
    path.write_bytes(codecs.BOM_UTF8 + path.read_bytes())
    assert read(path).samples.shape == (5, 8)


@pytest.mark.parametrize("line_end", [b"\n", b"\r", b"\r\r\n"])
def test_line_ends(tmp_path: Path, line_end: bytes) -> None:
    path = REPORT.write(tmp_path)
    sound = read(path)
    path.write_bytes(path.read_bytes().replace(b"\r\n", line_end))
    np.testing.assert_array_equal(read(path).samples, sound.samples)


def test_the_name_that_relays_of_the_400_series_give(tmp_path: Path) -> None:
    found = read(REPORT.write(tmp_path, name="C8_10001.TXT"))
    np.testing.assert_array_equal(found.samples, read(REPORT.write(tmp_path)).samples)
    assert is_recording_name("C8_10001.TXT")
    assert is_recording_name("cr_10001.txt")
    assert not is_recording_name("README.txt")
    (tmp_path / "notes.txt").write_text("Pump 7 was greased.\n")
    with pytest.raises(RecordingError, match="expected a table whose numbers begin"):
        read(tmp_path / "notes.txt")


def test_a_comtrade_record_holds_no_reports(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="event report: expected no number"):
        read(tmp_path / "record.cfg", report=1)
