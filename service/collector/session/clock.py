"""How far a relay's clock is from ours, told by the stamps it gives to what happens between two of our times.

A relay stamps a change with its own clock (IEC 61850-7-3, `t`). A control's status changes between our asking
for it and the answer. A measured value changes by itself: where its stamp was read twice and is another, it
was given between our asking the first time and the second answer. So the stamp is off by the clock's offset,
give or take half the time between. The stamps in reports tell less: nobody knows how long a report waited.
"""

import time
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from core.units import NANOSECONDS_PER_SECOND
from mms import (
    AccessDenied,
    Client,
    FunctionalConstraint,
    NotFound,
    TemporarilyUnavailable,
    Timestamp,
    ValueRefused,
)
from service.plant import Measurand
from service.storage import Repository
from service.storage.records import ClockReading
from service.storage.states import ClockQuality

FRACTION_BITS = 0x1F
"""Of the quality octet: significant bits of the fraction of a second; more than 24 means unspecified."""

MOST_BITS = 24

PERIOD_S = 1800.0
"""Between two readings of a clock."""

CLOSE_LOOK_S, CLOSE_PAUSE_S = 1.0, 0.05
"""How long, and how often, a value that changes is looked at: many relays refresh theirs within a second."""


def stamp_of(client: Client, reference: str, constraint: FunctionalConstraint) -> Timestamp | None:
    """A stamp "LD/LN.DO.t"; None where the relay gives none. Raises MmsError (the link)."""
    try:
        stamp = client.read(reference, constraint)
    except (AccessDenied, NotFound, TemporarilyUnavailable, ValueRefused):
        return None
    return stamp if isinstance(stamp, Timestamp) and stamp.ns > 0 else None


def reading(stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> ClockReading:
    """The relay's clock less ours, from the stamp of what happened between two times [ns UTC, our clock]."""
    bits = stamp.quality & FRACTION_BITS
    resolution_ns = NANOSECONDS_PER_SECOND >> bits if bits <= MOST_BITS else 0
    if stamp.clock_failure:
        quality = ClockQuality.FAILED
    elif stamp.clock_not_synchronised:
        quality = ClockQuality.NOT_SYNCHRONISED
    else:
        quality = ClockQuality.SYNCHRONISED
    return ClockReading(
        offset_ns=stamp.ns - (asked_ns + answered_ns) // 2,
        uncertainty_ns=(answered_ns - asked_ns) // 2 + resolution_ns,
        quality=quality,
        measured_ns=time.time_ns(),
    )


@dataclass(frozen=True, slots=True)
class _Look:
    """A stamp, and when it was asked for and came [s, monotonic]."""

    stamp: Timestamp
    asked_s: float
    answered_s: float


class ClockWatch:
    """Reads a relay's clock now and then off what it measures. Used by that relay's session alone."""

    def __init__(self, relay: str, repository: Repository) -> None:
        self._relay = relay
        self._repository = repository
        self._stamps: deque[str] = deque()
        self._before: _Look | None = None
        self._due_s = 0.0

    def use(self, measurands: Iterable[Measurand]) -> None:
        """A new connection, perhaps to a relay that was restarted meanwhile."""
        self._stamps = deque(each.stamp for each in measurands if not each.quantity.is_statistic)
        self._before = None
        self._due_s = 0.0

    def control_stamp(self, client: Client, control: str) -> Timestamp | None:
        """Return the stamp of a control's latest change; None where the relay gives none.

        Raises MmsError (the link).
        """
        return stamp_of(client, f"{control}.t", FunctionalConstraint.ST)

    def note_change(self, stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> None:
        """Note the stamp of a change between two times of this host's clock. Raises SQLAlchemyError."""
        self.note(reading(stamp, asked_ns=asked_ns, answered_ns=answered_ns))

    def note(self, clock: ClockReading) -> None:
        """A reading, however it was made. Raises SQLAlchemyError."""
        self._repository.note_clock(self._relay, clock)
        self._due_s = time.monotonic() + PERIOD_S
        self._before = None

    def look(self, client: Client) -> None:
        """Every round: where a reading is due and the value has changed since the last round, make one.

        Raises MmsError (the link), SQLAlchemyError.
        """
        if not self._stamps or time.monotonic() < self._due_s:
            return
        before, now = self._before, self._look(client)
        self._before = now
        if now is None:
            self._stamps.rotate(-1)  # another value may have one
        elif before is not None and before.stamp != now.stamp:
            self.note(_between(*self._looked_at_closely(client, before, now)))

    def _looked_at_closely(self, client: Client, before: _Look, now: _Look) -> tuple[_Look, _Look]:
        """The looks around the value's next change if it comes soon, else those around its last."""
        latest, until_s = now, time.monotonic() + CLOSE_LOOK_S
        while time.monotonic() < until_s:
            time.sleep(CLOSE_PAUSE_S)
            found = self._look(client)
            if found is None:
                break
            if found.stamp != latest.stamp:
                return latest, found
            latest = found
        return before, now

    def _look(self, client: Client) -> _Look | None:
        asked_s = time.monotonic()
        stamp = stamp_of(client, self._stamps[0], FunctionalConstraint.MX)
        return None if stamp is None else _Look(stamp, asked_s, time.monotonic())


def _between(before: _Look, after: _Look) -> ClockReading:
    """The wall clock is looked at once: one that is set meanwhile must not look like the relay's error."""
    now_ns, now_s = time.time_ns(), time.monotonic()
    return reading(
        after.stamp,
        asked_ns=now_ns - round((now_s - before.asked_s) * NANOSECONDS_PER_SECOND),
        answered_ns=now_ns - round((now_s - after.answered_s) * NANOSECONDS_PER_SECOND),
    )
