"""Lines and fields of a COMTRADE configuration file, each with its place for messages."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from core.recordings.errors import RecordingError, quoted

MAX_LINE = 10_000

_INTEGER = re.compile(r"[+-]?[0-9]{1,10}", re.ASCII)
_REAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,4})?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a file, split at its commas.

    Parameters
    ----------
    path : pathlib.Path
        File of the line.
    number : int
        Its number in the file, from 1.
    what : str
        What the line is about.
    fields : tuple of str
        Its fields.
    """

    path: Path
    number: int
    what: str
    fields: tuple[str, ...]

    def refuse(self, field: str, expected: str, found: str) -> RecordingError:
        """Return the error for a field of this line, to be raised or mended.

        Parameters
        ----------
        field : str
            Field at fault, "" for the line as a whole.
        expected : str
            What was expected, in words.
        found : str
            What was found, in words.

        Returns
        -------
        RecordingError
            The error.
        """
        where = f"line {self.number}, {self.what}" + (f", {field}" if field else "")
        return RecordingError(self.path, where, expected=expected, found=found)

    def has_fields(self, *counts: int) -> None:
        """Check the number of fields.

        Parameters
        ----------
        *counts : int
            Numbers that are allowed.

        Raises
        ------
        RecordingError
            If it is none of `counts`.
        """
        if len(self.fields) not in counts:
            expected = " or ".join(str(count) for count in counts)
            raise self.refuse(
                "", f"{expected} field{'' if counts == (1,) else 's'}", f"{len(self.fields)}: {self.quoted()}"
            )

    def quoted(self) -> str:
        """Return the line as a message shows it.

        Returns
        -------
        str
            Short text without control characters.
        """
        return quoted(",".join(self.fields))

    def integer(self, index: int, field: str, at_least: int, at_most: int) -> int:
        """Return an integer within limits.

        Parameters
        ----------
        index : int
            Position of the field, from 0.
        field : str
            Name of the field, for messages.
        at_least : int
            Least value.
        at_most : int
            Greatest value.

        Returns
        -------
        int
            The number.

        Raises
        ------
        RecordingError
            If the field holds no such number.
        """
        text = self.fields[index]
        if not _INTEGER.fullmatch(text) or not at_least <= int(text) <= at_most:
            raise self.refuse(field, f"an integer from {at_least} to {at_most}", quoted(text))
        return int(text)

    def real(self, index: int, field: str) -> float:
        """Return a finite number.

        Parameters
        ----------
        index : int
            Position of the field, from 0.
        field : str
            Name of the field, for messages.

        Returns
        -------
        float
            The number.

        Raises
        ------
        RecordingError
            If the field holds no such number.
        """
        text = self.fields[index]
        if not _REAL.fullmatch(text) or not isfinite(float(text)):
            raise self.refuse(field, "a finite number", quoted(text))
        return float(text)

    def positive(self, index: int, field: str, at_least: float = 0.0, at_most: float = 1e300) -> float:
        """Return a positive number within limits.

        Parameters
        ----------
        index : int
            Position of the field, from 0.
        field : str
            Name of the field, for messages.
        at_least : float, default 0.0
            Least value.
        at_most : float, optional
            Greatest value.

        Returns
        -------
        float
            The number.

        Raises
        ------
        RecordingError
            If the field holds no such number.
        """
        value = self.real(index, field)
        if not (value > 0 and at_least <= value <= at_most):
            limits = (
                "a number greater than 0" if at_least == 0 else f"a number from {at_least:g} to {at_most:g}"
            )
            raise self.refuse(field, limits, quoted(self.fields[index]))
        return value


class Lines:
    """The lines of a file, one after another.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    text : str
        Text of the file.
    """

    def __init__(self, path: Path, text: str) -> None:
        # Not str.splitlines: in Latin-1 it would also split at 0x85, a letter of other code pages.
        self._lines = re.split(r"\r\n|\n|\r", text)
        self._path = path
        self._next = 0

    def next(self, what: str) -> Line:
        """Return the next line.

        Parameters
        ----------
        what : str
            What the line is about, for messages.

        Returns
        -------
        Line
            The line.

        Raises
        ------
        RecordingError
            If the file has ended.
        """
        if self._next >= len(self._lines):
            raise RecordingError(
                self._path, f"line {self._next + 1}", expected=what, found="the end of the file"
            )
        text = self._lines[self._next]
        self._next += 1
        if len(text) > MAX_LINE:
            raise RecordingError(
                self._path,
                f"line {self._next}",
                expected=f"at most {MAX_LINE} characters",
                found=str(len(text)),
            )
        return Line(self._path, self._next, what, tuple(field.strip() for field in text.split(",")))

    def fields_ahead(self) -> int:
        """Return the number of fields of the next line.

        Returns
        -------
        int
            The number; 0 where the file has ended.
        """
        return self._lines[self._next].count(",") + 1 if self._next < len(self._lines) else 0

    def remaining(self) -> Iterator[Line]:
        """Return the lines not read yet.

        Yields
        ------
        Line
            A line.
        """
        while self._next < len(self._lines):
            yield self.next("end of the file")

    def __len__(self) -> int:
        return len(self._lines)
