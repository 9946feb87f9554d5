"""Reading of recordings, whatever their format."""

from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from core.recordings.cev import read_cev
from core.recordings.comtrade import read_combined_comtrade, read_comtrade
from core.recordings.errors import RecordingError
from core.recordings.waveform import Recording


class Reader(Protocol):
    """Reads the file at a path, strictly or leniently."""

    def __call__(self, path: Path, *, lenient: bool = False) -> Recording: ...


READERS: Mapping[str, Reader] = {
    ".cfg": read_comtrade,
    ".cff": read_combined_comtrade,
    ".cev": read_cev,
}
"""Reader of each file name suffix, lower case."""


def read(path: Path, *, lenient: bool = False) -> Recording:
    """Read one recording; the suffix of its file tells the format.

    .cfg: COMTRADE configuration, with its .dat beside it; .cff: COMTRADE combined file; .cev: SEL Compressed
    ASCII event report.
    lenient: mend what can be mended without guessing at values; the recording's repairs say what was.

    Raises RecordingError if the file is missing, of another kind, or contradicts itself; OSError if it cannot
    be read.
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
