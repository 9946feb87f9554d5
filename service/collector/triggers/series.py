"""When a relay is triggered again, so that its records overlap and make up one of the length wanted.

Between the triggers the relay's session does its usual work, as far as that ends before the next trigger.
"""

from math import inf

from service.plant.series_rhythm import Rhythm


class SeriesUnderWay:
    """A series whose first trigger is done. Used by the relay's session alone. Times are monotonic [s]."""

    def __init__(self, control: str, rhythm: Rhythm, *, began_s: float, record_timeout_s: float) -> None:
        """Begin with the time of the first trigger.

        control: what triggers the relay.  record_timeout_s: how long its records are waited for.
        """
        self.control = control
        self._rhythm = rhythm
        self._latest_s = began_s
        self._record_timeout_s = record_timeout_s
        self._triggered = 1
        self._came = 0

    def due_in_s(self, now_s: float) -> float:
        """Return the time until the next trigger; infinite where the last one is done."""
        if self._triggered >= self._rhythm.triggers:
            return inf
        # Counted from the latest one: after a late trigger the next must not fall into the record under way.
        return max(0.0, self._latest_s + self._rhythm.period_s - now_s)

    def triggered(self, now_s: float) -> None:
        """Note that the relay was triggered again."""
        self._triggered += 1
        self._latest_s = now_s

    def came(self) -> None:
        """Note that a record came."""
        self._came += 1

    def is_over(self, now_s: float) -> bool:
        """Return whether all of its records came, or no more are to be waited for."""
        return self.due_in_s(now_s) == inf and (
            self._came >= self._rhythm.triggers or now_s > self._latest_s + self._record_timeout_s
        )
