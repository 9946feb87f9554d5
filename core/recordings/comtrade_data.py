"""The COMTRADE data file (.DAT): ASCII, BINARY, BINARY32 and FLOAT32.

Clauses are those of C37.111-1999, chapter 6; the 32-bit formats came with 2013 (chapter 8).
Sample numbers, sizes and time stamps must agree with the configuration; nothing is filled in.
"""

import re
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.comtrade_configuration import Configuration, quoted
from core.recordings.errors import RecordingError

RATE_TOLERANCE = 1e-3
"""Largest difference between the rate in the configuration and the one the time stamps show, fraction."""

NO_TIME_STAMP = 0xFFFFFFFF

SHORT_COUNTER = 1 << 16
"""Some recorders keep their time stamps in 16 bits; these then start again from 0 and are compared so."""

_PADDING = b"\x1a"
_ASCII_LINE_END = re.compile(r"\r\n|\n|\r")
_ASCII_TABLE = re.compile(r"[0-9+\-.eE, \t\r\n]*", re.ASCII)
_MAX_FIELD = 32


def decode_data(path: Path, data: bytes, configuration: Configuration) -> tuple[NDArray[np.float64], float]:
    """Counts of the analogue channels, shape (channels, samples), NaN where missing; and the rate [Hz].

    The rate is the configuration's, or where that names none the one of the (evenly spaced) time stamps.
    Raises RecordingError if size, sample numbers, values or time stamps do not fit the configuration.
    """
    if configuration.data_format == "ASCII":
        numbers, stamps, counts = _decode_ascii(path, data, configuration)
    else:
        numbers, stamps, counts = _decode_binary(path, data, configuration)
    _check_numbers(path, numbers)
    if np.isinf(counts).any():
        channel, sample = np.argwhere(np.isinf(counts))[0]
        raise RecordingError(
            path,
            f"sample {sample + 1}, analogue channel {channel + 1}",
            expected="a finite value",
            found=str(counts[channel, sample]),
        )
    return counts, _checked_rate(path, stamps, configuration)


def _decode_binary(
    path: Path, data: bytes, configuration: Configuration
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    channels = len(configuration.analog)
    analog_type = {"BINARY": "<i2", "BINARY32": "<i4", "FLOAT32": "<f4"}[configuration.data_format]
    status_words = -(-configuration.status_count // 16)
    row = np.dtype(
        [
            ("number", "<u4"),
            ("stamp", "<u4"),
            ("analog", analog_type, (channels,)),
            ("status", "<u2", (status_words,)),
        ]
    )
    expected = configuration.sample_count * row.itemsize
    if len(data) < expected or data[expected:].strip(_PADDING):
        raise RecordingError(
            path,
            "size",
            expected=f"{expected} bytes: {configuration.sample_count} samples of {row.itemsize} bytes, "
            f"{channels} analogue and {configuration.status_count} status channels",
            found=f"{len(data)} bytes",
        )
    table = np.frombuffer(data, dtype=row, count=configuration.sample_count)
    analog = table["analog"].T
    counts = np.array(analog, dtype=np.float64, order="C")
    if configuration.data_format == "BINARY":
        missing = -1 if configuration.revision == 1991 else -0x8000
        counts[analog == missing] = np.nan
    elif configuration.data_format == "BINARY32":
        counts[analog == -0x80000000] = np.nan
    else:
        counts[analog == np.finfo(np.float32).min] = np.nan
    stamps = table["stamp"].astype(np.float64)
    stamps[table["stamp"] == NO_TIME_STAMP] = np.nan
    return table["number"].astype(np.float64), stamps, counts


def _decode_ascii(
    path: Path, data: bytes, configuration: Configuration
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    text = data.decode("latin-1").rstrip("\x1a\r\n\t ")
    lines = _ASCII_LINE_END.split(text) if text else []
    if len(lines) != configuration.sample_count:
        raise RecordingError(
            path,
            "size",
            expected=f"{configuration.sample_count} lines, one a sample",
            found=f"{len(lines)} lines",
        )
    channels = len(configuration.analog)
    columns = 2 + channels + configuration.status_count
    for number, line in enumerate(lines, 1):
        if line.count(",") != columns - 1:
            raise RecordingError(
                path,
                f"line {number}",
                expected=f"{columns} fields: number, time stamp, {channels} analogue and "
                f"{configuration.status_count} status values",
                found=f"{line.count(',') + 1}: {quoted(line)}",
            )
    fields = [field.strip() for field in chain.from_iterable(line.split(",") for line in lines)]
    table = _numbers(path, fields, text, columns).reshape(len(lines), columns)
    status = table[:, 2 + channels :]
    _check_cells(path, status, (status == 0) | (status == 1), 2 + channels, "a status of 0 or 1")
    counts = np.array(table[:, 2 : 2 + channels].T, order="C")
    if configuration.revision >= 1999:
        counts[counts == 99_999] = np.nan
    return table[:, 0], table[:, 1], counts


def _numbers(path: Path, fields: list[str], text: str, columns: int) -> NDArray[np.float64]:
    """Fields as numbers; an empty one is NaN, a value not recorded."""
    well_formed = _ASCII_TABLE.fullmatch(text) is not None and max(map(len, fields)) <= _MAX_FIELD
    if well_formed:
        try:
            return np.array([field or "nan" for field in fields], dtype=np.float64)
        except ValueError:
            pass  # the field at fault is looked for below
    for index, field in enumerate(fields):
        if field and (
            len(field) > _MAX_FIELD or not re.fullmatch(r"[0-9+\-.eE]+", field) or not _is_number(field)
        ):
            raise RecordingError(
                path,
                f"line {index // columns + 1}, field {index % columns + 1}",
                expected=f"a number of at most {_MAX_FIELD} characters",
                found=quoted(field),
            )
    raise RecordingError(path, "text", expected="numbers, commas and line ends", found="other characters")


def _is_number(field: str) -> bool:
    try:
        float(field)
    except ValueError:
        return False
    return True


def _check_cells(
    path: Path, cells: NDArray[np.float64], valid: NDArray[np.bool_], first_column: int, expected: str
) -> None:
    if not valid.all():
        row, column = np.argwhere(~valid)[0]
        raise RecordingError(
            path,
            f"line {row + 1}, field {first_column + column + 1}",
            expected=expected,
            found=f"{cells[row, column]:g}",
        )


def _check_numbers(path: Path, numbers: NDArray[np.float64]) -> None:
    """Samples are numbered from 1 without a gap (6.4); recorders that count from 0 lose nothing."""
    first = numbers[0]
    if first not in (0.0, 1.0):
        raise RecordingError(path, "sample 1, number", expected="1", found=f"{first:.10g}")
    wrong = np.flatnonzero(numbers != first + np.arange(numbers.size))
    if wrong.size:
        k = int(wrong[0])
        raise RecordingError(
            path,
            f"sample {k + 1}, number",
            expected=f"{first + k:.0f}, consecutive numbers",
            found=f"{numbers[k]:.10g}",
        )


def _checked_rate(path: Path, stamps: NDArray[np.float64], configuration: Configuration) -> float:
    """The sampling rate [Hz] after the time stamps have been compared with it.

    Only differences of time stamps count: recorders start them anywhere. A gap of one sample, or a rate
    wrong by more than RATE_TOLERANCE, is an error. Where the rate is known, stamps are not critical (6.4):
    some or all may be missing, and a recorder that leaves them all 0 has none.
    """
    rate_hz = configuration.sample_rate_hz
    if rate_hz is None:
        rate_hz = _rate_of_stamps(path, stamps * configuration.time_stamp_unit_s)
    present = np.flatnonzero(~np.isnan(stamps))
    if present.size < 2 or not stamps[present].any():
        return rate_hz
    unit_s = configuration.time_stamp_unit_s
    elapsed = (stamps[present] - stamps[present[0]]) * unit_s
    nominal = (present - present[0]) / rate_hz
    deviation = elapsed - nominal
    span = SHORT_COUNTER * unit_s
    if stamps[present].max() < SHORT_COUNTER and (np.diff(elapsed) < 0).any() and span * rate_hz > 2:
        deviation = (deviation + span / 2) % span - span / 2
    half_a_sample = 0.5 / rate_hz + unit_s
    jumps = np.abs(np.diff(deviation)) > half_a_sample
    drifts = np.abs(deviation[1:]) > half_a_sample + RATE_TOLERANCE * nominal[1:]
    wrong = np.flatnonzero(jumps | drifts)
    if wrong.size:
        k = int(wrong[0]) + 1
        raise RecordingError(
            path,
            f"sample {present[k] + 1}, time stamp",
            expected=f"{nominal[k] * 1e3:.6g} ms after the first, as {rate_hz:.10g} Hz without a gap gives",
            found=f"{elapsed[k] * 1e3:.6g} ms",
        )
    return rate_hz


def _rate_of_stamps(path: Path, stamps_s: NDArray[np.float64]) -> float:
    missing = int(np.isnan(stamps_s).sum())
    if missing or stamps_s.size < 2 or stamps_s[-1] <= stamps_s[0]:
        raise RecordingError(
            path,
            "time stamps",
            expected="increasing ones on every sample, as the configuration names no sampling rate",
            found=f"{missing} missing on {stamps_s.size} samples" if missing else "none that increase",
        )
    return float((stamps_s.size - 1) / (stamps_s[-1] - stamps_s[0]))
