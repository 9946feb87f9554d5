"""Journal of what the motor and its relay did: events, starts, load profile, running hours.

The relay's text reports are made from it.
"""

import threading
from collections import Counter, deque
from dataclasses import dataclass, field

from core.units import NANOSECONDS_PER_SECOND
from ied_sim.monitoring.metering import Metering
from ied_sim.monitoring.motor_monitor import Start

STARTS_KEPT = 5
LOAD_ROWS_KEPT = 1000


@dataclass(frozen=True, slots=True)
class Event:
    """A stored event report.

    `kind` is what made it, as the relay calls it; `targets` names the elements that tripped.
    """

    number: int
    time_ns: int
    kind: str
    metering: Metering
    targets: str = ""


@dataclass(frozen=True, slots=True)
class LoadRow:
    """One row of the load profile. The thermal capacity is 1 at the trip."""

    time_ns: int
    metering: Metering
    thermal_capacity: float


@dataclass(frozen=True, slots=True)
class LoggedStart:
    """A motor start, with the UTC of the contactor's closing."""

    time_ns: int
    start: Start


@dataclass(slots=True)
class Statistics:
    """Operating statistics since `since_ns`: times [s], extremes, number of trips.

    `loaded_s` and `current_time_As` are sums over the time between starts.
    """

    since_ns: int
    running_s: float = 0.0
    loaded_s: float = 0.0
    stopped_s: float = 0.0
    current_time_As: float = 0.0
    highest_current_A: float = 0.0
    highest_start_current_A: float = 0.0
    longest_start_s: float = 0.0
    starts: int = 0
    trips: Counter[str] = field(default_factory=Counter)


class Journal:
    """Journal of one relay. It keeps `capacity` events, as many as the relay has records.

    Several threads may use it.
    """

    def __init__(self, capacity: int, *, since_ns: int, profile_every_s: float) -> None:
        self._lock = threading.Lock()
        self._events: deque[Event] = deque(maxlen=capacity)
        self._starts: deque[LoggedStart] = deque(maxlen=STARTS_KEPT)
        self._load: deque[LoadRow] = deque(maxlen=LOAD_ROWS_KEPT)
        self._every_ns = round(profile_every_s * NANOSECONDS_PER_SECOND)
        self.statistics = Statistics(since_ns)

    def add_event(self, event: Event) -> None:
        """Add a stored event."""
        with self._lock:
            self._events.append(event)

    def clear_events(self) -> None:
        """Remove all events."""
        with self._lock:
            self._events.clear()

    def add_start(self, time_ns: int, start: Start) -> None:
        """Add a motor start and count it in the statistics."""
        with self._lock:
            self._starts.append(LoggedStart(time_ns, start))
            statistics = self.statistics
            peak_A = float(start.current_A.max())
            statistics.starts += 1
            statistics.highest_start_current_A = max(statistics.highest_start_current_A, peak_A)
            statistics.longest_start_s = max(statistics.longest_start_s, start.duration_s or 0.0)

    def add_trip(self, element: str) -> None:
        """Count a trip of a protection element."""
        with self._lock:
            self.statistics.trips[element] += 1

    def add_load_row(self, time_ns: int, metering: Metering, thermal_capacity: float) -> None:
        """Add a row to the load profile where one is due."""
        with self._lock:
            if not self._load or time_ns - self._load[-1].time_ns >= self._every_ns:
                self._load.append(LoadRow(time_ns, metering, thermal_capacity))

    def add_operation(self, duration_s: float, metering: Metering, *, running: bool, starting: bool) -> None:
        """Count time in which the motor ran or stood. The current of a start is not a running current."""
        with self._lock:
            if not running:
                self.statistics.stopped_s += duration_s
                return
            statistics, current_A = self.statistics, metering.current_A
            statistics.running_s += duration_s
            if starting:
                return
            statistics.loaded_s += duration_s
            statistics.current_time_As += current_A * duration_s
            statistics.highest_current_A = max(statistics.highest_current_A, current_A)

    def events(self) -> tuple[Event, ...]:
        """Return the events, newest first, as relays list them."""
        with self._lock:
            return tuple(reversed(self._events))

    def starts(self) -> tuple[LoggedStart, ...]:
        """Return the starts, newest first."""
        with self._lock:
            return tuple(reversed(self._starts))

    def load(self) -> tuple[LoadRow, ...]:
        """Return the load profile, oldest row first."""
        with self._lock:
            return tuple(self._load)
