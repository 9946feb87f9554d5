"""What is known of a motor at times, and how long each of it holds. A gap is unknown time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from core.operation import AT_REST, Operation
from core.units import NANOSECONDS_PER_SECOND

NANOSECONDS_PER_HOUR = 3600 * NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class LoadPoint:
    """What is known of a motor from one time on.

    Parameters
    ----------
    time_ns : int
        The time, UTC [ns].
    operation : Operation or None
        What the motor does; None where that is not known.
    load_level : float or None, optional
        Load torque over rated torque; None where it is not known, or the motor stands.
    active_power_W : float or None, optional
        Power taken from the supply [W].
    """

    time_ns: int
    operation: Operation | None
    load_level: float | None = None
    active_power_W: float | None = None

    @property
    def stands(self) -> bool:
        """Whether the motor is known to stand."""
        return self.operation in AT_REST

    @property
    def runs(self) -> bool:
        """Whether the motor is known to run. After a trip it is not known until the next point."""
        return self.operation in (Operation.RUNNING, Operation.START)


def held_ns(times_ns: Sequence[int], *, longest_ns: int, until_ns: int) -> Iterator[int]:
    """Tell how long what is known at each time holds: until the next time, but no longer than a limit.

    Parameters
    ----------
    times_ns : sequence of int
        The times, oldest first [ns].
    longest_ns : int
        The limit: what is known of a mean of 15 minutes holds for 15 minutes [ns].
    until_ns : int
        End of the time that is looked at [ns].

    Yields
    ------
    int
        The time that each holds [ns].

    Raises
    ------
    ValueError
        If the times are not in order.
    """
    for time_ns, next_ns in zip(times_ns, (*times_ns, until_ns)[1:], strict=True):
        if next_ns < time_ns and next_ns != until_ns:
            raise ValueError("times must stand in their order, oldest first")
        yield max(0, min(next_ns, until_ns, time_ns + longest_ns) - time_ns)
