"""The relay word: named bits over time, for the event reports and the sequential events recorder."""

import threading
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

BITS = (
    *("TRIP", "50P1T", "49T", "46UBT", "ER", "STARTING", "RUNNING", "STOPPED"),
    *(f"RB{number:02d}" for number in range(1, 9)),
)
CHANGES_KEPT = 1024


@dataclass(frozen=True, slots=True)
class Change:
    """A bit that changed, and when [ns, UTC]."""

    time_ns: int
    bit: str
    value: bool


class RelayWord:
    """The last changes of the bits, which are all false before the first. Several threads may use it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._changes: deque[Change] = deque(maxlen=CHANGES_KEPT)
        self._values = dict.fromkeys(BITS, False)
        self._first = dict(self._values)
        """What the bits were before the oldest change kept."""

    def __getitem__(self, bit: str) -> bool:
        return self._values[bit]

    def set(self, bit: str, value: bool, time_ns: int) -> None:
        """Note the bit's value from `time_ns` on. Bits that are not in BITS are ignored."""
        with self._lock:
            if self._values.get(bit, value) == value:
                return
            if len(self._changes) == CHANGES_KEPT:
                oldest = self._changes[0]
                self._first[oldest.bit] = oldest.value
            self._values[bit] = value
            self._changes.append(Change(time_ns, bit, value))

    def pulse(self, bit: str, time_ns: int, duration_ns: int) -> None:
        """Set a bit for a while."""
        self.set(bit, True, time_ns)  # noqa: FBT003
        self.set(bit, False, time_ns + duration_ns)  # noqa: FBT003

    def changes(self) -> tuple[Change, ...]:
        """Return the changes, oldest first."""
        with self._lock:
            return tuple(sorted(self._changes, key=lambda change: change.time_ns))

    def states(self, time_ns: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return the values of BITS at the times, shape (n, bits)."""
        with self._lock:
            before = [self._first[bit] for bit in BITS]
        states = np.tile(np.array(before), (time_ns.size, 1))
        for change in self.changes():
            states[time_ns >= change.time_ns, BITS.index(change.bit)] = change.value
        return states
