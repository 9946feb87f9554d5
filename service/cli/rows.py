"""Rows of documents for people (a table), for spreadsheets (CSV) and for programs (JSON)."""

import csv
import io
import sys
from collections.abc import Callable, Collection, Mapping, Sequence

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.error_words import one_line
from service.cli.output import WRONG_USE, CommandError, print_document, results
from service.client.rest_client import Document
from service.client.tables import FittedTable
from service.exports.csv_file import without_formula

Column = Callable[[Document], str | Text]
"""This returns what a table shows of a row."""


def require_one_format(*, as_csv: bool, as_json: bool) -> None:
    """Raise CommandError where rows are wanted in two formats."""
    if as_csv and as_json:
        raise CommandError(
            "--csv: expected one of --csv and --json, found both",
            details={"type": "WrongUse"},
            exit_code=WRONG_USE,
        )


def print_rows(
    name: str,
    rows: Sequence[Document],
    fields: Sequence[str],
    columns: Mapping[str, Column],
    *,
    as_csv: bool,
    as_json: bool,
    whole: Collection[str] = (),
) -> None:
    """Print rows.

    name: of the list in the JSON document.  fields: those of a row in CSV, in their order; of two numbers
    such as ci95 each gets a column.  columns: the table's, by heading.  whole: headings of the
    columns that are wrapped and left out last of all, such as ids, which people copy.
    """
    if as_json:
        print_document({name: list(rows)})
    elif as_csv:
        sys.stdout.write(_csv(rows, fields))
    elif not rows:
        results().print(Text(f"no {name}"))
    else:
        table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
        table.kept = whole
        for heading in columns:
            table.add_column(heading, no_wrap=heading in whole)
        for row in rows:
            cells = (show(row) for show in columns.values())
            table.add_row(*(cell if isinstance(cell, Text) else Text(one_line(cell)) for cell in cells))
        results().print(table)


def _csv(rows: Sequence[Document], fields: Sequence[str]) -> str:
    sink = io.StringIO()
    writer = csv.writer(sink)
    pairs = {field for field in fields if field.endswith("95")}
    writer.writerow(
        name
        for field in fields
        for name in ((f"{field}_low", f"{field}_high") if field in pairs else (field,))
    )
    for row in rows:
        cells: list[str] = []
        for field in fields:
            value = row.get(field)
            if field in pairs:
                cells += [_cell(end) for end in value] if isinstance(value, list) else ["", ""]
            else:
                cells.append(_cell(value))
        writer.writerow(cells)
    return sink.getvalue()


def _cell(value: object) -> str:
    """Return a value as text; names and reasons may come from a relay."""
    if value is None:
        return ""
    if not isinstance(value, str):
        return str(value)
    return without_formula(one_line(value))
