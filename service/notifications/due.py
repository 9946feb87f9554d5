"""Which summaries and reports are due: at a time of day, daily, weekly or on the first of the month."""

from collections.abc import Iterable, Iterator
from datetime import datetime, time, timedelta
from typing import Final, Protocol, TypeVar

from core.units import NANOSECONDS_PER_SECOND
from service.configuration.notifications import DAYS
from service.notifications.hours import DAY, local
from service.storage import Repository

LATEST: Final = timedelta(hours=12)
"""What no service could make in time is made up for within this time, if there was a service then."""

LOOKED_BACK_DAYS: Final = 32


class Recurring(Protocol):
    """What is sent at a time of day. day: of the week, where it is weekly."""

    @property
    def period(self) -> str: ...
    @property
    def day(self) -> str: ...
    @property
    def at(self) -> time: ...


Sent = TypeVar("Sent", bound=Recurring)


def due_now(
    wanted: Iterable[Sent], zone: str, repository: Repository, now_ns: int
) -> Iterator[tuple[Sent, datetime]]:
    """Yield what is due, with the time when it was. Raises SQLAlchemyError.

    Nothing of a time before the service first started, which the audit trail begins with: nothing can be
    said of it.
    """
    at = local(now_ns, zone)
    latest = [(one, due) for one in wanted if at - (due := latest_due(one, at)) <= LATEST]
    began_ns = repository.first_audit_entry_ns() if latest else None
    for one, due in latest:
        if began_ns is None or due.timestamp() * NANOSECONDS_PER_SECOND >= began_ns:
            yield one, due


def latest_due(wanted: Recurring, at: datetime) -> datetime:
    """Return when something was due last, at a local time or before."""
    for ago in range(LOOKED_BACK_DAYS):
        due = datetime.combine(at.date() - ago * DAY, wanted.at, at.tzinfo)
        is_its_day = {
            "daily": True,
            "weekly": DAYS[due.weekday()] == wanted.day,
            "monthly": due.day == 1,
        }[wanted.period]
        if due <= at and is_its_day:
            return due
    raise AssertionError("it is due every month at least")
