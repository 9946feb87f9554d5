"""A report as an Excel workbook: what it says in words on the first sheet, each table on one of its own."""

import io
from collections.abc import Sequence
from datetime import UTC, datetime

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

from core.error_words import one_line
from core.time_words import clock
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.exports.excel_file import CUT, FIRST_DAY_NS, MOST_CHARACTERS
from service.exports.formula_texts import begins_a_formula
from service.reports.document import Cell, ColumnKind, Facts, ReportDocument, Table, Words

FORMATS = {
    ColumnKind.SHARE: "0.00%",
    ColumnKind.NUMBER: "0.0000",
    ColumnKind.WHOLE: "0",
    ColumnKind.TIME: "yyyy-mm-dd hh:mm:ss",
}
WIDTHS = {ColumnKind.TEXT: 24, ColumnKind.TIME: 20}
SHEET = "report"


def workbook(report: ReportDocument) -> bytes:
    """Return the file; its times are UTC. The same report has the same bytes."""
    target = io.BytesIO()
    book = Workbook(target, {"in_memory": True, "strings_to_urls": False})
    book.set_properties(
        {
            "title": one_line(report.title)[:200],
            "subject": one_line(report.subject)[:200],
            "author": "StatorWatch",
            "comments": "Times are UTC.",
            "created": datetime.fromtimestamp(report.until_ns // NANOSECONDS_PER_SECOND, UTC).replace(
                tzinfo=None
            ),
        }
    )
    writer = _Writer(book)
    writer.words(report)
    for block in report.blocks:
        for one in block.contents:
            if isinstance(one, Table):
                writer.table(one)
    book.close()
    return target.getvalue()


class _Writer:
    """Writes the sheets. A text is never calculated, whatever it begins with."""

    def __init__(self, book: Workbook) -> None:
        self._book = book
        self._bold: Format = book.add_format({"bold": True})
        self._title: Format = book.add_format({"bold": True, "font_size": 14})
        self._quoted: Format = book.add_format({"quote_prefix": True})
        self._of_kind = {
            kind: book.add_format({"num_format": number_format}) for kind, number_format in FORMATS.items()
        }

    def words(self, report: ReportDocument) -> None:
        """Write the sheet with all that is no table."""
        sheet: Worksheet = self._book.add_worksheet(SHEET)
        sheet.set_column(0, 0, 36)
        sheet.set_column(1, 1, 100)
        rows: list[tuple[Sequence[str], Format | None]] = [
            ((report.title,), self._title),
            ((report.subject,), None),
            (("data until", clock(report.until_ns, report.time_zone)), None),
        ]
        for block in report.blocks:
            rows += [((), None), ((block.heading,), self._bold)]
            for one in block.contents:
                if isinstance(one, Facts):
                    rows += [(fact, None) for fact in one.facts]
                elif isinstance(one, Words):
                    rows.append(((one.tone, one.text), None))
                elif isinstance(one, Table):
                    rows.append(((f"sheet {one.name}", _count(one)), None))
        for number, (cells, look) in enumerate(rows):
            for at, words in enumerate(cells):
                self._text(sheet, number, at, words, look)

    def table(self, table: Table) -> None:
        """Write a table on a sheet of its own, which can be filtered by its headings."""
        sheet: Worksheet = self._book.add_worksheet(table.name)
        sheet.freeze_panes(1, 0)
        for at, column in enumerate(table.columns):
            is_time = column.kind is ColumnKind.TIME
            heading = f"{column.heading} (UTC)" if is_time else column.heading
            sheet.set_column(at, at, max(WIDTHS.get(column.kind, 12), len(heading) + 4))
            sheet.write_string(0, at, heading, self._bold)
        for number, row in enumerate(table.rows, start=1):
            for at, (cell, column) in enumerate(zip(row, table.columns, strict=True)):
                self._cell(sheet, number, at, cell, column.kind)
        sheet.autofilter(0, 0, max(len(table.rows), 1), len(table.columns) - 1)

    def _cell(self, sheet: Worksheet, row: int, at: int, cell: Cell, kind: ColumnKind) -> None:
        if cell is None or cell == "":
            return
        if kind is ColumnKind.TEXT or isinstance(cell, str):
            self._text(sheet, row, at, str(cell), None)
        elif kind is ColumnKind.TIME:
            sheet.write_number(row, at, (cell - FIRST_DAY_NS) / NANOSECONDS_PER_DAY, self._of_kind[kind])
        else:
            sheet.write_number(row, at, cell, self._of_kind[kind])

    def _text(self, sheet: Worksheet, row: int, at: int, text: str, look: Format | None) -> None:
        shown = one_line(text)
        if len(shown) > MOST_CHARACTERS:
            shown = shown[: MOST_CHARACTERS - len(CUT)] + CUT
        sheet.write_string(row, at, shown, self._quoted if begins_a_formula(shown) else look)


def _count(table: Table) -> str:
    number = f"{len(table.rows)} rows" if table.rows else table.empty
    return f"{number}; {table.left_out} further ones are left out" if table.left_out else number
