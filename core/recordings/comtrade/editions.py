"""The editions of the standard: which one a configuration file follows."""

import re

from core.recordings.comtrade.lines import Line
from core.recordings.errors import quoted
from core.recordings.repairs import Repairs

REVISIONS = {"1991": 1991, "1997": 1999, "1999": 1999, "2001": 1999, "2013": 2013}
"""Revision year in the file -> edition whose layout holds. IEC 60255-24:2001 is the 1999 edition;
Schneider's Sepam relays write 1997, the draft of it."""
BETWEEN_EDITIONS = range(1997, 2013)
"""In these years there was no layout but that of 1999, so that any other of them is read as 1999 (with a
warning)."""
FIELDS_SINCE_1999 = 13
"""Of the line of an analogue channel; those of 1991 have ten."""

NO_REVISIONS = ("", "0")
"""Written by recorders that fill the field without knowing an edition, as RTDS simulators do."""

_YEAR = re.compile(r"199[1-9]|20[0-9]{2}", re.ASCII)


def read_identification(line: Line, repairs: Repairs) -> tuple[str, str, int | None]:
    """Return what the first line of a configuration file says.

    Parameters
    ----------
    line : Line
        The first line.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    station, device : str
        Names of the station and of the recorder.
    edition : int or None
        Year of the edition; None for one that only the layout tells.

    Raises
    ------
    RecordingError
        If the year is none of an edition, and the reader is strict.
    """
    line.has_fields(2, 3)
    station, device = line.fields[:2]
    if len(line.fields) == 2:  # 1991 has no revision year
        return station, device, 1991
    year = line.fields[2]
    if year in REVISIONS:
        return station, device, REVISIONS[year]
    fault = line.refuse("revision", f"one of {', '.join(REVISIONS)}", quoted(year))
    if year in NO_REVISIONS:
        repairs.mend(fault, "the edition is told by the layout")
        return station, device, None
    if not _YEAR.fullmatch(year):
        raise fault
    if int(year) in BETWEEN_EDITIONS:
        repairs.warn(f"{fault}: read as the edition of 1999")
        return station, device, 1999
    edition = max(edition for edition in REVISIONS.values() if edition <= int(year))
    repairs.mend(fault, f"read as the edition of {edition}")
    return station, device, edition
