"""The hours of a route: days of the week and times of day in a time zone."""

from datetime import datetime, timedelta
from zoneinfo import ZoneInfo

from core.units import NANOSECONDS_PER_SECOND
from service.configuration.notifications import DAYS, Hours

DAY = timedelta(days=1)


def local(time_ns: int, zone: str) -> datetime:
    """Return a time as the clocks of a zone show it."""
    return datetime.fromtimestamp(time_ns / NANOSECONDS_PER_SECOND, ZoneInfo(zone))


def is_within(hours: Hours, at: datetime) -> bool:
    """Tell whether a local time is within the hours. Those over midnight belong to the day they began on."""
    today = DAYS[at.weekday()] in hours.days
    yesterday = DAYS[(at - DAY).weekday()] in hours.days
    clock = at.time().replace(tzinfo=None)
    if hours.begin < hours.end:
        return today and hours.begin <= clock < hours.end
    return (today and clock >= hours.begin) or (yesterday and clock < hours.end)


def next_begin(hours: Hours, at: datetime) -> int:
    """Return when the hours begin next after a local time [ns]."""
    for ahead in range(8):
        begin = datetime.combine(at.date() + ahead * DAY, hours.begin, at.tzinfo)
        if DAYS[begin.weekday()] in hours.days and begin > at:
            return _ns(begin)
    raise AssertionError("hours have at least one day a week")


def _ns(at: datetime) -> int:
    return round(at.timestamp()) * NANOSECONDS_PER_SECOND
