"""COMTRADE records: configuration with data beside it, or combined files; the peer is PyPI's comtrade."""

from importlib.metadata import version
from pathlib import Path

from benchmarks.corpus.comtrade_peer import compared
from benchmarks.corpus.outcomes import Comparison, Kind, Outcome, Reading
from core.recordings import Recording, RecordingError, read

MOST_VALUES = 40_000_000
"""Longer records are refused: 320 MB of values."""


def reading(path: Path) -> tuple[Outcome, Recording | None]:
    """Read a record as the service does and, where that is refused, leniently."""
    try:
        recording = read(path, most_values=MOST_VALUES)
    except RecordingError as refusal:
        try:
            mended = read(path, lenient=True, most_values=MOST_VALUES)
        except RecordingError as final:
            return Outcome(Reading.REFUSED, (str(final),)), None
        return Outcome(Reading.LENIENT, mended.repairs or (str(refusal),)), mended
    except OSError as error:
        return Outcome(Reading.REFUSED, (str(error),)), None
    return Outcome(Reading.WARNED if recording.warnings else Reading.READ, recording.warnings), recording


def read_record(path: Path) -> Outcome:
    """How a record is read."""
    return reading(path)[0]


def compare_record(path: Path) -> Comparison:
    """Compare samples, states and times with those of the peer."""
    ours = reading(path)[1]
    if ours is None:
        raise ValueError(f"{path} was not read")
    return compared(ours, path)


COMTRADE = Kind(
    name="COMTRADE",
    suffixes=(".cfg", ".cff"),
    read=read_record,
    compare=compare_record,
    peer=f"comtrade {version('comtrade')}",
    parts=(".dat", ".hdr", ".inf"),
)
