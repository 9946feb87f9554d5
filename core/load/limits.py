"""Hours that a quantity lies beyond its limit."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.load.course import NANOSECONDS_PER_HOUR, held_ns


@dataclass(frozen=True, slots=True)
class DatedValue:
    """A quantity from one time on.

    Parameters
    ----------
    time_ns : int
        The time, UTC [ns].
    value : float or None
        Its value; None where it is not known.
    """

    time_ns: int
    value: float | None


@dataclass(frozen=True, slots=True)
class HoursBeyond:
    """How long a quantity lay beyond a limit.

    Parameters
    ----------
    hours : float
        Time beyond the limit [h].
    known_hours : float
        Time of which the quantity is known [h].
    longest_hours : float
        Longest time beyond without a break [h]. Unknown time is a break.
    worst : float or None
        Value furthest beyond; None where none was.
    """

    hours: float
    known_hours: float
    longest_hours: float
    worst: float | None


def hours_beyond(
    values: Sequence[DatedValue], limit: float, *, until_ns: int, longest_ns: int, below: bool = False
) -> HoursBeyond:
    """Tell how long a quantity lay beyond a limit.

    Parameters
    ----------
    values : sequence of DatedValue
        The quantity, oldest first.
    limit : float
        The limit, in the quantity's unit.
    until_ns : int
        End of the time that is looked at, UTC [ns].
    longest_ns : int
        How long a value holds at most, where no other follows [ns].
    below : bool, default False
        Whether what lies below the limit is beyond it.

    Returns
    -------
    HoursBeyond
        The hours.

    Raises
    ------
    ValueError
        If the values are not in order.
    """
    beyond = known = run = longest = 0.0
    worst: float | None = None
    ends_ns: int | None = None
    times = [one.time_ns for one in values]
    for one, held in zip(values, held_ns(times, longest_ns=longest_ns, until_ns=until_ns), strict=True):
        if one.value is None:
            continue
        hours = held / NANOSECONDS_PER_HOUR
        known += hours
        if not (one.value < limit if below else one.value > limit):
            continue
        run = run + hours if ends_ns == one.time_ns else hours
        ends_ns = one.time_ns + held
        beyond += hours
        longest = max(longest, run)
        worst = one.value if worst is None else (min if below else max)(worst, one.value)
    return HoursBeyond(beyond, known, longest, worst)
