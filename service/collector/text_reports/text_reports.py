"""Looks for a relay's text reports now and then, fetches what may be new, and keeps what it tells.

Records come first: a look, or one report, is fetched only where no record and no trigger waits for the relay.
What is wrong with a report is told with the relay, and its visits go on. A look that ended a visit is made
ever more seldom.
"""

import random
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Final
from zoneinfo import ZoneInfo

import structlog

from core.machines.parameters import Motor
from core.relay_reports import ReportKind
from core.relay_reports.clock_times import DateOrder
from core.units import SECONDS_PER_DAY
from mms import (
    AccessDenied,
    Client,
    FileSizeMismatch,
    NotFound,
    ProtocolError,
    ServiceFailed,
    TemporarilyUnavailable,
)
from service.collector.records.pull import DailyAllowance
from service.collector.text_reports.download import ReportTooLongError, download
from service.collector.text_reports.offered import OfferedReport, offered_reports
from service.plant import Relay
from service.plant.overrides import NONE
from service.relay_reports.brought import BroughtReport
from service.relay_reports.date_order import order_of_dates
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.keeping import keep_report
from service.storage import Repository

log = structlog.get_logger(__name__)

USUAL: Final = "REPORTS"
CONNECTING_S: Final = 60.0
"""No look comes before: the links of other relays come up meanwhile."""
FIRST_LOOK_S: Final = 300.0
"""The first look comes within this time after that, at another moment for each relay."""
DAILY: Final = frozenset({ReportKind.LOAD_PROFILE, ReportKind.MOTOR_STATISTICS})
"""Reports that tell of days: the load profile is long, and its rows wait for weeks."""
MOST_PERIODS: Final = 64
LONGEST_REASON: Final = 300
"""A reason may hold words of the report, which are a relay's."""
NOT_GIVEN = (AccessDenied, NotFound, ServiceFailed, TemporarilyUnavailable, FileSizeMismatch)


def list_reports(client: Client, directory: str) -> dict[ReportKind, OfferedReport]:
    """Return the text reports that a relay lists in a folder; none where it has no such folder.

    Raises MmsError (the link).
    """
    try:
        entries = client.files(directory)
    except (*NOT_GIVEN, ProtocolError):
        entries = ()
    return offered_reports(entries, directory)


class TextReports:
    """The text reports of one relay. Used by that relay's session alone.

    offered: names of those that the relay lists, for people to read.
    """

    def __init__(
        self,
        relay: Relay,
        motor: Motor,
        repository: Repository,
        *,
        period_s: float,
        allowance: DailyAllowance,
        on_bytes: Callable[[int], None],
    ) -> None:
        """Prepare to look for reports about a motor.

        period_s: between looks; 0 for none.  allowance: what the relay may still send today.
        on_bytes: gets the size of every part of a report that came.
        """
        overrides = relay.overrides
        self._relay = relay.name
        self._motor = motor
        self._repository = repository
        self._zone = ZoneInfo(relay.time_zone or "UTC")
        self._directory = overrides.reports_directory or USUAL
        self._period_s = 0.0 if overrides.reports_directory == NONE else period_s
        self._order: DateOrder | None = None
        self._decided_order = overrides.report_date_order
        self._power_unit = overrides.report_power_unit
        self._allowance = allowance
        self._on_bytes = on_bytes
        spread_s = random.uniform(0.0, min(FIRST_LOOK_S, period_s))  # noqa: S311 - no secret
        self._next_look_s = time.monotonic() + min(CONNECTING_S, period_s) + spread_s
        self._periods = 1
        self._is_under_way = False
        self._next_s: dict[ReportKind, float] = {}
        self._fetched: dict[ReportKind, tuple[int, int]] = {}
        self._waiting: deque[OfferedReport] = deque()
        self._troubles: dict[str, str] = {}
        self.offered: tuple[str, ...] = ()

    @property
    def remark(self) -> str | None:
        """Return which reports are not read, and why; None while there are none."""
        return "; ".join(f"{name} is not read: {why}" for name, why in self._troubles.items()) or None

    def work_if_due(self, client: Client) -> None:
        """Look for reports, or fetch one of those that were found. Raises MmsError (the link)."""
        if self._is_under_way:  # the latest look ended its visit
            self._periods = min(2 * self._periods, MOST_PERIODS)
            self._waiting.clear()
            self._is_under_way = False
        if not self._waiting and (not self._period_s or time.monotonic() < self._next_look_s):
            return
        self._is_under_way = True
        if self._waiting:
            self._fetch(client, self._waiting.popleft())
        else:
            self._next_look_s = time.monotonic() + self._periods * self._period_s
            self._look(client)
        self._is_under_way = False
        if not self._waiting:
            self._periods = 1

    def _look(self, client: Client) -> None:
        """List the folder. A relay that has none, or no report in it, is asked again at the next look."""
        found = list_reports(client, self._directory)
        self.offered = tuple(report.name for report in found.values())
        self._troubles = {name: why for name, why in self._troubles.items() if name in self.offered}
        now_s = time.monotonic()
        self._waiting.extend(
            report
            for kind, report in found.items()
            if now_s >= self._next_s.get(kind, now_s) and not self._is_known(report)
        )

    def _is_known(self, report: OfferedReport) -> bool:
        """Tell whether a report is the one that was read last, by its time: some relays give none."""
        return report.modified_ns > 0 and self._fetched.get(report.kind) == (report.size, report.modified_ns)

    def _fetch(self, client: Client, report: OfferedReport) -> None:
        pause_s = max(self._period_s, SECONDS_PER_DAY) if report.kind in DAILY else self._period_s
        self._next_s[report.kind] = time.monotonic() + pause_s
        try:
            self._keep(report, self._download(client, report))
        except (*NOT_GIVEN, ReportTooLongError, RefusedReportError) as error:
            why = str(error)[:LONGEST_REASON]
            if self._troubles.get(report.name) != why:
                log.warning("report not read", relay=self._relay, report=report.name, reason=why)
            self._troubles[report.name] = why
        else:
            self._fetched[report.kind] = (report.size, report.modified_ns)
            self._troubles.pop(report.name, None)

    def _download(self, client: Client, report: OfferedReport) -> bytes:
        now_ns = time.time_ns()
        if not self._allowance.allows((report.size,), now_ns):
            raise RefusedReportError(
                "", "the relay has sent as much as it may in a day (max_relay_bytes_per_day)"
            )

        def count(number_of_bytes: int) -> None:
            self._allowance.charge(number_of_bytes, now_ns)
            self._on_bytes(number_of_bytes)

        return download(client, report, count)

    def _keep(self, report: OfferedReport, text: bytes) -> None:
        """Keep what a report tells. Raises RefusedReportError."""
        brought = BroughtReport(
            text, DateOrder.MDY, self._power_unit, self._zone, by=None, now_ns=time.time_ns()
        )
        if not report.is_compressed:
            self._order = order_of_dates(brought, self._decided_order, self._order)
            brought = replace(brought, date_order=self._order)
        keep_report(self._repository, self._motor, brought, report.kind)
