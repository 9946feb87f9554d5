"""How a text file writes a table: what separates its cells, what its numbers look like, where they begin."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from core.recordings.code_pages import decode_text
from core.recordings.errors import RecordingError, quoted
from core.recordings.tables.dates import is_date

MOST_HEADER_LINES = 200
LINES_JUDGED = 50
"""So many lines behind the head tell how the table is written."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?(?i:nan|inf|infinity)")
_COMMA_NUMBER = re.compile(r"[+-]?(\d+,?\d*|,\d+)([eEdD][+-]?\d+)?|[+-]?(?i:nan|inf|infinity)")
_MISSING = frozenset(("", "-", "--", "null", "none", "na", "n/a", "#n/a", "∞", "-∞", "+∞", "overflow", "---"))
"""Cells of values that were not measured, or beyond the range of the instrument."""
_PADDED = re.compile(r"-?0\d+")


@dataclass(frozen=True, slots=True)
class Dialect:
    """How cells are written.

    Parameters
    ----------
    separator : str or None
        Character between cells; None for blanks.
    decimal : str
        "." or ",".
    """

    separator: str | None
    decimal: str

    def cells(self, line: str) -> list[str]:
        """Divide a line.

        Parameters
        ----------
        line : str
            The line.

        Returns
        -------
        list of str
            Its cells, without quotes and blanks around.
        """
        if self.separator is None:
            return [cell.strip('"') for cell in line.split()]
        if '"' in line:
            return [cell.strip() for cell in next(csv.reader([line], delimiter=self.separator), [])]
        return [cell.strip() for cell in line.split(self.separator)]

    def is_number(self, cell: str) -> bool:
        """Tell whether a cell is a number.

        Parameters
        ----------
        cell : str
            The cell.

        Returns
        -------
        bool
            Whether it is.
        """
        return (_NUMBER if self.decimal == "." else _COMMA_NUMBER).fullmatch(cell) is not None

    def is_data(self, cells: Sequence[str]) -> bool:
        """Tell whether a line is one of samples: numbers, dates and what is missing, at least one number.

        Parameters
        ----------
        cells : sequence of str
            Its cells.

        Returns
        -------
        bool
            Whether it is.
        """
        numbers = [self.is_number(cell) for cell in cells]
        return any(numbers) and all(
            known or is_missing(cell) or is_date(cell) for known, cell in zip(numbers, cells, strict=True)
        )


DIALECTS = (
    Dialect(";", "."),
    Dialect(";", ","),
    Dialect("\t", "."),
    Dialect("\t", ","),
    Dialect(",", "."),
    Dialect(",", ","),
    Dialect("|", "."),
    Dialect("|", ","),
    Dialect(None, "."),
    Dialect(None, ","),
)
"""The first one by which most lines are samples is taken."""


def is_missing(cell: str) -> bool:
    """Tell whether a cell stands for a value that was not measured.

    Parameters
    ----------
    cell : str
        The cell.

    Returns
    -------
    bool
        Whether it does.
    """
    return cell.casefold() in _MISSING


@dataclass(frozen=True, slots=True)
class Body:
    """Where the samples of a text file are.

    Parameters
    ----------
    lines : list of str
        All lines of the file.
    first : int
        Number of lines before the samples.
    dialect : Dialect
        How the cells are written.
    width : int
        Number of columns.
    margin : int
        So many columns at the left have no samples: an oscilloscope's head stands beside its first rows.
    """

    lines: list[str]
    first: int
    dialect: Dialect
    width: int
    margin: int


def lines_of(content: bytes) -> list[str]:
    """Divide a text into lines, whatever its encoding and its line ends.

    Parameters
    ----------
    content : bytes
        The text. A byte order mark tells UTF-16, else a zero beside each letter.

    Returns
    -------
    list of str
        The lines.
    """
    head = content[:4096]
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = content.decode("utf-16", "replace")
    elif head[1::2].count(0) > 0.8 * len(head[1::2]) > 0:
        text = content.decode("utf-16-le", "replace")
    elif head[::2].count(0) > 0.8 * len(head[::2]) > 0:
        text = content.decode("utf-16-be", "replace")
    else:
        text = decode_text(content)
    return re.split(r"\r\n|\r|\n", text.rstrip("\x1a\r\n\0 \t"))


def find_body(path: Path, lines: list[str]) -> Body:
    """Find where the samples of a text file begin, and how they are written.

    Parameters
    ----------
    path : pathlib.Path
        The file, for messages.
    lines : list of str
        Its lines.

    Returns
    -------
    Body
        The samples.

    Raises
    ------
    RecordingError
        If there are none, or a comma may be a separator or a decimal one.
    """
    judged = [line for line in lines[: MOST_HEADER_LINES + LINES_JUDGED] if line.strip()][-LINES_JUDGED:]
    found = [(dialect, _width(dialect, judged)) for dialect in DIALECTS]
    dialect, (fitting, width) = max(found, key=lambda one: one[1][0])
    first, margin = _first(lines, dialect, width) if fitting else (None, 0)
    if first is None:
        shown = quoted(next((line for line in lines if line.strip()), ""))
        expected = f"a table whose numbers begin within {MOST_HEADER_LINES} lines"
        raise RecordingError(path, "header", expected=expected, found=shown)
    _require_plain_commas(path, dialect, judged)
    _require_no_samples_above(path, lines, first, width)
    return Body(lines, first, dialect, width, margin)


def _width(dialect: Dialect, lines: Sequence[str]) -> tuple[int, int]:
    """Return how many lines are samples by a dialect, and how many columns most of them have."""
    widths: dict[int, int] = {}
    for line in lines:
        if dialect.separator is not None and dialect.separator not in line:
            continue
        if dialect == Dialect(",", ",") and '"' not in line:
            continue
        cells = dialect.cells(line)
        if dialect.is_data(cells):
            width = len(cells)
            widths[width] = widths.get(width, 0) + 1
    if not widths:
        return 0, 0
    width = max(widths, key=lambda one: (widths[one], one))
    return widths[width], width


def _first(lines: Sequence[str], dialect: Dialect, width: int) -> tuple[int | None, int]:
    """Return the first line of samples, and how many columns beside them are the head of an oscilloscope."""
    first = None
    for number, line in enumerate(lines[: MOST_HEADER_LINES + LINES_JUDGED]):
        cells = dialect.cells(line)
        if line.strip() and len(cells) == width and dialect.is_data(cells):
            first = number
            break
    if first is None:
        return None, 0
    filled = [place for place, cell in enumerate(dialect.cells(lines[first])) if cell]
    if filled[0] == 0:
        return first, 0
    while first > 0:
        cells = dialect.cells(lines[first - 1])
        if len(cells) != width or not all(dialect.is_number(cells[place]) for place in filled):
            break
        first -= 1
    return first, filled[0]


def _require_no_samples_above(path: Path, lines: Sequence[str], first: int, width: int) -> None:
    """Refuse a line of numbers above the samples with other columns: they would be lost."""
    if first == 0 or not lines[first - 1].strip():
        return
    for dialect in DIALECTS:
        cells = dialect.cells(lines[first - 1])
        if len(cells) > 1 and all(map(dialect.is_number, cells)):
            found = f"{len(cells)} numbers"
            raise RecordingError(path, f"row {first}", expected=f"{width} columns, as below it", found=found)


def _require_plain_commas(path: Path, dialect: Dialect, lines: Sequence[str]) -> None:
    """Refuse commas between digits that may be decimal commas or separators: 0,0002,1,5."""
    if dialect != Dialect(",", ".") or any("." in line or '"' in line for line in lines):
        return
    padded = next((line for line in lines if any(map(_PADDED.fullmatch, dialect.cells(line)[1:]))), None)
    if padded is not None:
        raise RecordingError(
            path,
            "numbers",
            expected="semicolons or tabs between columns whose numbers have decimal commas",
            found=f"{quoted(padded)}, where a comma may be either",
        )
