"""The times that reports are about: days, weeks, months, and the minute until which one tells."""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Literal
from zoneinfo import ZoneInfo

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_MINUTE
from service.reports.errors import ReportRequestError

FIRST_YEAR, LAST_YEAR = 1970, 2200

FleetPeriod = Literal["daily", "weekly"]
DAYS_OF: dict[FleetPeriod, int] = {"daily": 1, "weekly": 7}


@dataclass(frozen=True, slots=True)
class Period:
    """What lies between two times [ns]: the first is part of it, the last is not."""

    from_ns: int
    to_ns: int


def period_until(period: FleetPeriod, until_ns: int, zone: str) -> Period:
    """Return the day or the week that ends then, as the clocks of a zone count days."""
    end = datetime.fromtimestamp(until_ns / NANOSECONDS_PER_SECOND, ZoneInfo(zone))
    begin = end - timedelta(days=DAYS_OF[period])
    return Period(_ns(begin), until_ns)


def month_of(month: str, zone: str) -> Period:
    """Return a month such as 2026-11, as the clocks of a zone count it. Raises ReportRequestError."""
    year, _, number = month.partition("-")
    is_month = len(month) == 7 and month.isascii() and year.isdecimal() and number.isdecimal()
    if not is_month or not 1 <= int(number) <= 12 or not FIRST_YEAR <= int(year) <= LAST_YEAR:
        raise ReportRequestError("month", f"expected a month such as 2026-11, found {month!r:.40}")
    first = datetime(int(year), int(number), 1, tzinfo=ZoneInfo(zone))
    following = (first.replace(day=28) + timedelta(days=4)).replace(day=1)
    return Period(_ns(first), _ns(following))


def month_before(month: str) -> str:
    """Return the month before one such as 2026-11."""
    return f"{datetime.strptime(month, '%Y-%m').replace(tzinfo=UTC) - timedelta(days=1):%Y-%m}"


def month_at(time_ns: int, zone: str) -> str:
    """Return the month that a time is in, such as 2026-11."""
    return f"{datetime.fromtimestamp(time_ns / NANOSECONDS_PER_SECOND, ZoneInfo(zone)):%Y-%m}"


def minute_before(time_ns: int) -> int:
    """Return the latest full minute: a report is of a minute, so that it can be made again."""
    minute_ns = SECONDS_PER_MINUTE * NANOSECONDS_PER_SECOND
    return time_ns // minute_ns * minute_ns


def _ns(at: datetime) -> int:
    return round(at.timestamp()) * NANOSECONDS_PER_SECOND
