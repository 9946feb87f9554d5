"""The text of a relay report and its lines, within limits.

A report is a file of the relay, or what a terminal showed: prompts (=>) and the commands behind them are
passed over, and so are blank lines. A plain report begins with the relay's name and clock.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from core.recordings.errors import quoted
from core.relay_reports.error import ReportError

MOST_BYTES = 8 << 20
MOST_LINES = 200_000
LONGEST_LINE = 2_000
LARGEST_NUMBER = 1e12

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\uffff]")
_PROMPT = re.compile(r"=+>")
_QUOTED_FIRST = re.compile(r'[=>\s\x02]*(C\w+\s+)?"')
_QUANTITY = re.compile(r"(\d+(?:\.\d+)?)\s*[AVs%]?", re.ASCII)


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

    def quantity(self, field: str, text: str) -> float:
        """Return a field that is a size, with its unit or without.

        Parameters
        ----------
        field : str
            Name of the field.
        text : str
            The field, such as "8.62 A".

        Returns
        -------
        float
            The number in the unit that it has.

        Raises
        ------
        ReportError
            If it is none, is below zero, or too large to be measured.
        """
        found = _QUANTITY.fullmatch(text)
        if found is None:
            raise self.error(field, expected="a number", found=text)
        return self.figure(field, found[1])

    def require_fields(self, fields: Sequence[str], number: int) -> None:
        """Refuse a line of a table with another number of fields than its heading.

        Parameters
        ----------
        fields : sequence of str
            Fields of the line.
        number : int
            Fields of the heading.

        Raises
        ------
        ReportError
            If they are not as many.
        """
        if len(fields) != number:
            raise self.error("", expected=f"{number} fields", found=f"{len(fields)} fields")


@dataclass(frozen=True, slots=True)
class ReportText:
    """The text of a report.

    Parameters
    ----------
    name : str
        What errors call the report.
    text : str
        All of it, with what a terminal showed beside.
    """

    name: str
    text: str

    @property
    def is_compressed(self) -> bool:
        """Whether it is in Compressed ASCII: quoted labels first."""
        return _QUOTED_FIRST.match(self.text) is not None

    def lines(self) -> list[Line]:
        """Return the lines that hold anything.

        Returns
        -------
        list of Line
            The lines, without prompts.

        Raises
        ------
        ReportError
            If there are more, or longer ones, than a relay writes, or it is no text.
        """
        lines = []
        for number, line in enumerate(self.text.splitlines(), 1):
            text = line.strip(" \t\x02\x03")
            place = f"line {number}"
            if number > MOST_LINES:
                raise ReportError(self.name, place, expected=f"at most {MOST_LINES} lines", found="more")
            if len(text) > LONGEST_LINE:
                most = f"at most {LONGEST_LINE} characters"
                raise ReportError(self.name, place, expected=most, found=str(len(text)))
            if _CONTROL.search(text):
                raise ReportError(self.name, place, expected="plain text", found=quoted(text))
            if text and not _PROMPT.match(text):
                lines.append(Line(self.name, number, text))
        return lines


def report_text(content: bytes | str | Path, name: str) -> ReportText:
    """Return the text of a report.

    Parameters
    ----------
    content : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.

    Returns
    -------
    ReportText
        Its text.

    Raises
    ------
    ReportError
        If it is larger than a relay's report can be.
    OSError
        If the file cannot be read.
    """
    if isinstance(content, Path):
        with content.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ReportError(name, "size", expected=f"at most {MOST_BYTES} bytes", found="more")
    return ReportText(name, content if isinstance(content, str) else content.decode("latin-1"))
