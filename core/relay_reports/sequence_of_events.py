"""The sequence of events (SER, CSER): when which element of the relay changed."""

from dataclasses import dataclass
from pathlib import Path

from core.relay_reports.clock_times import DateOrder, time_of, time_of_fields
from core.relay_reports.report_text import ReportText, report_text
from core.relay_reports.tables import compressed_table, plain_table

ASSERTED, DEASSERTED = "Asserted", "Deasserted"
_FEWEST_FIELDS = 4


@dataclass(frozen=True, slots=True)
class StateChange:
    """A change of one element.

    Parameters
    ----------
    time_ns : int
        When, by the relay's clock, as if this were in UTC.
    element : str
        Name of the element, or what the relay says of itself, such as "Relay Powered Up".
    asserted : bool or None
        Whether it was asserted; None for a message that is no change of an element.
    """

    time_ns: int
    element: str
    asserted: bool | None


def read_sequence_of_events(
    report: bytes | str | Path, *, name: str = "SER", date_order: DateOrder = DateOrder.MDY
) -> tuple[StateChange, ...]:
    """Read a sequence of events.

    Parameters
    ----------
    report : bytes, str or pathlib.Path
        The report, plain or Compressed ASCII, or its file.
    name : str
        What errors call it.
    date_order : DateOrder
        Order of dates in a plain report.

    Returns
    -------
    tuple of StateChange
        The changes, earliest first.

    Raises
    ------
    ReportError
        If the report is none, or cannot be read.
    OSError
        If the file cannot be read.
    """
    text = report_text(report, name)
    rows = _compressed(text) if text.is_compressed else _plain(text, date_order)
    # Relays show the newest first or last; either way the newest is number 1.
    rows.sort(key=lambda row: (row.change.time_ns, -row.number))
    return tuple(row.change for row in rows)


@dataclass(frozen=True, slots=True)
class _Row:
    number: int
    change: StateChange


def _plain(report: ReportText, order: DateOrder) -> list[_Row]:
    rows = []
    for line, fields in plain_table(report, "DATE", "TIME", "ELEMENT", "STATE").rows:
        if len(fields) < _FEWEST_FIELDS or not fields[0].isdecimal():
            raise line.error("", expected="number, date, time, element and state", found=line.text)
        time_ns = time_of(line, fields[1], fields[2], order)
        rows.append(_Row(int(fields[0]), _change(time_ns, " ".join(fields[3:-1]), fields[-1])))
    return rows


def _compressed(report: ReportText) -> list[_Row]:
    table = compressed_table(report)
    rows = []
    for place, (line, fields) in enumerate(table.rows, start=1):
        by_label = dict(zip(table.labels, fields, strict=True))
        if "ELEMENT" not in by_label or "STATE" not in by_label:
            raise line.error("", expected="the columns ELEMENT and STATE", found=",".join(table.labels))
        given = by_label.get("REC_NUM", "")
        number = int(given) if given.isascii() and given.isdecimal() else place
        change = _change(time_of_fields(line, by_label), by_label["ELEMENT"], by_label["STATE"])
        rows.append(_Row(number, change))
    return rows


def _change(time_ns: int, element: str, state: str) -> StateChange:
    if state in (ASSERTED, DEASSERTED) and element:
        return StateChange(time_ns, element, state == ASSERTED)
    return StateChange(time_ns, f"{element} {state}".strip(), None)
