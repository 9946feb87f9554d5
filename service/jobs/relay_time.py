"""Whether a triggered record's time is hours off its trigger: the clock of its relay runs in another zone."""

from dataclasses import dataclass

import structlog

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.storage import Repository
from service.storage.states import AlarmKind

log = structlog.get_logger(__name__)

QUARTER_NS = 900 * NANOSECONDS_PER_SECOND
"""Time zones differ by quarters of an hour."""

FURTHEST_NS = 15 * 3600 * NANOSECONDS_PER_SECOND
"""UTC+14 is the farthest zone; with daylight saving time in the other direction it is an hour more."""

TOLERANCE_NS = 60 * NANOSECONDS_PER_SECOND
"""A relay makes its record within so long of the trigger, by a clock that drifts a little."""


@dataclass(frozen=True, slots=True)
class TriggeredRecord:
    """A record that the service triggered.

    relay: name of its relay.
    time_zone: in which the motors file says that the relay's clock runs; None for UTC.
    recorded_ns: its time [ns UTC].  triggered_ns: of its trigger [ns UTC].
    has_time_code: whether the record itself tells its time zone.
    preceding_offset_ns: how far the relay's triggered record before this one was off its trigger [ns]; None
    where there is none.
    """

    relay: str
    time_zone: str | None
    recorded_ns: int
    triggered_ns: int
    has_time_code: bool
    preceding_offset_ns: int | None = None

    @property
    def is_right(self) -> bool:
        """Tell whether the record's time is that of its trigger."""
        return abs(self.recorded_ns - self.triggered_ns) <= TOLERANCE_NS

    @property
    def is_steady(self) -> bool:
        """Tell whether the record before was as far off, if there is one: a clock that was set is not."""
        offset_ns = self.recorded_ns - self.triggered_ns
        before_ns = self.preceding_offset_ns
        return before_ns is None or abs(offset_ns - before_ns) <= 2 * TOLERANCE_NS

    def wrong_zone(self) -> str | None:
        """Return what is wrong with the time zone, and the cure; None where it is right."""
        difference_ns = self.recorded_ns - self.triggered_ns
        quarters = round(difference_ns / QUARTER_NS)
        beside_ns = abs(difference_ns - quarters * QUARTER_NS)
        if quarters == 0 or beside_ns > TOLERANCE_NS or abs(difference_ns) > FURTHEST_NS:
            return None
        return (
            f"expected the time of a record near its trigger, {rfc3339(self.triggered_ns)}, found "
            f"{rfc3339(self.recorded_ns)}, {_hours(quarters)}: {self._cure(quarters)}"
        )

    def _cure(self, quarters: int) -> str:
        if self.has_time_code:
            return (
                "the record itself says how far its times are ahead of UTC, and is wrong: set the time zone "
                "in the relay, or its clock to UTC"
            )
        if self.time_zone is None:
            return (
                f"the relay's clock runs in local time: set time_zone in the [[relay]] table of {self.relay} "
                f"to a zone that is {_hours(quarters)} of UTC, such as {_example(quarters)}, or the relay's "
                "clock to UTC"
            )
        return (
            f"the motors file says that its clock runs in {self.time_zone}, and it does not: set time_zone "
            f"in the [[relay]] table of {self.relay} right, or the relay's clock to UTC and no time_zone"
        )


def note_relay_time(repository: Repository, record: TriggeredRecord, now_ns: int) -> None:
    """Raise the alarm of a relay whose clock runs in another zone, or clear it. Raises SQLAlchemyError.

    A record whose time is off by something else than the one before raises none: a clock was corrected, of
    the relay or of the service, and the next record shows which time holds.
    """
    wrong = record.wrong_zone()
    if wrong is not None and not record.is_steady:
        log.info("the relay's clock or the service's was set", relay=record.relay, reason=wrong)
    elif wrong is not None:
        repository.raise_alarm(record.relay, AlarmKind.TIME_ZONE, "", wrong, now_ns=now_ns)
        log.warning("the relay's clock runs in another time zone", relay=record.relay, reason=wrong)
    elif record.is_right:
        repository.clear_alarms_of(record.relay, AlarmKind.TIME_ZONE, now_ns=now_ns)


def _hours(quarters: int) -> str:
    hours, rest = divmod(abs(quarters), 4)
    text = f"{hours} h" if rest == 0 else f"{hours} h {rest * 15} min"
    return f"{text} {'ahead' if quarters > 0 else 'behind'}"


def _example(quarters: int) -> str:
    """Return a zone of whole hours; nobody lives in most others."""
    hours, rest = divmod(abs(quarters), 4)
    if rest:
        return 'that of its place ("Asia/Kolkata")'
    sign = "-" if quarters > 0 else "+"
    return f'that of its place ("Europe/Berlin"), or "Etc/GMT{sign}{hours}" where it has no summer time'
