"""The relay's own clock: UTC, with an error where the scenario says so."""

import time

from core.units import NANOSECONDS_PER_SECOND
from ied_sim.misbehaviour import Kind, MisbehaviourState


class RelayClock:
    """Times as the relay sees them. Times inside the simulator are true UTC."""

    def __init__(self, misbehaviour_state: MisbehaviourState) -> None:
        self._misbehaviour_state = misbehaviour_state

    @staticmethod
    def now_ns() -> int:
        """Return true UTC."""
        return time.time_ns()

    def stamped(self, time_ns: int) -> int:
        """Return a time as time stamps of data attributes have it: UTC by the relay's clock."""
        return time_ns + self._offset_ns(Kind.CLOCK_OFFSET)

    def written(self, time_ns: int) -> int:
        """Return a time as records and reports have it, perhaps in local time."""
        return self.stamped(time_ns) + self._offset_ns(Kind.LOCAL_TIME)

    def _offset_ns(self, kind: Kind) -> int:
        return round((self._misbehaviour_state.number(kind) or 0.0) * NANOSECONDS_PER_SECOND)
