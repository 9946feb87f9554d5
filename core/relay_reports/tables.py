"""The tables of relay reports, plain or Compressed ASCII."""

import re
from dataclasses import dataclass
from pathlib import Path

from core.recordings.cev.compressed_ascii import rows
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs
from core.relay_reports.error import ReportError
from core.relay_reports.report_text import Line, ReportText

_EMPTY = re.compile(r"\b(no\b.*\bdata|history buffer empty)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Table:
    """A table of a report.

    Parameters
    ----------
    labels : tuple of str
        Labels of its columns; none where the relay has no data.
    rows : tuple of tuple
        Its rows: the line, and its fields.
    """

    labels: tuple[str, ...]
    rows: tuple[tuple[Line, tuple[str, ...]], ...]


def plain_table(report: ReportText, *labels: str) -> Table:
    """Return the table below the first line of a plain report that has all of some labels.

    Parameters
    ----------
    report : ReportText
        The report.
    *labels : str
        Labels that the heading has, whatever their units.

    Returns
    -------
    Table
        Its labels in capitals without units, and its rows; a row may have any number of fields.

    Raises
    ------
    ReportError
        If there is no such heading, and the report does not say that the relay has no data.
    """
    lines = report.lines()
    for place, line in enumerate(lines):
        heading = tuple(label_of(field) for field in fields_of(line))
        if set(labels) <= set(heading):
            return Table(heading, tuple((row, tuple(fields_of(row))) for row in lines[place + 1 :]))
    if any(is_empty(line.text) for line in lines):
        return Table((), ())
    raise ReportError(report.name, "end", expected=f"a heading with {', '.join(labels)}", found="none")


def compressed_table(report: ReportText) -> Table:
    """Return the table of a Compressed ASCII report; every line's checksum must be right.

    Parameters
    ----------
    report : ReportText
        The report.

    Returns
    -------
    Table
        Its columns and rows.

    Raises
    ------
    ReportError
        If it is no such table.
    """
    name, encoded = report.name, report.text.encode("latin-1", "replace")
    try:
        found = list(rows(Path(name), encoded, 0, len(encoded), Repairs(lenient=False)))
    except RecordingError as error:
        raise ReportError(name, error.field, expected=error.expected, found=error.found) from error
    if any(len(row.fields) == 1 and is_empty(row.fields[0]) for row in found):
        return Table((), ())
    heads = [place for place, row in enumerate(found) if "MONTH" in row.fields]
    if not heads:
        raise ReportError(name, "end", expected="a line of labels with MONTH, DAY, YEAR", found="none")
    labels = found[heads[0]].fields
    table = []
    for row in found[heads[0] + 1 :]:
        line = Line(name, row.number, ",".join(row.fields))
        line.require_fields(row.fields, len(labels))
        table.append((line, row.fields))
    return Table(labels, tuple(table))


def is_empty(text: str) -> bool:
    """Tell whether a line says that the relay has no data.

    Parameters
    ----------
    text : str
        The line.

    Returns
    -------
    bool
        True where it does.
    """
    return _EMPTY.search(text) is not None


def fields_of(line: Line) -> list[str]:
    """Return the fields of a line of a table, between commas or else between blanks.

    Parameters
    ----------
    line : Line
        The line.

    Returns
    -------
    list of str
        Its fields.
    """
    if "," in line.text:
        return [field.strip().strip('"') for field in line.text.rstrip(",").split(",")]
    return line.text.split()


def label_of(text: str) -> str:
    """Return a label in capitals without its unit: IA of "Ia(A)".

    Parameters
    ----------
    text : str
        The label as the report has it.

    Returns
    -------
    str
        The label.
    """
    return re.sub(r"\s*\([^)]*\)", "", text).strip().upper()
