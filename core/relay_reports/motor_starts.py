"""The motor start report (MSR): a summary of each start, and its currents and voltages at intervals."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.relay_reports.clock_times import DateOrder, time_of
from core.relay_reports.error import ReportError
from core.relay_reports.report_text import Line, report_text
from core.relay_reports.tables import fields_of, is_empty, label_of

Array = NDArray[np.float64]

MOST_STARTS = 1_000
_BEGINNING = re.compile(r"date of (?:motor )?start\W+(\S+)\s+(\S+)", re.IGNORECASE)
_SUMMARY = {
    "duration_s": re.compile(r"(?:motor )?start time\W+(.+)", re.IGNORECASE),
    "peak_current_A": re.compile(r"max(?:imum)? start current\W+(.+)", re.IGNORECASE),
    "lowest_voltage_V": re.compile(r"min(?:imum)? start voltage\W+(.+)", re.IGNORECASE),
}
_UNFINISHED = "did not end"
_TIME_LABELS = ("TIME", "CYCLE")
_PHASES = ("IA", "IB", "IC")
_LINES = ("VAB", "VBC", "VCA")


@dataclass(frozen=True, slots=True)
class StartReport:
    """One start as the relay tells it; what it does not tell is None.

    Parameters
    ----------
    time_ns : int
        When the start began, by the relay's clock, as if this were in UTC.
    duration_s : float or None
        How long it lasted; None also where it did not end.
    peak_current_A : float or None
        Largest current, rms.
    lowest_voltage_V : float or None
        Lowest line voltage, rms.
    curve_time_s : ndarray, shape (n,)
        Times of the curve since the start began.
    curve_current_A : ndarray, shape (n,)
        Mean of the three currents, rms.
    curve_voltage_V : ndarray, shape (n,), or None
        Mean of the three line voltages, rms.
    """

    time_ns: int
    duration_s: float | None
    peak_current_A: float | None
    lowest_voltage_V: float | None
    curve_time_s: Array
    curve_current_A: Array
    curve_voltage_V: Array | None


def read_motor_starts(
    report: bytes | str | Path,
    *,
    name: str = "MSR",
    date_order: DateOrder = DateOrder.MDY,
    frequency_Hz: float | None = None,
) -> tuple[StartReport, ...]:
    """Read a motor start report, of one start or of several.

    Parameters
    ----------
    report : bytes, str or pathlib.Path
        The report, or its file.
    name : str
        What errors call it.
    date_order : DateOrder
        Order of dates.
    frequency_Hz : float, optional
        Line frequency; needed where the curve is over cycles.

    Returns
    -------
    tuple of StartReport
        The starts, earliest first; none where the relay has none.

    Raises
    ------
    ReportError
        If the report is none, or cannot be read.
    OSError
        If the file cannot be read.
    """
    lines = report_text(report, name).lines()
    begins = [place for place, line in enumerate(lines) if _BEGINNING.match(line.text)]
    if not begins:
        if any(is_empty(line.text) for line in lines):
            return ()
        raise ReportError(name, "end", expected='"Date of start" with date and time', found="none")
    if len(begins) > MOST_STARTS:
        raise ReportError(name, "end", expected=f"at most {MOST_STARTS} starts", found=str(len(begins)))
    ends = [*begins[1:], len(lines)]
    starts = [
        _start(lines[begin:end], date_order, frequency_Hz) for begin, end in zip(begins, ends, strict=True)
    ]
    return tuple(sorted(starts, key=lambda start: start.time_ns))


def _start(lines: list[Line], order: DateOrder, frequency_Hz: float | None) -> StartReport:
    began = _BEGINNING.match(lines[0].text)
    if began is None:
        raise lines[0].error("", expected='"Date of start"', found=lines[0].text)
    summary: dict[str, float | None] = dict.fromkeys(_SUMMARY)
    heading = len(lines)
    for place, line in enumerate(lines[1:], 1):
        labels = [label_of(field) for field in fields_of(line)]
        if labels[0] in _TIME_LABELS:
            heading = place
            break
        for field, pattern in _SUMMARY.items():
            found = pattern.match(line.text)
            if found is not None:
                summary[field] = _figure(line, field, found[1].strip())
    time_s, current_A, voltage_V = _curve(lines[heading:], frequency_Hz)
    return StartReport(
        time_of(lines[0], began[1], began[2], order), **summary,
        curve_time_s=time_s, curve_current_A=current_A, curve_voltage_V=voltage_V,
    )  # fmt: skip


def _figure(line: Line, field: str, text: str) -> float | None:
    if field == "duration_s" and text == _UNFINISHED:
        return None
    return line.quantity(field, text)


def _curve(lines: list[Line], frequency_Hz: float | None) -> tuple[Array, Array, Array | None]:
    """Return times, currents and voltages of the table that begins the lines; empty without one."""
    if not lines:
        return np.zeros(0), np.zeros(0), None
    heading = lines[0]
    labels = [label_of(field) for field in fields_of(heading)]
    names = [field.upper() for field in fields_of(heading)]
    rows = []
    for line in lines[1:]:
        fields = fields_of(line)
        line.require_fields(fields, len(labels))
        rows.append([line.figure(label, text) for label, text in zip(names, fields, strict=True)])
    table = np.array(rows, np.float64).reshape(len(rows), len(labels))
    time_s = table[:, 0]
    if labels[0] == "CYCLE":
        if frequency_Hz is None:
            raise heading.error("CYCLE", expected="the line frequency from the caller", found="none")
        time_s = time_s / frequency_Hz
    if np.any(np.diff(time_s) <= 0):
        raise heading.error(labels[0], expected="times that rise from row to row", found="others")
    currents = _mean(table, labels, names, _PHASES, "I")
    if currents is None:
        raise heading.error("", expected="a column I(A), or IA, IB and IC", found=heading.text)
    return time_s, currents, _mean(table, labels, names, _LINES, "V")


def _mean(
    table: Array, labels: list[str], names: list[str], three: tuple[str, ...], single: str
) -> Array | None:
    """Return the mean of three columns, or the one that has it already; None where there is neither."""
    if set(three) <= set(labels):
        mean: Array = table[:, [labels.index(label) for label in three]].mean(axis=1)
        return mean
    # The current stands beside its share of the rated one, under the same label in another unit.
    places = [place for place, label in enumerate(labels) if label == single and "%" not in names[place]]
    return table[:, places[0]] if places else None
