"""The editions of the standard: which one a configuration file follows."""

import re

from core.recordings.comtrade.lines import Lines
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

FIELDS_OF_1991 = 10
NO_REVISIONS = ("", "0")
"""Written by recorders that fill the field without knowing an edition, as RTDS simulators do."""

_YEAR = re.compile(r"199[1-9]|20[0-9]{2}", re.ASCII)
_NUMBER = re.compile(r"[0-9]*", re.ASCII)
_PRIMARY_OR_SECONDARY = ("P", "S")


def read_identification(lines: Lines, repairs: Repairs) -> tuple[str, str, int | None]:
    """Return what the first line of a configuration file says.

    A year is the last field. Where there is none, the file is of 1991, unless its channels say otherwise.

    Parameters
    ----------
    lines : Lines
        The lines, none of which was read.
    repairs : Repairs
        Collects what was mended, and what departs from the standard.

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
    line = lines.next("station, device and revision")
    layout = edition_by_layout(lines.ahead(1))
    if len(line.fields) < 2:
        raise line.refuse("", "2 or 3 fields", f"{len(line.fields)}: {line.quoted()}")
    if len(line.fields) == 2 or (layout == 1991 and not _NUMBER.fullmatch(line.fields[-1])):
        station, device = line.of(2, repairs=repairs, name=0).fields
        if layout == 1991:  # which has no revision year
            return station, device, 1991
        fault = line.refuse("revision", f"one of {', '.join(REVISIONS)}", "none")
        repairs.mend(fault, "the edition is told by the layout")
        return station, device, None
    station, device, year = line.of(3, repairs=repairs, name=0).fields
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


def edition_by_layout(channel: tuple[str, ...]) -> int:
    """Return the edition by the line of an analogue channel, 1999 for 2013, too.

    Since 1999 it ends with P or S and has three fields more, however many commas the name has.

    Parameters
    ----------
    channel : tuple of str
        Fields of the line.

    Returns
    -------
    int
        The edition.
    """
    filled = [k for k, field in enumerate(channel) if field]
    last = channel[filled[-1]].strip('"').upper() if filled else ""
    since_1999 = last in _PRIMARY_OR_SECONDARY and len(channel) >= FIELDS_SINCE_1999
    return 1999 if since_1999 else 1991
