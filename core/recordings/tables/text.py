"""Tables in text files: separated by semicolons, tabs, commas, bars or blanks, below a head or none.

What is decided here, where there is no standard:

- Where the cells have decimal commas, commas do not separate; where that cannot be told the file is refused.
- The line above the samples has the names; if it has units, the line above it. A unit may also stand behind
  a name: "Time (ms)", "I_L1 [A]".
- Sampling interval or rate of the head count where no column has the times.
- Empty cells, "-", "null" and an oscilloscope's infinity are missing values.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError, quoted
from core.recordings.tables.dates import instants, is_date
from core.recordings.tables.table import Column, Table
from core.recordings.tables.text_lines import Body, Dialect, find_body, is_missing, lines_of
from core.recordings.tables.time_column import SECONDS_BY_UNIT, is_time_unit, renamed, table_of

_WORDS = frozenset(["volt", "volts", "amp", "amps", "ampere", "amperes"])
"""Units that are no name of anything else."""
_UNITS = _WORDS.union(
    (
        "v",
        "mv",
        "uv",
        "kv",
        "a",
        "ma",
        "ua",
        "ka",
        "hz",
        "khz",
        "rpm",
        "nm",
        "n",
        "kn",
        "pa",
        "bar",
        "w",
        "kw",
    ),
    ("va", "kva", "var", "kvar", "°c", "c", "k", "%", "deg", "rad", "g", "m/s", "m/s²", "m/s2", "mm/s"),
    ("count", "counts", "adc"),
)
MOST_LINES_BEHIND = 20
_BESIDE_NAME = re.compile(r".*\S\s*[\[(](?P<unit>[^\[\]()]*)[\])]|.*\S\s*/\s*(?P<behind>[munkµμM]?[sAV])")
_IN_BRACKETS = re.compile(r"[\[(](.*)[\])]")
_INTERVAL = re.compile(
    r"x?(sampl(e|ing)[ _]?)?(interval|period|increment|resolution)s?|h[-_ ]?resolution|x_?incr|"
    r"delta_?[xt]|d[xt]|sample ?time|sampling ?time|abtastintervall",
    re.IGNORECASE,
)
_RATE = re.compile(
    r"(sampl(e|ing)[ _]?)(rate|frequency|freq)|fs|f_s|samples? ?per ?second|samples/s|abtastrate",
    re.IGNORECASE,
)
_WITH_UNIT = re.compile(r"([+-]?[\d.,]+(?:[eE][+-]?\d+)?)\s*([A-Za-zµμ/]*)")
_HERTZ = {"": 1.0, "hz": 1.0, "khz": 1e3, "mhz": 1e6, "s/s": 1.0, "sa/s": 1.0, "ks/s": 1e3, "ksa/s": 1e3}


def read_text_table(path: Path) -> Table:
    """Read a table from a text file.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If the file is no such table.
    OSError
        If it cannot be read.
    """
    body, notes = _without_words_behind(find_body(path, lines_of(path.read_bytes())))
    head = _head(body)
    columns = [
        Column(head.names[place], head.units[place], values, dates_ns, is_time)
        for place, (values, dates_ns, is_time) in enumerate(_columns(path, body))
        if is_time or not np.isnan(values).all()
    ]
    return table_of(path, renamed(columns), sample_rate_hz=_rate_hz(body), notes=notes)


def _without_words_behind(body: Body) -> tuple[Body, tuple[str, ...]]:
    """Leave out the last lines that have words and no numbers, which loggers put behind the samples."""
    lines, behind = list(body.lines), ""
    while len(lines) > body.first and len(body.lines) - len(lines) <= MOST_LINES_BEHIND:
        cells = body.dialect.cells(lines[-1])
        if len(cells) == body.width or any(map(body.dialect.is_number, cells)):
            break
        behind = lines.pop().strip() or behind
    if not behind:
        return body, ()
    return replace(body, lines=lines), (f"what is behind the samples is passed over: {quoted(behind)}",)


@dataclass(frozen=True, slots=True)
class _Head:
    names: tuple[str, ...]
    units: tuple[str, ...]


def _head(body: Body) -> _Head:
    """Return names and units by the lines above the samples."""
    above = [body.dialect.cells(line) for line in body.lines[: body.first] if line.strip()]
    rows = [cells for cells in above[-3:] if len(cells) in (body.width, body.width + 1)]
    units = [""] * body.width
    if len(rows) > 1 and _are_units(rows[-1]):
        units = [_without_brackets(cell) for cell in rows.pop()[: body.width]]
    written = rows[-1][: body.width] if rows and _are_names(rows[-1], body.dialect) else [""] * body.width
    names = [name or str(place) for place, name in enumerate(written, start=1)]
    found = [unit or _unit_beside(name) for name, unit in zip(names, units, strict=True)]
    return _Head(tuple(names), tuple(found))


def _are_names(cells: Sequence[str], dialect: Dialect) -> bool:
    return any(cell and not dialect.is_number(cell) for cell in cells)


def _are_units(cells: Sequence[str]) -> bool:
    """Tell whether a line has units: all in brackets, or all known as such."""
    filled = [cell for cell in cells if cell]
    return bool(filled) and (
        all(map(_IN_BRACKETS.fullmatch, filled))
        or all(cell.casefold() in _UNITS or is_time_unit(cell) or cell == "Sequence" for cell in filled)
    )


def _without_brackets(cell: str) -> str:
    inside = _IN_BRACKETS.fullmatch(cell)
    return inside[1].strip() if inside else cell


def _unit_beside(name: str) -> str:
    beside = _BESIDE_NAME.fullmatch(name)
    if beside is None:
        return name if name.casefold() in _WORDS or is_time_unit(name) else ""
    unit = (beside["unit"] or beside["behind"]).strip()
    return unit if unit.casefold() in _UNITS or is_time_unit(unit) else ""


def _columns(path: Path, body: Body) -> list[tuple[NDArray[np.float64], int | None, bool]]:
    """Return values, UTC of the first row, and whether these are times, of each column."""
    lines = [line for line in body.lines[body.first :] if line.strip()]
    if body.dialect.decimal == "," and not any('"' in line for line in lines):
        lines = [line.replace(",", ".") for line in lines]
    dialect = Dialect(body.dialect.separator, ".")
    values = _plain_numbers(lines, dialect, body.width)
    if values is not None:
        return [(column, None, False) for column in values]
    rows = _rows(path, lines, dialect, body)
    return [
        _nothing(len(rows)) if place < body.margin else _column(path, body, place, cells)
        for place, cells in enumerate(zip(*rows, strict=True))
    ]


def _nothing(rows: int) -> tuple[NDArray[np.float64], int | None, bool]:
    return np.full(rows, np.nan), None, False


def _plain_numbers(lines: list[str], dialect: Dialect, width: int) -> NDArray[np.float64] | None:
    """Read lines that have a plain number in every cell; None where some have not."""
    try:
        values = np.loadtxt(lines, delimiter=dialect.separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return values.T if values.shape == (len(lines), width) else None


def _rows(path: Path, lines: Sequence[str], dialect: Dialect, body: Body) -> list[list[str]]:
    rows = []
    for number, line in enumerate(lines, start=body.first + 1):
        cells = dialect.cells(line)
        if len(cells) > body.width and not any(cells[body.width :]):
            cells = cells[: body.width]
        if len(cells) != body.width:
            raise RecordingError(
                path,
                f"row {number}",
                expected=f"{body.width} columns, as in most others",
                found=str(len(cells)),
            )
        rows.append(cells)
    return rows


def _column(
    path: Path, body: Body, place: int, cells: Sequence[str]
) -> tuple[NDArray[np.float64], int | None, bool]:
    if is_date(cells[0]):
        first_ns, seconds = instants(cells)
        return seconds, first_ns, True
    values = np.full(len(cells), np.nan)
    for row, cell in enumerate(cells):
        if is_missing(cell):
            continue
        written = cell.replace(",", ".") if body.dialect.decimal == "," else cell
        if not Dialect(None, ".").is_number(written):
            field = f"row {body.first + 1 + row}, column {place + 1}"
            raise RecordingError(path, field, expected="a number, as in other rows", found=repr(cell[:60]))
        values[row] = float(written.replace("d", "e").replace("D", "e"))
    return values, None, False


def _rate_hz(body: Body) -> float | None:
    """Return the sampling rate by the head of the file [Hz]; None where it tells none."""
    above = [_head_cells(body, line) for line in body.lines[: body.first]]
    if body.first < len(body.lines):
        above += [body.dialect.cells(line) for line in body.lines[body.first : body.first + 20]]
    for number, cells in enumerate(above):
        for place, cell in enumerate(cells):
            key, _, inside = cell.lstrip(" #%;*").replace("=", ":", 1).partition(":")
            key, unit = _key_and_unit(key)
            if not (_INTERVAL.fullmatch(key) or _RATE.fullmatch(key)):
                continue
            beside = cells[place + 1 : place + 3]
            below = above[number + 1][place : place + 1] if number + 1 < len(above) else []
            for value in (inside.strip(), *beside[:1], *below):
                rate_hz = _rate_of(key, value, unit or (beside[1] if len(beside) > 1 else ""), body.dialect)
                if rate_hz is not None:
                    return rate_hz
    return None


def _head_cells(body: Body, line: str) -> list[str]:
    """Divide a line of the head, which may have separators where the samples, of one column, have none."""
    separator = body.dialect.separator
    if separator is None:
        separator = next((one for one in ("\t", ";", ",") if one in line), "\t")
    return Dialect(separator, body.dialect.decimal).cells(line)


def _key_and_unit(key: str) -> tuple[str, str]:
    beside = re.fullmatch(r"(.*\S)\s*[\[(]([^\[\]()]*)[\])]", key.strip())
    return (beside[1], beside[2]) if beside else (key.strip(), "")


def _rate_of(key: str, value: str, unit: str, dialect: Dialect) -> float | None:
    match = _WITH_UNIT.fullmatch(value.strip())
    if match is None:
        return None
    text = match[1].replace(",", ".") if dialect.decimal == "," else match[1]
    number = float(text) if Dialect(None, ".").is_number(text) else 0.0
    told = (match[2] or unit).strip()
    if not 0.0 < number < np.inf:
        return None
    if _RATE.fullmatch(key):
        return number * _HERTZ.get(told.casefold(), 1.0)
    return 1.0 / (number * SECONDS_BY_UNIT.get(told.casefold(), 1.0))
