"""Tables as CSV (RFC 4180), in UTF-8, piece by piece."""

import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence

from core.time_stamps import rfc3339
from service.exports.formula_texts import begins_a_formula
from service.exports.tables import Cell, ColumnType, Record, Table

_AFTER_SEMICOLON = re.compile(r"(;[\s\"']*)(?=[=+\-@\uff0b\uff0d\uff1d\uff20])")
"""Where a country's spreadsheets take semicolons for separators, a cell begins there."""


def csv_pieces(table: Table[Record], batches: Iterable[Sequence[Record]]) -> Iterator[bytes]:
    """Return the file in pieces of one batch each; its first line has the names of the columns.

    Times are RFC 3339 in UTC with nanoseconds, numbers as many digits as tell them apart, and what is not
    known is empty. Before a text that a spreadsheet would take for a formula stands an apostrophe.
    """
    sink = io.StringIO(newline="")
    writer = csv.writer(sink)
    types = [column.type for column in table.columns]
    writer.writerow(column.name for column in table.columns)
    for batch in batches:
        writer.writerows(map(_written, row, types) for row in table.rows(batch))
        yield sink.getvalue().encode()
        sink.seek(0)
        sink.truncate()


def _written(cell: Cell, column_type: ColumnType) -> str:
    if cell is None:
        return ""
    if isinstance(cell, str):
        return without_formula(cell)
    if column_type is ColumnType.TIME:
        return rfc3339(int(cell))
    return repr(cell)


def without_formula(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula."""
    if ";" in text:
        text = _AFTER_SEMICOLON.sub(r"\1'", text)
    return f"'{text}" if begins_a_formula(text) else text
