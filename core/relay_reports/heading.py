"""The heading of a plain report: when it was made, by the relay's clock."""

from core.relay_reports.clock_times import DateOrder, clock_in
from core.relay_reports.report_text import report_text


def clock_of_report(
    report: bytes | str, *, name: str = "report", date_order: DateOrder = DateOrder.MDY
) -> int | None:
    """Return when a report was made, as its heading tells.

    Parameters
    ----------
    report : bytes or str
        The report.
    name : str
        What errors call it.
    date_order : DateOrder
        Order of dates.

    Returns
    -------
    int or None
        The time of the relay's clock, as if this were in UTC [ns]; None where no heading tells it, as in
        Compressed ASCII.

    Raises
    ------
    ReportError
        If the text is no report, or its clock shows no time that exists in this order.
    """
    for line in report_text(report, name).lines():
        time_ns = clock_in(line, date_order)
        if time_ns is not None:
            return time_ns
    return None
