"""Reading of recordings, whatever their format."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from core.recordings.cev.reader import read_cev
from core.recordings.comtrade import read_combined_comtrade, read_comtrade
from core.recordings.comtrade.envelope import read_comtrade_envelope
from core.recordings.envelope import Envelope, IntervalsOf, envelope_of
from core.recordings.errors import RecordingError, RecordingTooLongError
from core.recordings.tables.reading import TABLE_READERS
from core.recordings.tables.recording import read_table_recording
from core.recordings.waveform import Recording
from core.table_layout import ANY_LAYOUT, TableLayout

MOST_VALUES_HELD = 4_000_000
"""Of a recording that is read for its envelope alone, longer ones are read block by block."""


EVENT_REPORT_BEGIN = 4096
"""Bytes among which an event report names its relay's firmware, FID."""
BLOCKWISE = (".cfg", ".cff")
"""Formats that are read so."""

_EVENT_REPORT_NAME = re.compile(r"C[0-9R][0-9]?_[0-9]+\.TXT", re.IGNORECASE)
"""Names of event reports that relays of the SEL-400 series give, C8_10001.TXT."""


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
"""Reader of each file name suffix of relays' records, lower case."""

SUFFIXES = (*READERS, *TABLE_READERS)
"""Suffixes of all files that are read, lower case; the first of several that one event has is preferred."""


def is_recording_name(name: str) -> bool:
    """Tell whether a file in a folder of all kinds is taken for a recording.

    Parameters
    ----------
    name : str
        Name of the file.

    Returns
    -------
    bool
        Whether its suffix is that of a recording; .txt only in a name that relays give to event reports.
    """
    suffix = Path(recording_name(name)).suffix.casefold()
    return suffix in SUFFIXES and suffix != ".txt"


def recording_name(name: str) -> str:
    """Return the name under which a relay's file is kept: an event report's ends in .CEV.

    Parameters
    ----------
    name : str
        Name of the file at the relay.

    Returns
    -------
    str
        C8_10001.CEV for C8_10001.TXT, any other as it is.
    """
    return name[: -len(".TXT")] + ".CEV" if _EVENT_REPORT_NAME.fullmatch(name) else name


def read(
    path: Path,
    *,
    lenient: bool = False,
    most_values: int | None = None,
    layout: TableLayout = ANY_LAYOUT,
    report: int | None = None,
) -> Recording:
    """Read one recording; the suffix of its file tells the format.

    .cfg is a COMTRADE configuration, with its .dat beside it; .cff a COMTRADE combined file; .cev an SEL
    Compressed ASCII event report; those of TABLE_READERS are tables of samples. A .txt that begins as an
    event report does is one, and a table otherwise.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    lenient : bool, default False
        Mend what can be mended without guessing at values, and say so in the recording's repairs.
    most_values : int or None, optional
        Refuse a longer recording before it is held in memory: values of all channels and of VALUES_BESIDE
        more, which stand for times and states. None for any length.
    layout : TableLayout, optional
        What is known of the columns of a table.
    report : int or None, optional
        Which event report of a capture with several, from 1. None for the first, with a warning if there are
        more.

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
    suffix = path.suffix.casefold()
    reader = read_cev if suffix == ".txt" and _is_event_report(path) else READERS.get(suffix)
    if reader is None and suffix in TABLE_READERS and report is None:
        return read_table_recording(path, layout, most_values)
    if reader is None and suffix not in TABLE_READERS:
        known = ", ".join(SUFFIXES)
        if suffix == ".zip":
            known += "; unpack the archive first"
        raise RecordingError(
            path,
            "file name suffix",
            expected=f"one of {known}",
            found=repr(path.suffix) if path.suffix else "none",
        )
    if reader is not None and report is None:
        return reader(path, lenient=lenient, most_values=most_values)
    if reader is not read_cev:
        raise RecordingError(
            path, "event report", expected="no number, as the file is no event report", found=str(report)
        )
    return read_cev(path, lenient=lenient, most_values=most_values, report=report)


def _is_event_report(path: Path) -> bool:
    """Tell whether a text begins as the event reports of SEL's relays do, in any of their encodings."""
    try:
        with path.open("rb") as file:
            begin = file.read(EVENT_REPORT_BEGIN)
    except OSError:
        return False  # the reader says what is wrong with the file
    return b'"FID"' in begin.replace(b"\0", b"")


def mended_by(path: Path, report: int | None = None) -> str | None:
    """Tell what the lenient reader mends in a recording that the strict one refuses.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file, as `read` takes it.
    report : int or None, optional
        Which event report, as `read` takes it.

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
        repairs = read(path, lenient=True, report=report).repairs
    except RecordingError:
        return None
    return repairs[0] if repairs else None


def read_envelope(
    path: Path, intervals_of: IntervalsOf, layout: TableLayout = ANY_LAYOUT, *, lenient: bool = False
) -> Envelope:
    """Read the envelope of a recording, in memory that does not grow with the recording.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file, as `read` takes it.
    intervals_of : callable
        Number of intervals for a number of channels and a number of samples.
    layout : TableLayout, optional
        What is known of the columns of a table.
    lenient : bool, default False
        Mend what can be mended without guessing at values.

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
        recording = read(path, lenient=lenient, most_values=MOST_VALUES_HELD, layout=layout)
        return envelope_of(recording, intervals_of)
    except RecordingTooLongError:
        if path.suffix.casefold() not in BLOCKWISE:
            raise
        return read_comtrade_envelope(path, intervals_of, lenient=lenient)
