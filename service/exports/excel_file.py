"""Tables as Excel workbooks. The rows go to the disk while they come; the workbook is complete at the end."""

import io
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from tempfile import TemporaryDirectory, TemporaryFile
from typing import IO

from xlsxwriter import Workbook
from xlsxwriter.exceptions import FileCreateError
from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.exports.formula_texts import begins_a_formula
from service.exports.tables import Cell, Column, ColumnType, Record, Table

MOST_ROWS = 1_048_576
"""Rows of a sheet, with the one of the names; more go to the next sheet."""

MOST_CHARACTERS = 32_767
"""Of a cell; a longer text ends with CUT."""

CUT = " [cut]"

FIRST_DAY_NS = -25_569 * NANOSECONDS_PER_DAY
"""1899-12-30, from which Excel counts days."""

FIRST_TRUE_DAY = 61
"""Earlier days are told as text: Excel knows a 29th of February 1900."""

TIME_FORMAT = "yyyy-mm-dd hh:mm:ss.000"
WIDTHS = {ColumnType.TIME: 24, ColumnType.TEXT: 18, ColumnType.NUMBER: 12, ColumnType.WHOLE: 12}
PIECE_BYTES = 1 << 16


def excel_pieces(
    table: Table[Record], batches: Iterable[Sequence[Record]], *, most_rows: int = MOST_ROWS
) -> Iterator[bytes]:
    """Return the file in pieces, the first of them when all rows are written.

    Times are date-times of Excel in UTC, to the millisecond. The last sheet tells what the columns mean.
    """
    with TemporaryDirectory(prefix="statorwatch-export-") as folder, TemporaryFile(dir=folder) as file:
        with _written_to(file, folder) as workbook:
            workbook.set_properties({"title": table.name, "comments": "Times are UTC."})
            sheets = _Sheets(workbook, table.name, table.columns, most_rows)
            for batch in batches:
                for row in table.rows(batch):
                    sheets.write(row)
            sheets.end()
            _explain(workbook, table.columns)
        file.seek(0)
        while piece := file.read(PIECE_BYTES):
            yield piece


@contextmanager
def _written_to(file: IO[bytes], folder: str) -> Iterator[Workbook]:
    """Complete a workbook at the end of the block, and abandon it where that fails. Raises OSError.

    XlsxWriter's own `with` would complete it also where its rows could not be read to the end.
    """
    target = _Target(file)
    workbook = Workbook(target, {"constant_memory": True, "tmpdir": folder})
    try:
        yield workbook
        workbook.close()
    except FileCreateError as error:
        found = error.args[0] if error.args else None
        raise found if isinstance(found, OSError) else OSError(str(error)) from error
    finally:
        target.is_abandoned = True
        for sheet in workbook.worksheets():
            with suppress(OSError):  # what is still to be written has no room either
                sheet.row_data_fh.close()


class _Target:
    """The file of a workbook. An archive that was abandoned still writes its end, which goes nowhere then."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self.is_abandoned = False

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        return 0 if self.is_abandoned else self._file.seek(offset, whence)

    def tell(self) -> int:
        return 0 if self.is_abandoned else self._file.tell()

    def write(self, content: bytes) -> int:
        return len(content) if self.is_abandoned else self._file.write(content)

    def flush(self) -> None:
        if not self.is_abandoned:
            self._file.flush()


class _Sheets:
    """The sheets of a table, of which each but the last is full."""

    def __init__(
        self, workbook: Workbook, name: str, columns: Sequence[Column[Record]], most_rows: int
    ) -> None:
        self._workbook = workbook
        self._name = name
        self._headings = [_heading(column) for column in columns]
        self._types = [column.type for column in columns]
        self._most_rows = most_rows
        self._bold = workbook.add_format({"bold": True})
        self._time = workbook.add_format({"num_format": TIME_FORMAT})
        self._quoted = workbook.add_format({"quote_prefix": True})
        self._number = 0
        self._sheet, self._row = self._begin()

    def write(self, cells: Sequence[Cell]) -> None:
        """Write a row, to the next sheet where this one is full."""
        if self._row >= self._most_rows:
            self.end()
            self._sheet, self._row = self._begin()
        for at, (cell, column_type) in enumerate(zip(cells, self._types, strict=True)):
            if cell is None:
                continue
            if isinstance(cell, str):
                self._write_text(at, cell)
            elif column_type is ColumnType.TIME:
                self._write_time(at, int(cell))
            else:
                self._sheet.write_number(self._row, at, cell)
        self._row += 1

    def end(self) -> None:
        """Let the rows of the sheet be filtered by its headings."""
        self._sheet.autofilter(0, 0, max(self._row - 1, 1), len(self._headings) - 1)

    def _begin(self) -> tuple[Worksheet, int]:
        self._number += 1
        name = self._name if self._number == 1 else f"{self._name} {self._number}"
        sheet: Worksheet = self._workbook.add_worksheet(name)
        sheet.freeze_panes(1, 0)
        for at, (heading, column_type) in enumerate(zip(self._headings, self._types, strict=True)):
            sheet.set_column(at, at, max(WIDTHS[column_type], len(heading) + 4))
            sheet.write_string(0, at, heading, self._bold)
        return sheet, 1

    def _write_text(self, at: int, text: str) -> None:
        # A string is never calculated; the prefix keeps it one when somebody edits the cell.
        kept: Format | None = self._quoted if begins_a_formula(text) else None
        if len(text) > MOST_CHARACTERS:
            text = text[: MOST_CHARACTERS - len(CUT)] + CUT
        self._sheet.write_string(self._row, at, text, kept)

    def _write_time(self, at: int, time_ns: int) -> None:
        day = (time_ns - FIRST_DAY_NS) / NANOSECONDS_PER_DAY
        if day < FIRST_TRUE_DAY:
            self._sheet.write_string(self._row, at, rfc3339(time_ns))
        else:
            self._sheet.write_number(self._row, at, day, self._time)


def _heading(column: Column[Record]) -> str:
    return f"{column.name} (UTC)" if column.type is ColumnType.TIME else column.name


def _explain(workbook: Workbook, columns: Sequence[Column[Record]]) -> None:
    """Add the sheet that tells what the columns mean."""
    sheet = workbook.add_worksheet("columns")
    sheet.set_column(0, 0, 28)
    sheet.set_column(3, 3, 80)
    bold = workbook.add_format({"bold": True})
    for at, heading in enumerate(("column", "type", "unit", "meaning")):
        sheet.write_string(0, at, heading, bold)
    for row, column in enumerate(columns, start=1):
        told = (_heading(column), column.type, column.unit, column.meaning)
        for at, words in enumerate(told):
            sheet.write_string(row, at, words)
