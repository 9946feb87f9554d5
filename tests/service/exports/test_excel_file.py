import io
import tempfile
from collections.abc import Iterator
from datetime import datetime
from itertools import repeat
from math import inf, nan
from pathlib import Path
from zipfile import ZipFile

import pytest
from openpyxl import Workbook, load_workbook
from openpyxl.utils.escape import unescape

from core.error_words import one_line
from service.exports.excel_file import CUT, MOST_CHARACTERS, excel_pieces
from testing.no_room import no_room
from tests.service.exports.rows import EMPTY, HOSTILE, TABLE, Row


def written(*rows: Row, most_rows: int = 1_048_576) -> Workbook:
    return load_workbook(io.BytesIO(b"".join(excel_pieces(TABLE, [rows], most_rows=most_rows))))


def test_times_are_date_times_and_numbers_are_numbers() -> None:
    sheet = written(Row(), EMPTY)["rows"]
    assert [cell.value for cell in sheet[1]] == ["time (UTC)", "words", "level", "size_bytes"]
    assert [cell.value for cell in sheet[2]] == [
        datetime(2025, 10, 9, 8, 53, 20, 123000),
        "PUMP-A1",
        0.0121,
        7,
    ]
    assert sheet["A2"].is_date
    assert sheet.max_row == 2, "a row of which nothing is known has no cells"
    assert sheet.freeze_panes == "A2"
    assert sheet.auto_filter.ref is not None


def test_what_is_no_number_is_not_known() -> None:
    sheet = written(Row(level=nan), Row(level=inf))["rows"]
    assert [sheet["C2"].value, sheet["C3"].value] == [None, None]


def test_days_that_excel_does_not_know_are_texts() -> None:
    sheet = written(Row(time_ns=-(2**62)), Row(time_ns=2**63 - 1))["rows"]
    assert sheet["A2"].value == "1823-11-12T00:06:21.572612096Z"
    assert sheet["A3"].value.year == 2262


def test_the_last_sheet_tells_what_the_columns_mean() -> None:
    told = [[cell.value for cell in row] for row in written(Row())["columns"].rows]
    assert told[0] == ["column", "type", "unit", "meaning"]
    assert told[3] == ["level", "number", "1", "how much it is"]


def test_a_full_sheet_is_followed_by_another() -> None:
    book = written(*(Row(size=at) for at in range(25)), most_rows=11)
    assert book.sheetnames == ["rows", "rows 2", "rows 3", "columns"]
    sizes = [sheet.cell(row, 4).value for sheet in book.worksheets[:3] for row in range(2, sheet.max_row + 1)]
    assert sizes == list(range(25))
    assert [cell.value for cell in book["rows 3"][1]] == ["time (UTC)", "words", "level", "size_bytes"]


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_texts_stay_texts(text: str) -> None:
    content = b"".join(excel_pieces(TABLE, [[Row(words=text)]]))
    with ZipFile(io.BytesIO(content)) as archive:
        sheet = archive.read("xl/worksheets/sheet1.xml")
        assert b"<f>" not in sheet
        assert b"hyperlink" not in sheet
    cell = load_workbook(io.BytesIO(content))["rows"]["B2"]
    assert cell.data_type == "s"
    expected = one_line(text)
    if len(expected) > MOST_CHARACTERS:
        expected = expected[: MOST_CHARACTERS - len(CUT)] + CUT
    assert unescape(cell.value) == expected, "as Excel reads it"
    if expected.startswith(tuple("=+-@＝")):
        assert cell.quotePrefix, "it stays a text where somebody edits it"


@pytest.mark.parametrize("rows", [0, 50_000])
def test_a_full_disk_is_told_as_such_and_nothing_is_left_behind(
    rows: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with no_room(), pytest.raises(OSError, match="File too large"):
        b"".join(excel_pieces(TABLE, [[Row()] * rows]))
    assert list(tmp_path.iterdir()) == []


def test_rows_that_cannot_be_read_leave_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def batches() -> Iterator[list[Row]]:
        yield [Row()] * 10
        raise RuntimeError("the database does not answer")

    with pytest.raises(RuntimeError, match="does not answer"):
        list(excel_pieces(TABLE, batches()))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.campaign
@pytest.mark.timeout(900)
def test_more_rows_than_a_sheet_has() -> None:
    short = Row(time_ns=None, words=None, level=None)
    content = b"".join(excel_pieces(TABLE, repeat([short] * 1000, 1049)))
    book = load_workbook(io.BytesIO(content), read_only=True)
    assert book.sheetnames == ["rows", "rows 2", "columns"]
    assert sum(1 for _ in book["rows"].iter_rows()) == 1_048_576
    assert sum(1 for _ in book["rows 2"].iter_rows()) == 1_049_000 - 1_048_575 + 1
