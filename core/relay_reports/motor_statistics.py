"""The motor operating statistics (MOT): hours, starts, currents and trips since they were last reset."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from core.relay_reports.clock_times import DateOrder, clock_in, time_of
from core.relay_reports.error import ReportError
from core.relay_reports.report_text import Line, report_text

_ENTRY = re.compile(r"(\S.*?)(?:\s{2,}|\s*:\s+)(\S.*)")
_HOURS = re.compile(r"(\d{1,7}):([0-5]\d):([0-5]\d)(?:\s*\(h:mm:ss\))?", re.ASCII)
_TRIPS = "trips, "


@dataclass(frozen=True, slots=True)
class MotorStatistics:
    """Statistics of a motor; what a relay does not tell is None.

    Parameters
    ----------
    time_ns : int
        Time of the report, by the relay's clock, as if this were in UTC.
    since_ns : int or None
        Since when, by the relay's clock, as if this were in UTC.
    running_s, stopped_s : float or None
        Time running and at rest.
    starts : int or None
        Number of starts.
    mean_current_A, peak_current_A, peak_start_current_A : float or None
        Mean and largest current while it ran, and largest during a start.
    longest_start_s : float or None
        Longest start.
    trips : mapping of str to int
        Number of trips by what the relay calls their cause.
    """

    time_ns: int
    since_ns: int | None
    running_s: float | None
    stopped_s: float | None
    starts: int | None
    mean_current_A: float | None
    peak_current_A: float | None
    peak_start_current_A: float | None
    longest_start_s: float | None
    trips: Mapping[str, int]


def read_motor_statistics(
    report: bytes | str | Path, *, name: str = "MOT", date_order: DateOrder = DateOrder.MDY
) -> MotorStatistics:
    """Read motor operating statistics.

    Parameters
    ----------
    report : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.
    date_order : DateOrder
        Order of dates.

    Returns
    -------
    MotorStatistics
        The statistics.

    Raises
    ------
    ReportError
        If nothing of them is there, something is twice, a figure is none, or the report has no date.
    OSError
        If the file cannot be read.
    """
    entries: dict[str, tuple[Line, str]] = {}
    time_ns = None
    for line in report_text(report, name).lines():
        clock_ns = clock_in(line, date_order) if time_ns is None else None
        if clock_ns is not None:
            time_ns = clock_ns
            continue
        entry = _ENTRY.fullmatch(line.text)
        if entry is None:
            continue
        label = entry[1].lower()
        if label in entries:
            raise line.error(entry[1], expected="each entry once", found="a second one")
        entries[label] = (line, entry[2])
    if "running time" not in entries and "number of starts" not in entries:
        raise ReportError(name, "end", expected='"Running time" or "Number of starts"', found="neither")
    if time_ns is None:
        raise ReportError(name, "heading", expected="the relay's clock, as Date: and Time:", found="none")

    def figure(label: str) -> float | None:
        if label not in entries:
            return None
        line, text = entries[label]
        return line.quantity(label, text)

    def count(label: str) -> int | None:
        number = figure(label)
        if number is not None and not number.is_integer():
            raise entries[label][0].error(label, expected="a whole number", found=entries[label][1])
        return None if number is None else int(number)

    trips = [label for label in entries if label.startswith(_TRIPS)]
    return MotorStatistics(
        time_ns=time_ns,
        since_ns=_since(entries, date_order),
        running_s=_duration(entries, "running time"),
        stopped_s=_duration(entries, "stopped time"),
        starts=count("number of starts"),
        mean_current_A=figure("average running current"),
        peak_current_A=figure("peak running current"),
        peak_start_current_A=figure("peak start current"),
        longest_start_s=figure("longest start"),
        trips={label.removeprefix(_TRIPS): count(label) or 0 for label in trips},
    )


def _since(entries: Mapping[str, tuple[Line, str]], order: DateOrder) -> int | None:
    if "since" not in entries:
        return None
    line, text = entries["since"]
    date, _, clock = text.partition(" ")
    return time_of(line, date, clock.strip(), order)


def _duration(entries: Mapping[str, tuple[Line, str]], label: str) -> float | None:
    if label not in entries:
        return None
    line, text = entries[label]
    found = _HOURS.fullmatch(text)
    if found is None:
        raise line.error(label, expected="hours such as 120:05:00", found=text)
    return 3600.0 * int(found[1]) + 60.0 * int(found[2]) + int(found[3])
