"""Lists of motors as files: cells of a CSV or Excel file, and an empty list to fill in."""

import csv
import io
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from service.configuration.problems import Problem
from service.plant.errors import PlantError

SUFFIXES = (".csv", ".xlsx")
MOST_BYTES = 10_000_000
MOST_ROWS, MOST_COLUMNS = 5000, 100
"""Longer ones are no lists of motors. Rows and columns that are empty count."""

Row = tuple[int, tuple[str, ...]]
"""Number of a row in its file, from 1, and its cells."""


def is_motor_list(path: Path) -> bool:
    """Tell whether a file is meant to be a list of motors, by its name."""
    return path.suffix.lower() in SUFFIXES


def read_rows(path: Path) -> list[Row]:
    """Return the rows that are neither empty nor a comment (#). Raises PlantError for another file."""
    try:
        size = path.stat().st_size
    except OSError as error:
        raise _no_list(path, "a CSV or Excel file", error.strerror or str(error)) from error
    if size > MOST_BYTES:
        raise _no_list(
            path, f"a list of motors of at most {MOST_BYTES // 1_000_000} MB", f"{size / 1e6:.0f} MB"
        )
    cells = _of_workbook(path) if path.suffix.lower() == ".xlsx" else _of_text(path)
    rows = []
    for number, row in enumerate(cells, start=1):
        if number > MOST_ROWS or len(row) > MOST_COLUMNS:
            raise _no_list(path, f"at most {MOST_ROWS} rows and {MOST_COLUMNS} columns", "more")
        stripped = tuple(cell.strip() for cell in row)
        if any(stripped) and not stripped[0].startswith("#"):
            rows.append((number, stripped))
    return rows


def write_template(path: Path, columns: Mapping[str, str], example: Sequence[str]) -> None:
    """Write a list to fill in, with an example that is a comment. Raises PlantError, OSError.

    columns: what each heading means.
    """
    if not is_motor_list(path):
        expected = f"a name that ends with {' or '.join(SUFFIXES)}"
        raise PlantError([Problem(str(path), "file", expected, path.name)])
    rows = [list(columns), [f"# {example[0]}", *example[1:]]]
    content = _workbook(rows, columns) if path.suffix.lower() == ".xlsx" else _text(rows)
    with path.open("xb") as file:
        file.write(content)


def _of_text(path: Path) -> Iterator[Sequence[str]]:
    """Yield the rows of a CSV file, whose cells commas, semicolons or tabs separate."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        expected = 'text in UTF-8 (in Excel: Save as, "CSV UTF-8")'
        raise _no_list(path, expected, "another encoding") from error
    head = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
    separator = max(",;\t", key=head.count)
    try:
        yield from csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    except csv.Error as error:
        raise _no_list(path, "cells that commas, semicolons or tabs separate", str(error)) from error


def _of_workbook(path: Path) -> Iterator[Sequence[str]]:
    """Yield the rows of the first sheet of an Excel file."""
    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import InvalidFileException

    # SyntaxError is that of XML. The others are what openpyxl leaves of damaged parts.
    damaged = (InvalidFileException, zipfile.BadZipFile, zlib.error, SyntaxError, LookupError, ValueError)
    try:
        workbook = load_workbook(path, read_only=True, data_only=True)
        try:
            for row in workbook.worksheets[0].iter_rows(values_only=True):
                yield [_cell(value) for value in row]
        finally:
            workbook.close()
    except (*damaged, TypeError, AttributeError, OSError, EOFError) as error:
        expected = "an Excel workbook (.xlsx) with a sheet"
        raise _no_list(path, expected, f"none that can be read: {error}") from error


def _cell(value: object) -> str:
    """Return what a cell shows: 4 of 4.0, nothing of an empty one."""
    if value is None:
        return ""
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _text(rows: Sequence[Sequence[str]]) -> bytes:
    sink = io.StringIO(newline="")
    csv.writer(sink).writerows(rows)
    return sink.getvalue().encode("utf-8-sig")  # Excel takes text for UTF-8 by its mark alone


def _workbook(rows: Sequence[Sequence[str]], columns: Mapping[str, str]) -> bytes:
    import xlsxwriter

    sink = io.BytesIO()
    with xlsxwriter.Workbook(sink, {"in_memory": True}) as workbook:
        bold = workbook.add_format({"bold": True})
        motors, meaning = workbook.add_worksheet("Motors"), workbook.add_worksheet("Columns")
        for number, row in enumerate(rows):
            motors.write_row(number, 0, row, bold if number == 0 else None)
        motors.freeze_panes(1, 1)
        motors.set_column(0, len(columns) - 1, 16)
        for number, (heading, words) in enumerate(columns.items()):
            meaning.write_row(number, 0, [heading, words])
        meaning.set_column(0, 0, 16)
        meaning.set_column(1, 1, 90)
    return sink.getvalue()


def _no_list(path: Path, expected: str, found: str) -> PlantError:
    return PlantError([Problem(str(path), "file", expected, found)])
