"""The order of a report's dates: the one in which the clock of its heading shows the present."""

from typing import Final

from core.relay_reports import ReportError, clock_of_report
from core.relay_reports.clock_times import DateOrder
from service.relay_reports.brought import AHEAD_NS, BroughtReport
from service.relay_reports.errors import RefusedReportError

_HEADING: Final = "heading"


def order_of_dates(brought: BroughtReport, decided: DateOrder | None, before: DateOrder | None) -> DateOrder:
    """Return the order in which the heading of a report that was just made shows the present.

    decided: by the plant's files, which then must fit.  before: found in an earlier report of the relay; it
    counts where today's date reads alike in several orders.

    brought: its own order is not looked at. Raises RefusedReportError where no order fits, or several do.
    """
    orders = tuple(DateOrder) if decided is None else (decided,)
    fitting = [order for order in orders if _shows_the_present(brought, order)]
    if before in fitting:
        return before
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        alike = " and ".join(fitting)
        raise RefusedReportError(
            _HEADING, f"its date reads alike in the orders {alike}: set report_date_order"
        )
    raise RefusedReportError(
        _HEADING,
        f"expected the relay's clock within a day of the present, as {' or '.join(orders)}, found another "
        "time or none: see report_date_order, and the relay's clock",
    )


def _shows_the_present(brought: BroughtReport, order: DateOrder) -> bool:
    try:
        clock_ns = clock_of_report(brought.text, date_order=order)
    except ReportError:
        return False
    return clock_ns is not None and abs(brought.utc_ns(clock_ns) - brought.now_ns) <= AHEAD_NS
