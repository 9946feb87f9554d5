"""The COMTRADE data file (.DAT): numbers, time stamps and values of the samples, in any of the four formats.

Clauses are those of C37.111-1999, chapter 6; the 32-bit formats came with 2013 (chapter 8).
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from core.recordings.comtrade.configuration import Configuration, Layout
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs

NO_TIME_STAMP = 0xFFFFFFFF

_PADDING = b"\x1a"
_LINE_ENDS = b"\x1a\r\n"
"""What transfers and editors leave behind the last sample."""
_BLOCK_BYTES = 1 << 18
"""Read and converted at a time: enough to be fast, little enough to stay in the processor's cache."""


class SampleSink(Protocol):
    """What takes the samples of a record, block by block in their order."""

    def put(
        self,
        first: int,
        counts: NDArray[np.float64],
        stamps: NDArray[np.float64],
        status: NDArray[np.uint8],
    ) -> None:
        """Take a block.

        Parameters
        ----------
        first : int
            Number of samples before it.
        counts : ndarray, shape (samples, channels)
            Analogue values as written, NaN where missing.
        stamps : ndarray, shape (samples,)
            Time stamps in the file's unit, NaN where missing.
        status : ndarray of uint8, shape (samples, ceil(states / 8))
            States, the first in the lowest bit.
        """
        ...


Sink = TypeVar("Sink", bound=SampleSink)
SinkOf = Callable[[Configuration, int], Sink]
"""Makes the sink for a configuration and a number of samples."""


@dataclass(frozen=True, slots=True)
class SampleTable:
    """The samples of one record as written, NaN where missing.

    Parameters
    ----------
    counts : ndarray, shape (channels, samples)
        Analogue values before scaling.
    status : ndarray of uint8, shape (samples, ceil(states / 8))
        States, the first in the lowest bit.
    stamps : ndarray, shape (samples,)
        Time stamps in the file's unit.
    """

    counts: NDArray[np.float64]
    status: NDArray[np.uint8]
    stamps: NDArray[np.float64]

    @classmethod
    def empty(cls, configuration: Configuration, samples: int) -> "SampleTable":
        """Return a table that waits to be filled.

        Parameters
        ----------
        configuration : Configuration
            The checked configuration file.
        samples : int
            Number of samples.

        Returns
        -------
        SampleTable
            The table.
        """
        states = -(-len(configuration.status_names) // 8)
        return cls(
            counts=np.empty((len(configuration.analog), samples)),
            status=np.empty((samples, states), dtype=np.uint8),
            stamps=np.empty(samples),
        )

    def put(
        self,
        first: int,
        counts: NDArray[np.float64],
        stamps: NDArray[np.float64],
        status: NDArray[np.uint8],
    ) -> None:
        """Take a block of samples.

        Parameters
        ----------
        first : int
            Number of samples before it.
        counts : ndarray, shape (samples, channels)
            Analogue values as written, NaN where missing.
        stamps : ndarray, shape (samples,)
            Time stamps in the file's unit, NaN where missing.
        status : ndarray of uint8, shape (samples, ceil(states / 8))
            States, the first in the lowest bit.
        """
        last = first + stamps.size
        self.counts[:, first:last] = counts.T
        self.stamps[first:last] = stamps
        self.status[first:last] = status


class SampleNumbers:
    """A check of sample numbers, which count from 1 without a gap (6.4).

    Recorders that count from 0 lose nothing.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.
    """

    def __init__(self, path: Path, repairs: Repairs) -> None:
        self._path = path
        self._repairs = repairs
        self._checked = 0
        self._next = 0.0

    def check(self, numbers: NDArray[np.float64] | NDArray[np.uint32]) -> None:
        """Check the numbers that follow those checked so far.

        A lenient reader takes the samples in the order of the file.

        Parameters
        ----------
        numbers : ndarray or ndarray of uint32, shape (samples,)
            Sample numbers.

        Raises
        ------
        RecordingError
            If they have a gap or do not ascend.
        """
        first = float(numbers[0])
        fault = None
        if self._checked == 0:
            self._next = first
            if first not in (0.0, 1.0):
                fault = RecordingError(self._path, "sample 1, number", expected="1", found=f"{first:.10g}")
        wrong = np.flatnonzero(numbers != self._next + np.arange(numbers.size))
        if fault is None and wrong.size:
            k = int(wrong[0])
            fault = RecordingError(
                self._path,
                f"sample {self._checked + k + 1}, number",
                expected=f"{self._next + k:.0f}, consecutive numbers",
                found=f"{numbers[k]:.10g}",
            )
        if fault is not None:
            self._repairs.mend(fault, "samples are taken in the order of the file")
        self._checked += numbers.size
        self._next += numbers.size


def decode_binary(
    section: DataSection, configuration: Configuration, repairs: Repairs, sink_of: SinkOf[Sink]
) -> Sink:
    """Read the samples of a BINARY, BINARY32 or FLOAT32 file.

    A lenient reader takes the whole samples that a file of another size has, up to the number announced.

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
        If size or sample numbers do not fit the configuration.
    OSError
        If the file cannot be read.
    """
    row = _row(configuration.layout)
    unmarked = _channels_without_mark(configuration)
    samples = _sample_count(section, configuration, row, repairs)
    states = -(-len(configuration.status_names) // 8)
    sink = sink_of(configuration, samples)
    numbers = SampleNumbers(section.path, repairs)
    with section.opened() as file:
        block_samples = max(1, _BLOCK_BYTES // row.itemsize)
        for first in range(0, samples, block_samples):
            last = min(first + block_samples, samples)
            block = np.fromfile(file, dtype=row, count=last - first)
            if block.size != last - first:
                raise RecordingError(
                    section.path,
                    "size",
                    expected=f"{section.size} bytes as before",
                    found="fewer: it was cut",
                )
            numbers.check(block["number"])
            with np.errstate(invalid="ignore"):  # of a signalling NaN
                counts = block["analog"].astype(np.float64)
            missing = block["analog"] == _missing(configuration)
            if unmarked:
                missing[:, unmarked] = False
            counts[missing] = np.nan
            stamps = block["stamp"].astype(np.float64)
            stamps[block["stamp"] == NO_TIME_STAMP] = np.nan
            sink.put(first, counts, stamps, block["status"][:, :states])
    return sink


def _row(layout: Layout) -> np.dtype[np.void]:
    analog_type = {"BINARY": "<i2", "BINARY32": "<i4", "FLOAT32": "<f4"}[layout.data_format]
    status_bytes = 2 * -(-layout.status // 16)
    return np.dtype(
        [
            ("number", "<u4"),
            ("stamp", "<u4"),
            ("analog", analog_type, (layout.analog,)),
            ("status", "u1", (status_bytes,)),
        ]
    )


def _missing(configuration: Configuration) -> float:
    """Return the value that stands for a missing one."""
    if configuration.data_format == "BINARY":
        return -1 if configuration.revision == 1991 else -0x8000
    return -0x80000000 if configuration.data_format == "BINARY32" else float(np.finfo(np.float32).min)


def _channels_without_mark(configuration: Configuration) -> list[int]:
    """Channels of 1991 whose limits have a sign: 0xFFFF is the count -1 there, and nothing marks a gap."""
    if configuration.revision != 1991 or configuration.data_format != "BINARY":
        return []
    return [k for k, channel in enumerate(configuration.analog) if channel.minimum < 0]


def binary_samples_held(section: DataSection, layout: Layout) -> int:
    """Return the whole samples that a binary data file has room for.

    Parameters
    ----------
    section : DataSection
        Place of the data.
    layout : Layout
        What a sample looks like.

    Returns
    -------
    int
        The number.
    """
    return section.size // _row(layout).itemsize


def _sample_count(
    section: DataSection, configuration: Configuration, row: np.dtype[np.void], repairs: Repairs
) -> int:
    announced = configuration.sample_count
    expected = announced * row.itemsize
    if section.size >= expected and section.is_padding_after(expected, _PADDING):
        return announced
    surplus = section.size - expected
    fault = RecordingError(
        section.path,
        "size",
        expected=f"{expected} bytes: {announced} samples of {row.itemsize} bytes, "
        f"{len(configuration.analog)} analogue and {len(configuration.status_names)} status channels",
        found=f"{section.size} bytes",
    )
    if surplus > 0 and section.is_padding_after(expected, _LINE_ENDS):
        repairs.warn(f"{fault}: the {surplus} bytes of line ends behind the last sample are passed over")
        return announced
    whole = min(announced, section.size // row.itemsize)
    if whole == 0:
        raise fault
    repairs.mend(fault, f"{whole} samples are read")
    return whole
