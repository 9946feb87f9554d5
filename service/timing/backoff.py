"""Exponential back-off: pauses that double with each failure in a row, up to a longest one."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Backoff:
    """How long to pause after the n-th failure in a row.

    It keeps no state: who counts the failures knows the pause, also after a restart.
    """

    first_s: float
    longest_s: float

    def pause_s(self, failures: int) -> float:
        """Return the pause after so many failures in a row [s]; 0 after none."""
        if failures <= 0 or self.first_s <= 0:
            return 0.0
        doublings = min(failures - 1, 64)  # beyond that a float would overflow before it is limited
        return min(self.first_s * 2.0**doublings, self.longest_s)


PROCESS_BACKOFF = Backoff(first_s=0.2, longest_s=30.0)
"""Before processes of the service that ended are started again."""

STABLE_AFTER_S = 60.0
"""A process that lived for longer than this ran well."""


class RestartDelay:
    """The pause before something that is meant to run for long is started again.

    A run that lasted longer than `stable_after_s` was a good one: the failures are counted anew after it.
    """

    def __init__(self, backoff: Backoff = PROCESS_BACKOFF, *, stable_after_s: float = STABLE_AFTER_S) -> None:
        self._backoff = backoff
        self._stable_after_s = stable_after_s
        self._failures = 0

    def after_run_s(self, lasted_s: float) -> float:
        """Return the pause after a run that lasted so long and ended [s]."""
        if lasted_s > self._stable_after_s:
            self._failures = 0
        self._failures += 1
        return self._backoff.pause_s(self._failures)
