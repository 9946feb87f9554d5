"""Alarms: what somebody has to look after, where, and what has happened to it."""

from collections.abc import Mapping
from dataclasses import dataclass

from core.units import NANOSECONDS_PER_DAY
from service.alarms.catalogue import CATALOGUE
from service.storage.states import AlarmEvent, AlarmKind, AlarmPriority, AlarmState


@dataclass(frozen=True, slots=True)
class AlarmPlace:
    """What an alarm is about: a relay, a motor, a whole site, or (all None) the service itself.

    The site and the relay of a motor, and the site of a relay, need not be given.
    """

    site: str | None = None
    relay: str | None = None
    motor: str | None = None


@dataclass(frozen=True, slots=True)
class AlarmSpec:
    """What an alarm says when it is raised.

    subject: tells it from others of its kind at the same place, e.g. a file's name.
    one_of_kind: there is one of this kind at a place, and the subject is a text that may change while it
    stands. priority: None for that of the kind. value: how bad the cause is, if it can grow.
    """

    kind: AlarmKind
    reason: str
    subject: str = ""
    one_of_kind: bool = False
    priority: AlarmPriority | None = None
    value: float | None = None
    advice: str | None = None
    recording_id: str | None = None


@dataclass(frozen=True, slots=True)
class Alarm:
    """One occurrence of something that somebody has to look after.

    Its cause stands while `cleared_ns` is None; `state` is what people and the plant's design made of it.
    site, ied, motor: None where it is not about one. value: how bad the cause is, if it can grow; seen_value:
    how bad it was when somebody acknowledged or shelved it. raised_ns: the latest time; raises: how often.
    changed_ns, changed_by, comment: of the latest change of the state. shelved_until_ns, shelved_above: what
    ends its shelving. part_of: the alarm that tells this one and many others in one line.
    """

    id: str
    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    subject: str
    reason: str
    advice: str | None
    recording_id: str | None
    priority: AlarmPriority
    state: AlarmState
    value: float | None
    seen_value: float | None
    raised_ns: int
    raises: int
    cleared_ns: int | None
    changed_ns: int
    changed_by: str
    comment: str | None
    shelved_until_ns: int | None
    shelved_above: float | None
    suppressed_because: str | None
    part_of: str | None = None

    @property
    def place(self) -> str:
        """Return what the alarm is about: a motor, a relay, a site, or the service itself."""
        return self.motor or self.ied or self.site or "the service"

    @property
    def standing(self) -> bool:
        """Tell whether the cause stands."""
        return self.cleared_ns is None

    @property
    def cause(self) -> str:
        """Return in a sentence what has happened, of all alarms of this kind."""
        return CATALOGUE[self.kind].cause

    @property
    def consequence(self) -> str:
        """Return in a sentence what follows if nobody acts."""
        return CATALOGUE[self.kind].consequence

    @property
    def what_to_do(self) -> str:
        """Return what to do about this alarm, or about all of its kind."""
        return self.advice or CATALOGUE[self.kind].action


@dataclass(frozen=True, slots=True)
class AlarmChange:
    """One thing that happened to an alarm."""

    sequence: int
    alarm: str
    changed_ns: int
    event: AlarmEvent
    before: AlarmState
    after: AlarmState
    by: str
    comment: str | None


@dataclass(frozen=True, slots=True)
class AlarmCall:
    """A time at which an alarm called for somebody, and what became of it until the end of a time.

    acknowledged_ns, gone_ns: None where nobody acknowledged it, or its cause stood on, until then or until it
    called again. state: the alarm's at that end.
    """

    alarm: Alarm
    called_ns: int
    acknowledged_ns: int | None
    acknowledged_by: str | None
    comment: str | None
    gone_ns: int | None
    state: AlarmState


@dataclass(frozen=True, slots=True)
class AlarmCause:
    """A cause of alarms, and how often it called for somebody."""

    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    subject: str
    calls: int


@dataclass(frozen=True, slots=True)
class CallsOfDay:
    """How often alarms called for somebody on a day of UTC, which begins at `day_ns`."""

    day_ns: int
    calls: int


@dataclass(frozen=True, slots=True)
class AlarmFigures:
    """Key figures of the alarms since a time.

    days: how often alarms called for somebody on each day of UTC, oldest first. frequent: the causes that
    called most often. chattering: those that called three times within an hour, with how often they did that
    in all. by_state: how many alarms are open. standing_long: those whose cause has stood for longer than a
    day, oldest first, the first of `standing_long_in_all`.
    """

    from_ns: int
    to_ns: int
    days: tuple[CallsOfDay, ...]
    frequent: tuple[AlarmCause, ...]
    chattering: tuple[AlarmCause, ...]
    by_state: Mapping[AlarmState, int]
    standing_long: tuple[Alarm, ...]
    standing_long_in_all: int

    @property
    def calls_per_day(self) -> float:
        """Return how often alarms called for somebody in a day, on average."""
        days = (self.to_ns - self.from_ns) / NANOSECONDS_PER_DAY
        return sum(day.calls for day in self.days) / days
