"""The motor's contactor: when it was closed, past and present."""

import threading
from dataclasses import dataclass
from math import inf


@dataclass(frozen=True, slots=True)
class Closure:
    """Time during which the motor is connected, from `closed_s` to `opened_s` [s]; infinite for no limit."""

    closed_s: float = -inf
    opened_s: float = inf


class Contactor:
    """Connects the motor: closed since ever, or `open_at_first`. Times are seconds since the simulator began.

    With `opens_s` it opens then by itself, as if somebody stopped the motor. Closing a closed contactor and
    opening an open one change nothing. Several threads may use it.
    """

    def __init__(self, *, open_at_first: bool = False, opens_s: float = inf) -> None:
        self._closures: tuple[Closure, ...] = () if open_at_first else (Closure(opened_s=opens_s),)
        self._lock = threading.Lock()

    def close(self, time_s: float) -> float | None:
        """Connect the motor and return when; None where it is connected already.

        A contactor that is about to open closes once it has opened.
        """
        with self._lock:
            opened_s = self._closures[-1].opened_s if self._closures else -inf
            if opened_s == inf:
                return None
            closed_s = max(time_s, opened_s)
            self._closures += (Closure(closed_s),)
            return closed_s

    def open(self, time_s: float) -> bool:
        """Disconnect the motor; return False where it is not connected."""
        with self._lock:
            if not self._closures or not self._closures[-1].closed_s < time_s < self._closures[-1].opened_s:
                return False
            self._closures = (*self._closures[:-1], Closure(self._closures[-1].closed_s, time_s))
            return True

    def closures(self, begin_s: float, end_s: float) -> tuple[Closure, ...]:
        """Return the closures that reach into the time from `begin_s` to `end_s`, in order."""
        return tuple(each for each in self._closures if each.closed_s < end_s and each.opened_s > begin_s)

    def closure_at(self, time_s: float) -> Closure | None:
        """Return the closure at one moment, None while the contactor is open."""
        return next((each for each in self._closures if each.closed_s <= time_s < each.opened_s), None)
