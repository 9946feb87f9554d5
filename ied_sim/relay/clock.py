"""The relay's own clock: that of the plant, with an error where the scenario says so."""

from datetime import datetime, timedelta
from zoneinfo import ZoneInfo

from core.units import NANOSECONDS_PER_SECOND
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.relay.plant_clock import PlantClock


class RelayClock:
    """Times as the relay sees them. Times inside the simulator are those of the plant's clock.

    While the plant lives through its past, records and text reports have the plant's time, as if they had
    waited in the relay since. Time stamps of values have the real one: clients that compare clocks find the
    relay's right.
    """

    def __init__(
        self, plant: PlantClock, misbehaviour_state: MisbehaviourState, zone: ZoneInfo | None = None
    ) -> None:
        """Begin. zone: in which records and reports have their times; None for UTC."""
        self._plant = plant
        self._misbehaviour_state = misbehaviour_state
        self._zone = zone

    def now_ns(self) -> int:
        """Return the plant's time."""
        return self._plant.now_ns()

    def stamped(self, time_ns: int) -> int:
        """Return a time as time stamps of data attributes have it: UTC by the relay's clock."""
        return self._plant.real_ns(time_ns) + self._offset_ns(Kind.CLOCK_OFFSET)

    def written(self, time_ns: int) -> int:
        """Return a time as records and reports have it, perhaps in local time."""
        return time_ns + self._offset_ns(Kind.CLOCK_OFFSET) + self.ahead_ns(time_ns)

    def ahead_ns(self, time_ns: int) -> int:
        """Return how far the time of records and reports is ahead of UTC."""
        ahead_ns = self._offset_ns(Kind.LOCAL_TIME)
        if self._zone is not None:
            at = datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, self._zone)
            ahead_ns += round((at.utcoffset() or timedelta()).total_seconds()) * NANOSECONDS_PER_SECOND
        return ahead_ns

    @property
    def is_local(self) -> bool:
        """Tell whether records and reports are in local time."""
        return self._zone is not None or self._misbehaviour_state.is_on(Kind.LOCAL_TIME)

    def _offset_ns(self, kind: Kind) -> int:
        return round((self._misbehaviour_state.number(kind) or 0.0) * NANOSECONDS_PER_SECOND)
