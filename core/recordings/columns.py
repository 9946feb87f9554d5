"""Columns of numbers in a text file (CSV): what loggers and programs for signals write beside COMTRADE."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError, quoted

MOST_OCTETS = 200_000_000
MOST_HEADER_LINES = 100
FEWEST_SAMPLES = 16
UNEVEN = 0.5
"""Farthest that a column of times may be from even steps, in steps: they are written with few digits."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Columns of samples, and how fast they were taken.

    Parameters
    ----------
    names : tuple of str
        Names by the header, else 1, 2, 3 ...; the column of times is not among them.
    samples : ndarray, shape (columns, n)
        Values as they are written.
    sample_rate_hz : float or None
        Sampling rate by the column of times [Hz]; None where there is none.
    """

    names: tuple[str, ...]
    samples: NDArray[np.float64]
    sample_rate_hz: float | None


def read_columns(path: Path) -> Columns:
    """Read columns of numbers, separated by semicolons, tabs, commas or spaces, below a header or none.

    The first of several columns is time in seconds where its values grow evenly.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    Columns
        The columns.

    Raises
    ------
    RecordingError
        If the file is not such a table.
    OSError
        If it cannot be read.
    """
    size = path.stat().st_size
    if size > MOST_OCTETS:
        raise RecordingError(path, "size", expected=f"at most {MOST_OCTETS} octets", found=str(size))
    lines = path.read_bytes().decode("utf-8-sig", "replace").splitlines()
    first = _first_of_numbers(path, lines)
    separator = _separator(lines[first])
    names = _cells(lines[first - 1], separator) if first else []
    rows = [_cells(line, separator) for line in lines[first:] if line.strip()]
    count = len(rows[0])
    for number, row in enumerate(rows, start=first + 1):
        if len(row) != count:
            field = f"row {number}"
            raise RecordingError(
                path, field, expected=f"{count} columns, as in the first", found=str(len(row))
            )
    try:
        values = np.array([[float(cell) for cell in row] for row in rows]).T
    except ValueError as error:
        raise RecordingError(path, "samples", expected="numbers", found=str(error)) from None
    if values.shape[1] < FEWEST_SAMPLES:
        expected = f"{FEWEST_SAMPLES} rows and more"
        raise RecordingError(path, "samples", expected=expected, found=str(values.shape[1]))
    named = tuple(names) if len(names) == count else tuple(str(k) for k in range(1, count + 1))
    rate_hz = _rate_hz(values[0]) if count > 1 else None
    return Columns(named, values, None) if rate_hz is None else Columns(named[1:], values[1:], rate_hz)


def _first_of_numbers(path: Path, lines: list[str]) -> int:
    for number, line in enumerate(lines[: MOST_HEADER_LINES + 1]):
        if line.strip() and all(map(_is_number, _cells(line, _separator(line)))):
            return number
    found = quoted(next((line for line in lines if line.strip()), ""))
    raise RecordingError(path, "header", expected=f"numbers within {MOST_HEADER_LINES} lines", found=found)


def _separator(line: str) -> str | None:
    return next((one for one in (";", "\t", ",") if one in line), None)


def _cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line. Where semicolons separate them, a comma is a decimal point."""
    cells = [cell.strip().strip('"') for cell in line.strip().split(separator)]
    return [cell.replace(",", ".") for cell in cells] if separator == ";" else cells


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _rate_hz(x: NDArray[np.float64]) -> float | None:
    """Return the sampling rate, if these are times."""
    step_s = float(x[-1] - x[0]) / (x.size - 1)
    even = x[0] + step_s * np.arange(x.size)
    is_time = step_s > 0.0 and bool((np.abs(x - even) <= UNEVEN * step_s).all())
    return 1.0 / step_s if is_time else None
