"""The load profile (LDP, CLDP): what the relay metered at intervals, in columns that its settings name."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.relay_reports.clock_times import DateOrder, time_of, time_of_fields
from core.relay_reports.error import ReportError
from core.relay_reports.report_text import ReportText, report_text
from core.relay_reports.tables import compressed_table, is_empty, label_of, plain_table

MOST_COLUMNS = 64
_TIME_LABELS = {"REC_NUM", "MONTH", "DAY", "YEAR", "HOUR", "MIN", "SEC", "MSEC"}
_Row = tuple[int, list[float]]


@dataclass(frozen=True, slots=True)
class LoadRows:
    """Rows of a load profile, earliest first.

    Parameters
    ----------
    time_ns : ndarray of int64, shape (n,)
        Time of each row by the relay's clock, as if this were in UTC.
    values : mapping of str to ndarray, shape (n,)
        Each column by its label in capitals without its unit; units are those of the relay's settings.
    """

    time_ns: NDArray[np.int64]
    values: Mapping[str, NDArray[np.float64]]


def read_load_profile(
    report: bytes | str | Path, *, name: str = "LDP", date_order: DateOrder = DateOrder.MDY
) -> LoadRows:
    """Read a load profile.

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
    LoadRows
        Its rows; without columns where the relay has no data.

    Raises
    ------
    ReportError
        If the report is none, or cannot be read.
    OSError
        If the file cannot be read.
    """
    text = report_text(report, name)
    labels, rows = _compressed(text) if text.is_compressed else _plain(text, date_order)
    if len(labels) > MOST_COLUMNS or len(set(labels)) < len(labels):
        raise ReportError(
            name,
            "heading",
            expected=f"at most {MOST_COLUMNS} labels, each once",
            found=", ".join(labels)[:200],
        )
    rows.sort(key=lambda row: row[0])
    time_ns = np.array([time_ns for time_ns, _ in rows], np.int64)
    values = np.array([figures for _, figures in rows], np.float64).reshape(len(rows), len(labels))
    return LoadRows(time_ns, {label: values[:, place].copy() for place, label in enumerate(labels)})


def _plain(report: ReportText, order: DateOrder) -> tuple[list[str], list[_Row]]:
    table = plain_table(report, "DATE", "TIME")
    if not table.labels:
        return [], []
    first = table.labels.index("DATE")
    labels = list(table.labels[first + 2 :])
    if table.labels[first + 1 : first + 2] != ("TIME",):
        raise ReportError(report.name, "heading", expected="TIME behind DATE", found=", ".join(table.labels))
    rows: list[_Row] = []
    for line, fields in table.rows:
        if is_empty(line.text):
            continue
        line.require_fields(fields, len(table.labels))
        figures = [line.figure(label, text) for label, text in zip(labels, fields[first + 2 :], strict=True)]
        rows.append((time_of(line, fields[first], fields[first + 1], order), figures))
    return labels, rows


def _compressed(report: ReportText) -> tuple[list[str], list[_Row]]:
    table = compressed_table(report)
    columns = [
        (place, label_of(label)) for place, label in enumerate(table.labels) if label not in _TIME_LABELS
    ]
    rows = []
    for line, fields in table.rows:
        time_ns = time_of_fields(line, dict(zip(table.labels, fields, strict=True)))
        rows.append((time_ns, [line.figure(label, fields[place]) for place, label in columns]))
    return [label for _, label in columns], rows
