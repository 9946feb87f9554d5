"""Lines and fields of a COMTRADE configuration file, each with its place for messages."""

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path

from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

MAX_LINE = 10_000
MOST_COMMAS = 4
"""In a name; a line with more fields is of another kind."""

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
    text : str
        The line as written.
    """

    path: Path
    number: int
    what: str
    fields: tuple[str, ...]
    text: str

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

    def warned(self, sentence: str) -> str:
        """Return a warning of this line.

        Parameters
        ----------
        sentence : str
            What was found, and how it is read.

        Returns
        -------
        str
            The warning, with file and line.
        """
        return f"{self.path.name}: line {self.number}, {self.what}: {sentence}"

    def of(self, count: int, *, repairs: Repairs, name: int | None = None) -> "Line":
        """Return the line in as many fields as it must have.

        Quotes around fields and commas behind the last one are taken off. Where the line holds a name,
        further commas are the name's: the fields behind it are counted from the right end. A warning tells
        of each.

        Parameters
        ----------
        count : int
            Number of fields.
        repairs : Repairs
            Collects what departs from the standard.
        name : int or None, optional
            Position of the name, from 0; None for a line without one.

        Returns
        -------
        Line
            The line.

        Raises
        ------
        RecordingError
            If it has another number of fields.
        """
        if len(self.fields) == count and '"' not in self.text:
            return self
        fault = self.refuse("", f"{count} field{'s' * (count != 1)}", f"{len(self.fields)}: {self.quoted()}")
        if any(field.startswith('"') and field != '"' for field in self.fields):
            unquoted = self._unquoted()
            if len(unquoted) == count:
                repairs.warn(self.warned(f"quotes are taken off: {self.quoted()}"))
                return replace(self, fields=unquoted)
        fields = self.fields
        while len(fields) > count and not fields[-1]:
            fields = fields[:-1]
        if len(fields) == count:
            if fields != self.fields:
                repairs.warn(f"{fault}: the commas at the end are passed over")
            return replace(self, fields=fields)
        if name is None or not count < len(fields) <= count + MOST_COMMAS:
            raise fault
        behind = name + len(fields) - count + 1
        named = ",".join(self.fields_as_written[name:behind]).strip()
        repairs.warn(f"{fault}: read as a name with commas, {quoted(named)}")
        return replace(self, fields=(*fields[:name], named, *fields[behind:]))

    def _unquoted(self) -> tuple[str, ...]:
        """Fields where those in quotes may have commas inside."""
        (fields,) = csv.reader([",".join(self.fields_as_written)], skipinitialspace=True)
        return tuple(field.strip() for field in fields)

    @property
    def fields_as_written(self) -> tuple[str, ...]:
        """The fields with their blanks."""
        return tuple(self.text.split(","))

    @property
    def joined(self) -> str:
        """The line without blanks around its fields."""
        return ",".join(self.fields)

    def quoted(self) -> str:
        """Return the line as a message shows it.

        Returns
        -------
        str
            Short text without control characters.
        """
        return quoted(self.joined)

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
        # A line end that was made one of Windows twice has two carriage returns.
        self._lines = re.split(r"\r*\n|\r", text)
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
        return Line(self._path, self._next, what, tuple(field.strip() for field in text.split(",")), text)

    def ahead(self, lines: int = 0) -> tuple[str, ...]:
        """Return the fields of a line that is not read yet.

        Parameters
        ----------
        lines : int, default 0
            Lines between the next one and this.

        Returns
        -------
        tuple of str
            The fields; none where the file has ended.
        """
        at = self._next + lines
        if at >= len(self._lines):
            return ()
        return tuple(field.strip() for field in self._lines[at][:MAX_LINE].split(","))

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
