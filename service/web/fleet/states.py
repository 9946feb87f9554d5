"""The state of a motor as the fleet shows it: what is known of it, and whether that is still known."""

from enum import StrEnum

from core.condition.kinds import State
from service.condition.staleness import missing
from service.storage.records import ConditionEntry


class FleetState(StrEnum):
    """States, in the order in which they need attention."""

    FAULT = "fault"
    WATCH = "watch"
    UNKNOWN = "unknown"
    STALE = "stale"
    """No recent record: what the last one told is too old to rely on."""
    NOT_RUNNING = "not-running"
    """It was seen to stand after its latest record, so that there can be none."""
    HEALTHY = "healthy"


RANKS = {state: rank for rank, state in enumerate(FleetState)}

_WARNINGS = {State.FAULT: FleetState.FAULT, State.WATCH: FleetState.WATCH}
_JUDGED = {State.HEALTHY: FleetState.HEALTHY, State.UNKNOWN: FleetState.UNKNOWN}


def states_of(entry: ConditionEntry, now_ns: int, stale_after_ns: int) -> tuple[FleetState, ...]:
    """Return the states of a motor, the one that matters most first.

    A fault stays one however old its record is: that it is old, or that the motor stands, comes beside it.
    Of any other motor that is all that can be said.
    """
    warning = _WARNINGS.get(entry.state)
    why = missing(entry.as_of_ns, entry.stood_ns, now_ns, stale_after_ns)
    absent = None if why is None else FleetState(why.value)
    found = tuple(state for state in (warning, absent) if state is not None)
    return found or (_JUDGED[entry.state],)
