"""The ASCII form of the COMTRADE data file: one line a sample (C37.111-1999, 6.4)."""

import re
from math import nan
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.comtrade_configuration import Configuration
from core.recordings.comtrade_data import SampleNumbers, SampleTable
from core.recordings.comtrade_lines import quoted
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs

MISSING = 99_999
"""The mark of a missing value since 1999; 1991 leaves the field blank, which all editions understand."""

_TABLE = re.compile(r"[0-9+\-.eE, \t\n]*", re.ASCII)
_FIELD = re.compile(r"[0-9+\-.eE]+", re.ASCII)
_BLANK_LINES = re.compile(rb"\n[ \t\n]*\n")
_MAX_FIELD = 32
_BLOCK_BYTES = 1 << 16


def decode_ascii(section: DataSection, configuration: Configuration, repairs: Repairs) -> SampleTable:
    """Read the samples of an ASCII file.

    A lenient reader takes the lines there are, up to the number announced.

    Parameters
    ----------
    section : DataSection
        Place of the data in the file.
    configuration : Configuration
        The checked configuration file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    SampleTable
        The samples as written.

    Raises
    ------
    RecordingError
        If lines, fields or sample numbers do not fit the configuration.
    OSError
        If the file cannot be read.
    """
    content = section.content().rstrip(b"\x1a\r\n\t ")
    content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = content.count(b"\n") + 1 if content else 0
    if lines != configuration.sample_count and (squeezed := _BLANK_LINES.sub(b"\n", content)) != content:
        repairs.mend(_fault(section.path, lines, configuration.sample_count), "blank lines are passed over")
        content, lines = squeezed, squeezed.count(b"\n") + 1
    analog, states = len(configuration.analog), len(configuration.status_names)
    samples = _sample_count(section.path, lines, configuration.sample_count, repairs)
    if samples * (1 + analog + states) > len(content):  # a line is no shorter than its commas
        raise RecordingError(
            section.path,
            "size",
            expected=f"{2 + analog + states} fields a line",
            found=f"{len(content)} characters on {lines} lines",
        )
    table = SampleTable.empty(configuration, samples)
    numbers = SampleNumbers(section.path, repairs)
    first = start = 0
    while first < samples:
        end = content.find(b"\n", start + _BLOCK_BYTES)
        end = len(content) if end < 0 else end
        block_lines = content[start:end].decode("latin-1").split("\n")[: samples - first]
        block = _numbers(section.path, block_lines, first, analog, states)
        numbers.check(block[:, 0])
        last = first + block.shape[0]
        table.stamps[first:last] = block[:, 1]
        table.counts[:, first:last] = block[:, 2 : 2 + analog].T
        table.status[first:last] = _packed(section.path, block[:, 2 + analog :], first, 3 + analog)
        first, start = last, end + 1
    if configuration.revision >= 1999:
        table.counts[table.counts == MISSING] = np.nan
    return table


def _sample_count(path: Path, lines: int, announced: int, repairs: Repairs) -> int:
    if lines == announced:
        return lines
    fault = _fault(path, lines, announced)
    if lines == 0:
        raise fault
    whole = min(lines, announced)
    repairs.mend(fault, f"{whole} samples are read")
    return whole


def _fault(path: Path, lines: int, announced: int) -> RecordingError:
    return RecordingError(path, "size", expected=f"{announced} lines, one a sample", found=f"{lines} lines")


def _numbers(path: Path, lines: list[str], first: int, analog: int, states: int) -> NDArray[np.float64]:
    """Fields of some lines as numbers, shape (lines, fields); an empty one is NaN, a value not recorded."""
    columns = 2 + analog + states
    for number, line in enumerate(lines, first + 1):
        if line.count(",") != columns - 1:
            raise RecordingError(
                path,
                f"line {number}",
                expected=f"{columns} fields: number, time stamp, {analog} analogue and {states} status "
                "values",
                found=f"{line.count(',') + 1}: {quoted(line)}",
            )
    fields = [field.strip() for field in ",".join(lines).split(",")]
    if _TABLE.fullmatch("\n".join(lines)) and max(map(len, fields)) <= _MAX_FIELD:
        try:
            values = np.array([float(field) if field else nan for field in fields])
            return values.reshape(len(lines), columns)
        except ValueError:
            pass  # the field at fault is looked for below
    for index, field in enumerate(fields):
        if field and not _is_number(field):
            raise RecordingError(
                path,
                f"line {first + index // columns + 1}, field {index % columns + 1}",
                expected=f"a number of at most {_MAX_FIELD} characters",
                found=quoted(field),
            )
    raise RecordingError(path, "text", expected="numbers, commas and line ends", found="other characters")


def _is_number(field: str) -> bool:
    if len(field) > _MAX_FIELD or not _FIELD.fullmatch(field):
        return False
    try:
        float(field)
    except ValueError:
        return False
    return True


def _packed(path: Path, states: NDArray[np.float64], first: int, field: int) -> NDArray[np.uint8]:
    valid = (states == 0) | (states == 1)
    if not valid.all():
        row, column = np.argwhere(~valid)[0]
        raise RecordingError(
            path,
            f"line {first + row + 1}, field {field + column}",
            expected="a status of 0 or 1",
            found=f"{states[row, column]:g}",
        )
    return np.packbits(states != 0, axis=1, bitorder="little")
