import csv
import io
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.exports.csv_file import csv_pieces
from tests.service.exports.rows import EMPTY, HOSTILE, TABLE, Row

FORMULAS = tuple("=+-@\t\r＝＋－＠")


def written(*rows: Row) -> list[list[str]]:
    content = b"".join(csv_pieces(TABLE, [rows])).decode()
    return list(csv.reader(io.StringIO(content, newline="")))


def test_names_times_numbers_and_what_is_not_known() -> None:
    assert written(Row(), EMPTY, Row(level=-1e-9)) == [
        ["time", "words", "level", "size_bytes"],
        ["2025-10-09T08:53:20.123456789Z", "PUMP-A1", "0.0121", "7"],
        ["", "", "", ""],
        ["2025-10-09T08:53:20.123456789Z", "PUMP-A1", "-1e-09", "7"],
    ]


def test_what_is_no_number_is_not_known() -> None:
    assert [row[2] for row in written(Row(level=nan), Row(level=inf), Row(level=-inf))[1:]] == ["", "", ""]


def test_a_table_without_rows_has_its_names() -> None:
    assert b"".join(csv_pieces(TABLE, [])) == b"", "there is no batch to begin with"
    assert b"".join(csv_pieces(TABLE, [[]])) == b"time,words,level,size_bytes\r\n"


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_texts_are_no_formulas(text: str) -> None:
    _, (_, found, *_) = written(Row(words=text))
    assert not found.startswith(FORMULAS)
    assert found.isprintable()


@given(st.text(st.characters(), max_size=30))
def test_no_text_begins_a_formula_or_leaves_its_cell(text: str) -> None:
    content = b"".join(csv_pieces(TABLE, [[Row(words=text)]])).decode()
    for delimiter in ",;":
        for row in csv.reader(io.StringIO(content, newline=""), delimiter=delimiter):
            if delimiter == ",":
                assert len(row) == 4
            assert not [
                cell for cell in row if cell.strip(" \"'\u3000\u00a0").startswith(FORMULAS) and cell[0] != "'"
            ]
