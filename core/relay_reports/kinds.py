"""Which report of a relay a text is, by its own labels: the right reader then says what is wrong in it."""

import re
from enum import StrEnum
from typing import Final

from core.relay_reports.error import ReportError
from core.relay_reports.report_text import Line, report_text
from core.relay_reports.tables import fields_of, label_of


class ReportKind(StrEnum):
    """Kinds of reports, by the commands that a relay shows them for."""

    MOTOR_STARTS = "MSR"
    LOAD_PROFILE = "LDP"
    MOTOR_STATISTICS = "MOT"
    SEQUENCE_OF_EVENTS = "SER"


_ENTRIES: Final = (
    (re.compile(r"date of (motor )?start\b", re.IGNORECASE), ReportKind.MOTOR_STARTS),
    (re.compile(r"(running time|number of starts)(\s{2}|\s*:)", re.IGNORECASE), ReportKind.MOTOR_STATISTICS),
)
_TITLES: Final = (
    (re.compile(r"\bmotor start\b", re.IGNORECASE), ReportKind.MOTOR_STARTS),
    (re.compile(r"\bload profile\b", re.IGNORECASE), ReportKind.LOAD_PROFILE),
    (re.compile(r"\b(sequential events|sequence of events)\b", re.IGNORECASE), ReportKind.SEQUENCE_OF_EVENTS),
    (re.compile(r"\bmotor (operating )?statistics\b", re.IGNORECASE), ReportKind.MOTOR_STATISTICS),
)
_DATED: Final = ({"DATE", "TIME"}, {"MONTH", "DAY", "YEAR"})
_CHANGES: Final = {"ELEMENT", "STATE"}


def kind_of_report(report: bytes | str, *, name: str = "report") -> ReportKind:
    """Return which report a text is: by its entries or headings, or by its title where it has no data.

    Parameters
    ----------
    report : bytes or str
        The text.
    name : str
        What errors call it.

    Returns
    -------
    ReportKind
        The kind; that report may still have errors.

    Raises
    ------
    ReportError
        If it is none of them.
    """
    lines = report_text(report, name).lines()
    for line in lines:
        kind = _kind_of_line(line)
        if kind is not None:
            return kind
    for line in lines:
        for title, kind in _TITLES:
            if title.search(line.text):
                return kind
    expected = "a report of motor starts (MSR), load (LDP), statistics (MOT) or events (SER)"
    raise ReportError(name, "end", expected=expected, found="none")


def _kind_of_line(line: Line) -> ReportKind | None:
    for entry, kind in _ENTRIES:
        if entry.match(line.text):
            return kind
    labels = {label_of(field) for field in fields_of(line)}
    if not any(dated <= labels for dated in _DATED):
        return None
    return ReportKind.SEQUENCE_OF_EVENTS if labels >= _CHANGES else ReportKind.LOAD_PROFILE
