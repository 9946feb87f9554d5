"""The load profile of a motor: hours and energy by class of torque, duty, running hours, starts."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise

from core.load.course import NANOSECONDS_PER_HOUR, LoadPoint, held_ns
from core.operation import Operation

CLASSES = 12
CLASS_WIDTH = 0.1
"""Of the rated torque. What lies above the last class is counted with it."""
WATTS_PER_KILOWATT = 1000.0


@dataclass(frozen=True, slots=True)
class LoadClass:
    """One class of torque.

    Parameters
    ----------
    from_level, to_level : float
        Its ends, over rated torque; the last one has no upper end (None in JSON).
    hours : float
        Time in it [h].
    energy_kWh : float
        Energy taken from the supply meanwhile, of the time with a known power [kWh].
    """

    from_level: float
    to_level: float | None
    hours: float
    energy_kWh: float


@dataclass(frozen=True, slots=True)
class LoadProfile:
    """How a motor was loaded from one time to another.

    Parameters
    ----------
    from_ns, to_ns : int
        The time, UTC [ns].
    classes : tuple of LoadClass
        Hours and energy by torque, in classes of a tenth of the rated one.
    running_hours, standing_hours, unknown_hours : float
        Time that the motor runs, stands, and of which nothing is known [h]. They make up the whole.
    unclassed_hours : float
        Running hours of which the load is not known [h].
    energy_kWh : float
        Energy of all running hours with a known power [kWh].
    duty : float or None
        Running hours over those that are known; None without any.
    mean_load : float or None
        Mean load level of the hours in classes.
    starts : int
        Least number of starts: a motor that stands and later runs was started at least once.
    """

    from_ns: int
    to_ns: int
    classes: tuple[LoadClass, ...]
    running_hours: float
    standing_hours: float
    unknown_hours: float
    unclassed_hours: float
    energy_kWh: float
    duty: float | None
    mean_load: float | None
    starts: int

    def as_dict(self) -> dict[str, object]:
        """Return the profile as JSON takes it.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        return asdict(self) | {"classes": [asdict(one) for one in self.classes]}


def class_of(load_level: float) -> int:
    """Return the class of a load.

    Parameters
    ----------
    load_level : float
        Load torque over rated torque. A motor that is driven counts as not loaded.

    Returns
    -------
    int
        Number of the class, from 0 on.
    """
    return min(max(int(load_level / CLASS_WIDTH + 1e-9), 0), CLASSES - 1)


def load_profile(points: Sequence[LoadPoint], *, from_ns: int, to_ns: int, longest_ns: int) -> LoadProfile:
    """Make the load profile of what is known of a motor.

    Parameters
    ----------
    points : sequence of LoadPoint
        What is known, oldest first, none of it from before `from_ns`.
    from_ns, to_ns : int
        The time that is looked at, UTC [ns].
    longest_ns : int
        How long a point holds at most, where no other follows [ns]. The rest of a gap is unknown.

    Returns
    -------
    LoadProfile
        The profile.

    Raises
    ------
    ValueError
        If the points are not in order, or one is from before `from_ns`.
    """
    if points and points[0].time_ns < from_ns:
        raise ValueError("a point is from before the time that is looked at")
    hours, energy = [0.0] * CLASSES, [0.0] * CLASSES
    running = standing = unclassed = whole_kWh = weighted = 0.0
    times = [point.time_ns for point in points]
    for point, held in zip(points, held_ns(times, longest_ns=longest_ns, until_ns=to_ns), strict=True):
        time_h = held / NANOSECONDS_PER_HOUR
        if point.stands:
            standing += time_h
        if not point.runs:
            continue
        running += time_h
        taken_kWh = (point.active_power_W or 0.0) * time_h / WATTS_PER_KILOWATT
        whole_kWh += taken_kWh
        if point.load_level is None:
            unclassed += time_h
            continue
        number = class_of(point.load_level)
        hours[number] += time_h
        energy[number] += taken_kWh
        weighted += point.load_level * time_h
    known, classed = running + standing, running - unclassed
    return LoadProfile(
        from_ns=from_ns,
        to_ns=to_ns,
        classes=tuple(map(_class, range(CLASSES), hours, energy)),
        running_hours=running,
        standing_hours=standing,
        unknown_hours=max(0.0, (to_ns - from_ns) / NANOSECONDS_PER_HOUR - known),
        unclassed_hours=unclassed,
        energy_kWh=whole_kWh,
        duty=running / known if known > 0.0 else None,
        mean_load=weighted / classed if classed > 0.0 else None,
        starts=_starts(points),
    )


def _class(number: int, hours: float, energy_kWh: float) -> LoadClass:
    last = number == CLASSES - 1
    ends = (round(number * CLASS_WIDTH, 9), None if last else round((number + 1) * CLASS_WIDTH, 9))
    return LoadClass(*ends, hours, energy_kWh)


def _starts(points: Sequence[LoadPoint]) -> int:
    """Count the times that a motor that stood is next seen to run."""
    known = [point for point in points if point.stands or point.runs]
    begins_with_one = bool(known) and known[0].operation is Operation.START
    return begins_with_one + sum(before.stands and after.runs for before, after in pairwise(known))
