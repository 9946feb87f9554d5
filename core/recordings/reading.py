"""Reading of recordings, whatever their format."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from core.recordings.cev import read_cev
from core.recordings.comtrade import read_combined_comtrade, read_comtrade
from core.recordings.errors import RecordingError
from core.recordings.waveform import Recording


class Reader(Protocol):
    """A function that reads the file at a path, strictly or leniently."""

    def __call__(self, path: Path, *, lenient: bool = False) -> Recording:
        """Read one recording."""
        ...


READERS: Mapping[str, Reader] = {
    ".cfg": read_comtrade,
    ".cff": read_combined_comtrade,
    ".cev": read_cev,
}
"""Reader of each file name suffix, lower case."""


def read(path: Path, *, lenient: bool = False) -> Recording:
    """Read one recording; the suffix of its file tells the format.

    .cfg is a COMTRADE configuration, with its .dat beside it; .cff a COMTRADE combined file; .cev an SEL
    Compressed ASCII event report.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.

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
        raise RecordingError(
            path,
            "file name suffix",
            expected=f"one of {known}",
            found=repr(path.suffix) if path.suffix else "none",
        )
    return reader(path, lenient=lenient)
