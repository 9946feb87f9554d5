"""Reading of recordings, whatever their format."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from core.recordings.cev.reader import read_cev
from core.recordings.comtrade import read_combined_comtrade, read_comtrade
from core.recordings.comtrade.envelope import read_comtrade_envelope
from core.recordings.envelope import Envelope, IntervalsOf, envelope_of
from core.recordings.errors import RecordingError, RecordingTooLongError
from core.recordings.waveform import Recording

MOST_VALUES_HELD = 4_000_000
"""Of a recording that is read for its envelope alone, longer ones are read block by block."""


class Reader(Protocol):
    """A function that reads the file at a path, strictly or leniently."""

    def __call__(self, path: Path, *, lenient: bool = False, most_values: int | None = None) -> Recording:
        """Read one recording."""
        ...


READERS: Mapping[str, Reader] = {
    ".cfg": read_comtrade,
    ".cff": read_combined_comtrade,
    ".cev": read_cev,
}
"""Reader of each file name suffix, lower case."""


def read(path: Path, *, lenient: bool = False, most_values: int | None = None) -> Recording:
    """Read one recording; the suffix of its file tells the format.

    .cfg is a COMTRADE configuration, with its .dat beside it; .cff a COMTRADE combined file; .cev an SEL
    Compressed ASCII event report.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.

    Returns
    -------
    Recording
        The recording.

    Raises
    ------
    RecordingError
        If the file is missing, of another kind, or contradicts itself.
    OSError
        If a file that exists cannot be read.
    """
    reader = READERS.get(path.suffix.casefold())
    if reader is None:
        known = ", ".join(READERS)
        if path.suffix.casefold() == ".zip":
            known += "; unpack the archive first"
        raise RecordingError(
            path,
            "file name suffix",
            expected=f"one of {known}",
            found=repr(path.suffix) if path.suffix else "none",
        )
    return reader(path, lenient=lenient, most_values=most_values)


def mended_by(path: Path) -> str | None:
    """Tell what the lenient reader mends in a recording that the strict one refuses.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file, as `read` takes it.

    Returns
    -------
    str or None
        The first of the repairs; None where the lenient reader refuses the file, too.

    Raises
    ------
    OSError
        If a file that exists cannot be read.
    """
    try:
        repairs = read(path, lenient=True).repairs
    except RecordingError:
        return None
    return repairs[0] if repairs else None


def read_envelope(path: Path, intervals_of: IntervalsOf) -> Envelope:
    """Read the envelope of a recording, in memory that does not grow with the recording.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file, as `read` takes it.
    intervals_of : callable
        Number of intervals for a number of channels and a number of samples.

    Returns
    -------
    Envelope
        The envelope.

    Raises
    ------
    RecordingError
        If the file cannot be read, or is too long even so: a report of several minutes, a COMTRADE record of
        more than two million samples.
    OSError
        If a file that exists cannot be read.
    """
    try:
        return envelope_of(read(path, most_values=MOST_VALUES_HELD), intervals_of)
    except RecordingTooLongError:
        if path.suffix.casefold() == ".cev":
            raise
        return read_comtrade_envelope(path, intervals_of)
