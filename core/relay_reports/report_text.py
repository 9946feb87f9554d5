"""The lines of a relay report, plain or Compressed ASCII, within limits.

A report is a file of the relay, or what a terminal showed: prompts (=>) and the commands behind them are
passed over, and so are blank lines. A plain report begins with the relay's name and clock.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from core.recordings.cev.compressed_ascii import rows
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs
from core.relay_reports.error import ReportError

MOST_BYTES = 8 << 20
MOST_LINES = 200_000
LONGEST_LINE = 2_000
LARGEST_NUMBER = 1e12

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\uffff]")
_PROMPT = re.compile(r"=+>")
_EMPTY = re.compile(r"\b(no\b.*\bdata|history buffer empty)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a report.

    Parameters
    ----------
    report : str
        What errors call the report.
    number : int
        Number of the line in the file, from 1.
    text : str
        The line without blanks at its ends.
    """

    report: str
    number: int
    text: str

    def error(self, field: str, *, expected: str, found: str) -> ReportError:
        """Return the error of a field of this line, "" for the whole line.

        Parameters
        ----------
        field : str
            The field.
        expected, found : str
            What was expected and what was found, in words.

        Returns
        -------
        ReportError
            The error, to be raised.
        """
        place = f"line {self.number}" + (f", {field}" if field else "")
        return ReportError(self.report, place, expected=expected, found=quoted(found))

    def figure(self, field: str, text: str) -> float:
        """Return a field that is a number.

        Parameters
        ----------
        field : str
            Name of the field.
        text : str
            The field.

        Returns
        -------
        float
            The number.

        Raises
        ------
        ReportError
            If it is none, or one too large to be measured.
        """
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not abs(number) <= LARGEST_NUMBER or "_" in text:
            raise self.error(field, expected="a number", found=text)
        return number


@dataclass(frozen=True, slots=True)
class Table:
    """A table of a report.

    Parameters
    ----------
    labels : tuple of str
        Labels of its columns.
    rows : tuple of tuple
        Its rows: the line, and its fields.
    """

    labels: tuple[str, ...]
    rows: tuple[tuple[Line, tuple[str, ...]], ...]


def report_lines(content: bytes | str | Path, name: str) -> list[Line]:
    """Return the lines of a plain report that hold anything.

    Parameters
    ----------
    content : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.

    Returns
    -------
    list of Line
        The lines, without prompts.

    Raises
    ------
    ReportError
        If it is larger than a relay's report can be, or no text.
    """
    lines = []
    for number, line in enumerate(_text(content, name).splitlines(), 1):
        text = line.strip(" \t\x02\x03")
        if number > MOST_LINES:
            raise ReportError(name, f"line {number}", expected=f"at most {MOST_LINES} lines", found="more")
        if len(text) > LONGEST_LINE:
            raise ReportError(
                name, f"line {number}", expected=f"at most {LONGEST_LINE} characters", found=str(len(text))
            )
        if _CONTROL.search(text):
            raise ReportError(name, f"line {number}", expected="plain text", found=quoted(text))
        if text and not _PROMPT.match(text):
            lines.append(Line(name, number, text))
    return lines


def is_compressed(content: bytes | str | Path, name: str) -> bool:
    """Tell whether a report is in Compressed ASCII: quoted labels first.

    Parameters
    ----------
    content : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.

    Returns
    -------
    bool
        True where it is.

    Raises
    ------
    ReportError
        If it is larger than a relay's report can be.
    """
    text = _text(content, name)
    return re.match(r'[=>\s\x02]*(C\w+\s+)?"', text) is not None


def compressed_table(content: bytes | str | Path, name: str) -> Table:
    """Return the table of a Compressed ASCII report; every line's checksum must be right.

    Parameters
    ----------
    content : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.

    Returns
    -------
    Table
        Its columns and rows; no rows where the relay has no data.

    Raises
    ------
    ReportError
        If it is no such table.
    """
    encoded = _text(content, name).encode("latin-1", "replace")
    try:
        found = list(rows(Path(name), encoded, 0, Repairs(lenient=False)))
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
        if len(row.fields) != len(labels):
            raise line.error("", expected=f"{len(labels)} fields", found=f"{len(row.fields)} fields")
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


def after_head(lines: list[Line], *labels: str) -> Iterator[tuple[Line, list[str]]]:
    """Yield the fields of the lines after the first one that has all `labels` as its fields, itself first.

    Parameters
    ----------
    lines : list of Line
        Lines of a report.
    *labels : str
        Labels that the heading of its table has, whatever their units.

    Yields
    ------
    tuple of Line and list of str
        A line and its fields.
    """
    begun = False
    for line in lines:
        fields = fields_of(line)
        begun = begun or set(labels) <= {label_of(field) for field in fields}
        if begun:
            yield line, fields


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


def _text(content: bytes | str | Path, name: str) -> str:
    if isinstance(content, Path):
        with content.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ReportError(name, "size", expected=f"at most {MOST_BYTES} bytes", found="more")
    return content if isinstance(content, str) else content.decode("latin-1")
