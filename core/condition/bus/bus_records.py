"""What the other motors of a bus saw at about the time of a record."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable

from core.condition.bus.neighbours import Neighbour, neighbour_of
from core.condition.errors import ObservationError
from core.condition.measuring.bounds import check
from core.condition.observation import SAME_SUPPLY_WITHIN_NS, Observation
from core.machines.parameters import Motor


class BusRecords:
    """Records of the other motors of a bus, to be looked up by time.

    Parameters
    ----------
    records : iterable of tuple of Motor and Observation
        Records of all other motors, in any order.
    """

    def __init__(self, records: Iterable[tuple[Motor, Observation]]) -> None:
        seen = [
            (observation.time_ns, neighbour_of(motor, observation))
            for motor, observation in records
            if _is_possible(observation)
        ]
        self._seen = sorted(seen, key=_order)
        self._times_ns = [time_ns for time_ns, _ in self._seen]

    def neighbours(self, time_ns: int) -> list[Neighbour]:
        """Return what each other motor saw within a minute; of several records the nearest one tells.

        Parameters
        ----------
        time_ns : int
            Time of a record, UTC [ns].

        Returns
        -------
        list of Neighbour
            One a motor, in the order of their names.
        """
        first = bisect_left(self._times_ns, time_ns - SAME_SUPPLY_WITHIN_NS)
        beyond = bisect_right(self._times_ns, time_ns + SAME_SUPPLY_WITHIN_NS)
        nearest: dict[str, tuple[int, Neighbour]] = {}
        for seen_ns, neighbour in self._seen[first:beyond]:
            distance_ns = abs(seen_ns - time_ns)
            if neighbour.motor not in nearest or distance_ns < nearest[neighbour.motor][0]:
                nearest[neighbour.motor] = distance_ns, neighbour
        return [nearest[name][1] for name in sorted(nearest)]


def _order(seen: tuple[int, Neighbour]) -> tuple[int, str, float, float]:
    """Return what records are put in order by: two of one time are told apart by what they saw."""
    time_ns, one = seen
    ratio = one.negative_voltage_ratio
    return time_ns, one.motor, ratio.real, ratio.imag


def _is_possible(observation: Observation) -> bool:
    try:
        check(observation)
    except ObservationError:
        return False
    return True
