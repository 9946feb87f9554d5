"""Reading of recordings, whatever their format."""

from collections.abc import Callable, Mapping
from pathlib import Path

from core.recordings.comtrade import read_combined_comtrade, read_comtrade
from core.recordings.errors import RecordingError
from core.recordings.waveform import Recording

READERS: Mapping[str, Callable[[Path], Recording]] = {
    ".cfg": read_comtrade,
    ".cff": read_combined_comtrade,
}
"""Reader of each file name suffix, lower case."""


def read(path: Path) -> Recording:
    """Read one recording; the suffix of its file tells the format.

    .cfg: COMTRADE configuration, with its .dat beside it; .cff: COMTRADE combined file.

    Raises RecordingError if the file is missing, of another kind, or contradicts itself.
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
    return reader(path)
