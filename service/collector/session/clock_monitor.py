"""Measures how far a relay's clock is from this host's, from stamps that lie between two known times.

A relay stamps a change with its own clock (IEC 61850-7-3, `t`). A control's status changes between the
request for it and the answer. A measured value changes by itself: if its stamp has changed between two reads,
the relay gave the new stamp between the first request and the second answer. The stamp less the middle of
that interval is the offset of the clock; half the interval is its uncertainty. Stamps in reports are of no
use here, because nobody knows how long a report waited.
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
    ServiceFailed,
    TemporarilyUnavailable,
    Timestamp,
)
from service.collector.session.notes import Notes
from service.plant import Measurand
from service.storage import Repository
from service.storage.records import ClockNote, ClockReading
from service.storage.states import ClockQuality

FRACTION_BITS = 0x1F
"""These bits of the quality octet say how many bits of the fraction of a second are significant."""

MOST_BITS = 24
"""A larger number of significant bits means that it is unspecified."""

PERIOD_S = 1800.0
"""A clock is measured this often [s]."""

FAST_READING_S, FAST_PERIOD_S = 1.0, 0.05
"""A value that changes is read for so long and so often: many relays refresh theirs within a second."""


def stamp_of(client: Client, reference: str, constraint: FunctionalConstraint) -> Timestamp | None:
    """Return the stamp "LD/LN.DO.t"; None where the relay gives none. Raises MmsError (the link)."""
    try:
        stamp = client.read(reference, constraint)
    except (AccessDenied, NotFound, ServiceFailed, TemporarilyUnavailable):
        return None
    return stamp if isinstance(stamp, Timestamp) and stamp.ns > 0 else None


def clock_reading(stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> ClockReading:
    """Return the offset of the relay's clock from ours.

    stamp: of a change between `asked_ns` and `answered_ns`, which are of our wall clock [ns UTC].
    """
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
class _StampRead:
    """A stamp, and when it was asked for and when it came [s, monotonic]."""

    stamp: Timestamp
    asked_s: float
    answered_s: float


class ClockMonitor:
    """Measures a relay's clock now and then, from the stamps of its values. Used by its session alone."""

    def __init__(self, relay: str, repository: Repository, notes: Notes) -> None:
        """Begin without a reading.

        notes: takes readings that nothing waits for.
        """
        self._relay = relay
        self._repository = repository
        self._notes = notes
        self._stamps: deque[str] = deque()
        self._before: _StampRead | None = None
        self._due_s = 0.0

    def begin(self, measurands: Iterable[Measurand]) -> None:
        """Begin a new connection, perhaps to a relay that was restarted meanwhile."""
        self._stamps = deque(each.stamp for each in measurands if not each.quantity.is_statistic)
        self._before = None
        self._due_s = 0.0

    def control_stamp(self, client: Client, control: str) -> Timestamp | None:
        """Return the stamp of a control's latest change; None where the relay gives none.

        Raises MmsError (the link).
        """
        return stamp_of(client, f"{control}.t", FunctionalConstraint.ST)

    def note_change(self, stamp: Timestamp, *, asked_ns: int, answered_ns: int) -> None:
        """Note the stamp of a change between two times of this host's clock. Raises SQLAlchemyError.

        It is written at once: the record that the change brings about is stored with it.
        """
        reading = clock_reading(stamp, asked_ns=asked_ns, answered_ns=answered_ns)
        self._repository.note_clocks((ClockNote(self._relay, reading),))
        self._has_read()

    def measure_if_due(self, client: Client) -> None:
        """Measure the clock if it is time to, and the value has changed since the last call.

        Raises MmsError (the link), SQLAlchemyError.
        """
        if not self._stamps or time.monotonic() < self._due_s:
            return
        before, now = self._before, self._read_stamp(client)
        self._before = now
        if now is None:
            self._stamps.rotate(-1)  # another value may have one
        elif before is not None and before.stamp != now.stamp:
            reading = _between(*self._around_next_change(client, before, now))
            self._notes.add_clock(ClockNote(self._relay, reading))
            self._has_read()

    def _has_read(self) -> None:
        self._due_s = time.monotonic() + PERIOD_S
        self._before = None

    def _around_next_change(
        self, client: Client, before: _StampRead, now: _StampRead
    ) -> tuple[_StampRead, _StampRead]:
        """Return the reads around the value's next change if it comes soon, else those around its latest."""
        latest, until_s = now, time.monotonic() + FAST_READING_S
        while time.monotonic() < until_s:
            time.sleep(FAST_PERIOD_S)
            found = self._read_stamp(client)
            if found is None:
                break
            if found.stamp != latest.stamp:
                return latest, found
            latest = found
        return before, now

    def _read_stamp(self, client: Client) -> _StampRead | None:
        asked_s = time.monotonic()
        stamp = stamp_of(client, self._stamps[0], FunctionalConstraint.MX)
        return None if stamp is None else _StampRead(stamp, asked_s, time.monotonic())


def _between(before: _StampRead, after: _StampRead) -> ClockReading:
    """Return the reading of a change between two reads.

    The wall clock is read once: if somebody sets it meanwhile, that must not look like an error of the relay.
    """
    now_ns, now_s = time.time_ns(), time.monotonic()
    return clock_reading(
        after.stamp,
        asked_ns=now_ns - round((now_s - before.asked_s) * NANOSECONDS_PER_SECOND),
        answered_ns=now_ns - round((now_s - after.answered_s) * NANOSECONDS_PER_SECOND),
    )
