"""SEL Compressed ASCII: lines of comma-separated fields, each closed by its checksum.

    "FID","0143"

The checksum is the sum of all bytes up to and with the comma before it, modulo 65536, in four hexadecimal
digits (SEL-351A and SEL-311L instruction manuals, Compressed ASCII Commands).
"""

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

STX, ETX = b"\x02", b"\x03"
_LONGEST_LINE = 1 << 20
_MOST_PROMPTS = 1000
_LINE = re.compile(rb"[^\r\n]+")
_CLOSED = re.compile(rb'(.*,) *"([0-9A-Fa-f]{4})"', re.S)
_PROMPT = re.compile(rb"[=>\s\x02\x03]*")


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a Compressed ASCII file.

    Parameters
    ----------
    path : pathlib.Path
        File of the line.
    number : int
        Its number in the file, from 1.
    fields : tuple of str
        Its fields without quotes and checksum.
    end : int
        Where the line ends in the file [bytes].
    """

    path: Path
    number: int
    fields: tuple[str, ...]
    end: int

    def refuse(self, field: str, expected: str, found: str) -> RecordingError:
        """Return the error for a field of this line, to be raised or mended.

        Parameters
        ----------
        field : str
            Field at fault, "" for the whole line.
        expected : str
            What was expected, in words.
        found : str
            What was found, in words.

        Returns
        -------
        RecordingError
            The error.
        """
        where = f"line {self.number}" + (f", {field}" if field else "")
        return RecordingError(self.path, where, expected=expected, found=found)


def checksum(content: bytes) -> str:
    """Return the checksum of a line, four hexadecimal digits.

    Parameters
    ----------
    content : bytes
        The line up to and with the comma before its checksum.

    Returns
    -------
    str
        The digits.
    """
    return f"{sum(content) & 0xFFFF:04X}"


def closed(fields: str) -> bytes:
    """Return a line of fields with its checksum and line end.

    Parameters
    ----------
    fields : str
        The fields as they are to be written.

    Returns
    -------
    bytes
        The line.
    """
    content = fields.encode("ascii") + b","
    return content + b'"' + checksum(content).encode("ascii") + b'"\r\n'


def is_row_next(content: bytes, start: int, end: int) -> bool:
    """Return whether the next line that is no prompt has a checksum.

    Parameters
    ----------
    content : bytes
        Contents of the file.
    start, end : int
        The part that is looked at.

    Returns
    -------
    bool
        Whether it has; without such a line, False.
    """
    for match in _LINE.finditer(content, start, end):
        line = match[0].strip(b" \t" + STX + ETX)
        if not _PROMPT.fullmatch(line):
            return _CLOSED.fullmatch(line) is not None
    return False


def rows(path: Path, content: bytes, start: int, end: int, repairs: Repairs) -> Iterator[Row]:
    """Read the lines of a file; prompts and blank lines are passed over.

    A lenient reader believes fields whose checksum is wrong and leaves out lines that have none.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    content : bytes
        Contents of the file.
    start, end : int
        The part that is read.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Yields
    ------
    Row
        A line.

    Raises
    ------
    RecordingError
        If a line is at fault.
    """
    number = 1 + _line_ends(content[:start])
    at, prompts = start, 0
    for match in _LINE.finditer(content, start, end):
        number += _line_ends(content[at : match.start()])
        at = match.end()
        if at - match.start() > _LONGEST_LINE:
            raise RecordingError(
                path,
                f"line {number}",
                expected=f"at most {_LONGEST_LINE} characters",
                found=str(at - match.start()),
            )
        line = match[0].strip(b" \t" + STX + ETX)
        if _PROMPT.fullmatch(line):
            prompts += 1
            if prompts > _MOST_PROMPTS:
                raise RecordingError(
                    path, f"line {number}", expected="an event report", found=f"{prompts} lines of prompts"
                )
            continue
        try:
            fields = _fields(path, number, line, repairs)
        except RecordingError as fault:
            repairs.mend(fault, "the line is left out")
        else:
            yield Row(path, number, fields, at)


def _fields(path: Path, number: int, line: bytes, repairs: Repairs) -> tuple[str, ...]:
    parts = _CLOSED.fullmatch(line)
    if parts is None:
        raise RecordingError(
            path,
            f"line {number}",
            expected='fields and a checksum such as ,"0143"',
            found=quoted(line[-60:].decode("latin-1")),
        )
    expected = checksum(parts[1])
    if parts[2].decode("ascii").upper() != expected:
        fault = RecordingError(
            path, f"line {number}, checksum", expected=expected, found=parts[2].decode("ascii")
        )
        repairs.mend(fault, "the line is read as it is")
    try:
        (fields,) = csv.reader([parts[1][:-1].decode("latin-1")], strict=True, skipinitialspace=True)
    except csv.Error as error:
        raise RecordingError(
            path, f"line {number}", expected="fields between commas, texts in quotes", found=str(error)
        ) from error
    return tuple(field.strip() for field in fields)


def _line_ends(content: bytes) -> int:
    return content.count(b"\n") + content.count(b"\r") - content.count(b"\r\n")
