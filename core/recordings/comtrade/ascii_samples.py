"""The ASCII form of the COMTRADE data file: one line a sample (C37.111-1999, 6.4)."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.comtrade.configuration import Configuration
from core.recordings.comtrade.data import SampleNumbers, Sink, SinkOf
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

MISSING = 99_999
"""The mark of a missing value since 1999; 1991 leaves the field blank, which all editions understand."""

_TABLE = re.compile(r"[0-9+\-.eE, \t\n]*", re.ASCII)
_FIELD = re.compile(r"[0-9+\-.eE]+", re.ASCII)
_END = b"\x1a\r\n\t "
"""What may follow the last sample."""

_MAX_FIELD = 32
_BLOCK_BYTES = 1 << 16
_MAX_LINE = 1 << 20
"""As long is a line of 20,000 channels with the longest numbers."""


def decode_ascii(
    section: DataSection, configuration: Configuration, repairs: Repairs, sink_of: SinkOf[Sink]
) -> Sink:
    """Read the samples of an ASCII file.

    Blank lines are passed over where the others are as many as announced. A lenient reader takes the lines
    there are, up to the number announced.

    Parameters
    ----------
    section : DataSection
        Place of the data in the file.
    configuration : Configuration
        The checked configuration file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.
    sink_of : callable
        Makes what takes the samples.

    Returns
    -------
    SampleSink
        What took the samples.

    Raises
    ------
    RecordingError
        If lines, fields or sample numbers do not fit the configuration.
    OSError
        If the file cannot be read.
    """
    text = _Text.of(section)
    announced, lines = configuration.sample_count, text.lines
    without_blanks = lines != announced and text.blank_lines > 0
    if without_blanks:
        fault = _fault(section.path, lines, announced)
        lines -= text.blank_lines
        if lines == announced:
            repairs.warn(f"{fault}: the {text.blank_lines} blank lines are passed over")
        else:
            repairs.mend(fault, "blank lines are passed over")
    analog, states = len(configuration.analog), len(configuration.status_names)
    samples = _whole_lines(section.path, text, lines, configuration, repairs)
    if samples * (1 + analog + states) > text.characters:  # a line is no shorter than its commas
        raise RecordingError(
            section.path,
            "size",
            expected=f"{2 + analog + states} fields a line",
            found=f"{text.characters} characters on {lines} lines",
        )
    sink = sink_of(configuration, samples)
    numbers = SampleNumbers(section.path, repairs)
    first = 0
    for found in _blocks(section):
        wanted = [line for line in found if line.strip()] if without_blanks else found
        block_lines = [line.rstrip(_END).decode("latin-1") for line in wanted[: samples - first]]
        if not block_lines:
            continue
        block = _numbers(section.path, block_lines, first, analog, states, repairs)
        numbers.check(block[:, 0])
        counts = block[:, 2 : 2 + analog]
        if configuration.revision >= 1999:
            counts[counts == MISSING] = np.nan
        status = _packed(section.path, block[:, 2 + analog :], first, 3 + analog)
        sink.put(first, counts, block[:, 1], status)
        first += block.shape[0]
        if first == samples:
            break
    return sink


def ascii_samples_held(section: DataSection) -> int:
    """Return the lines of an ASCII data file that are not blank.

    Parameters
    ----------
    section : DataSection
        Place of the data.

    Returns
    -------
    int
        The number.
    """
    text = _Text.of(section)
    return text.lines - text.blank_lines


@dataclass(frozen=True, slots=True)
class _Text:
    """What an ASCII file holds before its padding; `blank_lines` are among the `lines`.

    unfinished: filled fields of a last line that has no line end, None where the last line has one.
    """

    lines: int
    blank_lines: int
    characters: int
    unfinished: int | None

    @classmethod
    def of(cls, section: DataSection) -> "_Text":
        """Count, without keeping any of it."""
        lines = blank = characters = read = read_blank = read_characters = 0
        last = b""
        for block in _blocks(section):
            stripped = list(map(bytes.strip, block))
            blank_here = stripped.count(b"")
            end = len(block) if blank_here < len(block) else 0
            while end and not stripped[end - 1].rstrip(_END):
                end -= 1
            if end:
                lines = read + end
                blank = read_blank + stripped[:end].count(b"")
                characters = read_characters + sum(map(len, block[:end])) + end
            last = block[-1]
            read += len(block)
            read_blank += blank_here
            read_characters += sum(map(len, block)) + len(block)
        filled = last.count(b",") + bool(last.rpartition(b",")[2].strip(_END))
        unfinished = filled if last.strip(_END) else None
        return cls(lines, blank, characters, unfinished)


def _blocks(section: DataSection) -> Iterator[list[bytes]]:
    """Lines of the file, some at a time; their ends are those of Windows, Unix or old Macintoshes."""
    begun: list[bytes] = []
    begun_bytes = 0
    held = b""
    with section.opened() as file:
        left = section.size
        while left > 0 and (piece := file.read(min(left, _BLOCK_BYTES))):
            left -= len(piece)
            piece, held = held + piece, b""
            if piece.endswith(b"\r") and left > 0:  # perhaps half of an end
                piece, held = piece[:-1], b"\r"
            first, *rest = piece.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n")
            begun.append(first)
            begun_bytes += len(first)
            if begun_bytes > _MAX_LINE:
                raise RecordingError(
                    section.path,
                    "text",
                    expected=f"lines of at most {_MAX_LINE} characters",
                    found="a longer one",
                )
            if rest:
                yield [b"".join(begun), *rest[:-1]]
                begun, begun_bytes = [rest[-1]], len(rest[-1])
    yield [b"".join(begun)]


def _whole_lines(path: Path, text: _Text, lines: int, configuration: Configuration, repairs: Repairs) -> int:
    """Return the number of lines to read: all, or those there are without a last one that was cut.

    A state has one digit, so that a last line that ends with one is whole; a value may have lost some.
    """
    announced, states = configuration.sample_count, len(configuration.status_names)
    columns = 2 + len(configuration.analog) + states
    short = lines < announced and states == 0
    cut = text.unfinished is not None and (short or text.unfinished < columns)
    if not cut or not 1 < lines <= announced:
        return _sample_count(path, lines, announced, repairs)
    fault = RecordingError(
        path,
        f"line {lines}",
        expected=f"{columns} fields and a line end, on {announced} lines",
        found=f"the end of the file behind field {text.unfinished}",
    )
    repairs.mend(fault, f"{lines - 1} samples are read")
    return lines - 1


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


def _numbers(
    path: Path, lines: list[str], first: int, analog: int, states: int, repairs: Repairs
) -> NDArray[np.float64]:
    """Fields of some lines as numbers, shape (lines, fields); an empty one is NaN, a value not recorded."""
    columns = 2 + analog + states
    for k, line in enumerate(lines):
        surplus = line.count(",") + 1 - columns
        if surplus > 0 and not line.split(",", columns)[-1].strip(", \t"):
            lines[k] = ",".join(line.split(",")[:columns])
            repairs.warn(f"{path.name}: lines end in a comma: no field is behind it")
        elif surplus != 0:
            raise RecordingError(
                path,
                f"line {first + k + 1}",
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
