"""Lines and fields of a COMTRADE configuration file, each with its place for messages."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from core.recordings.errors import RecordingError

MAX_LINE = 10_000

_INTEGER = re.compile(r"[+-]?[0-9]{1,10}", re.ASCII)
_REAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,4})?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Line:
    """One line split at its commas; `what` says what the line is about."""

    path: Path
    number: int
    what: str
    fields: tuple[str, ...]

    def refuse(self, field: str, expected: str, found: str) -> RecordingError:
        """The error for `field` of this line ("" for the line as a whole), to be raised or mended."""
        where = f"line {self.number}, {self.what}" + (f", {field}" if field else "")
        return RecordingError(self.path, where, expected=expected, found=found)

    def has_fields(self, *counts: int) -> None:
        """Raises RecordingError where the number of fields is none of `counts`."""
        if len(self.fields) not in counts:
            expected = " or ".join(str(count) for count in counts)
            raise self.refuse(
                "", f"{expected} field{'' if counts == (1,) else 's'}", f"{len(self.fields)}: {self.quoted()}"
            )

    def quoted(self) -> str:
        return quoted(",".join(self.fields))

    def integer(self, index: int, field: str, at_least: int, at_most: int) -> int:
        """An integer within limits. Raises RecordingError."""
        text = self.fields[index]
        if not _INTEGER.fullmatch(text) or not at_least <= int(text) <= at_most:
            raise self.refuse(field, f"an integer from {at_least} to {at_most}", quoted(text))
        return int(text)

    def real(self, index: int, field: str) -> float:
        """A finite number. Raises RecordingError."""
        text = self.fields[index]
        if not _REAL.fullmatch(text) or not isfinite(float(text)):
            raise self.refuse(field, "a finite number", quoted(text))
        return float(text)

    def positive(self, index: int, field: str, at_least: float = 0.0, at_most: float = 1e300) -> float:
        """A positive number within limits. Raises RecordingError."""
        value = self.real(index, field)
        if not (value > 0 and at_least <= value <= at_most):
            limits = (
                "a number greater than 0" if at_least == 0 else f"a number from {at_least:g} to {at_most:g}"
            )
            raise self.refuse(field, limits, quoted(self.fields[index]))
        return value


class Lines:
    """The file's lines one after another."""

    def __init__(self, path: Path, text: str) -> None:
        # Not str.splitlines: in Latin-1 it would also split at 0x85, a letter of other code pages.
        self._lines = re.split(r"\r\n|\n|\r", text)
        self._path = path
        self._next = 0

    def next(self, what: str) -> Line:
        """The next line. Raises RecordingError at the end of the file."""
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

    def remaining(self) -> Iterator[Line]:
        while self._next < len(self._lines):
            yield self.next("end of the file")

    def __len__(self) -> int:
        return len(self._lines)


def quoted(text: str) -> str:
    """Text from a file, for a message: short and without control characters."""
    return repr(text if len(text) <= 60 else text[:57] + "...")
