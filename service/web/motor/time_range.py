"""The time that all charts of a motor's pages show, chosen once by their address."""

from dataclasses import dataclass
from typing import Final

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.storage import Repository


@dataclass(frozen=True, slots=True)
class TrendSpan:
    """A time that can be looked at. days: None for all of it."""

    key: str
    words: str
    days: float | None

    def from_ns(self, now_ns: int) -> int | None:
        """Return where it begins; None for the first record."""
        return None if self.days is None else now_ns - round(self.days * NANOSECONDS_PER_DAY)


SPANS: Final = (
    TrendSpan("1", "1 day", 1.0),
    TrendSpan("7", "7 days", 7.0),
    TrendSpan("30", "30 days", 30.0),
    TrendSpan("90", "90 days", 90.0),
    TrendSpan("365", "1 year", 365.0),
    TrendSpan("all", "all", None),
)
USUAL: Final = "90"


@dataclass(frozen=True, slots=True)
class TimeRange:
    """The time that was chosen, and what the axes of charts show of it.

    from_ns: None for all records.  begin_ns: where axes begin; None for the first record, before which there
    is none.  now_ns: where both end.
    """

    span: TrendSpan
    from_ns: int | None
    begin_ns: int | None
    now_ns: int

    def has(self, time_ns: int) -> bool:
        """Tell whether a record of this time is shown."""
        return self.from_ns is None or time_ns >= self.from_ns

    @property
    def x_from(self) -> float | None:
        """Return where the axis of a chart begins [s since 1970]."""
        return None if self.begin_ns is None else in_seconds(self.begin_ns)

    @property
    def x_to(self) -> float:
        """Return where the axis of a chart ends [s since 1970]."""
        return in_seconds(self.now_ns)


def span_of(key: str) -> TrendSpan:
    """Return the time with this key. Raises LookupError."""
    for span in SPANS:
        if span.key == key:
            return span
    raise LookupError(key)


def time_range(repository: Repository, motor: str, span: TrendSpan, now_ns: int) -> TimeRange:
    """Return what charts of a motor show. Without a record before it, axes begin with the first one."""
    from_ns = span.from_ns(now_ns)
    earlier = from_ns is not None and repository.latest_records(motor, limit=1, before_ns=from_ns)
    return TimeRange(span, from_ns, from_ns if earlier else None, now_ns)


def in_seconds(time_ns: int) -> float:
    """Return a time as charts take it [s since 1970]."""
    return round(time_ns / NANOSECONDS_PER_SECOND, 3)
