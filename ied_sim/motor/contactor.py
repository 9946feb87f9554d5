"""The motor's contactor: when it was closed, past and present."""

import threading
from dataclasses import dataclass
from math import inf


@dataclass(frozen=True, slots=True)
class Closure:
    """The motor was connected from `closed_s` to `opened_s` [s]; for ever where these are infinite."""

    closed_s: float = -inf
    opened_s: float = inf


class Contactor:
    """Connects the motor; closed ever since, or `open_at_first`. Times are seconds since the simulator began.

    Closing what is closed and opening what is open changes nothing. Safe to use from several threads.
    """

    def __init__(self, *, open_at_first: bool = False) -> None:
        self._closures: tuple[Closure, ...] = () if open_at_first else (Closure(),)
        self._lock = threading.Lock()

    def close(self, time_s: float) -> float | None:
        """Connect the motor, once it has opened where it is about to: when. None where it was connected."""
        with self._lock:
            opened_s = self._closures[-1].opened_s if self._closures else -inf
            if opened_s == inf:
                return None
            closed_s = max(time_s, opened_s)
            self._closures += (Closure(closed_s),)
            return closed_s

    def open(self, time_s: float) -> bool:
        """Disconnect the motor; False where it was not connected."""
        with self._lock:
            if not self._closures or not self._closures[-1].closed_s < time_s < self._closures[-1].opened_s:
                return False
            self._closures = (*self._closures[:-1], Closure(self._closures[-1].closed_s, time_s))
            return True

    def closures(self, begin_s: float, end_s: float) -> tuple[Closure, ...]:
        """Closures that reach into the time from `begin_s` to `end_s`, in order."""
        return tuple(each for each in self._closures if each.closed_s < end_s and each.opened_s > begin_s)

    def closure_at(self, time_s: float) -> Closure | None:
        """The closure at one moment, None while the contactor is open."""
        return next((each for each in self._closures if each.closed_s <= time_s < each.opened_s), None)
