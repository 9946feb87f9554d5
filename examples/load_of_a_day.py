"""Make a motor's load profile, and hours beyond a limit, of one day: python examples/load_of_a_day.py"""

from core.load.course import NANOSECONDS_PER_HOUR, LoadPoint
from core.load.limits import DatedValue, hours_beyond
from core.load.profile import load_profile
from core.operation import Operation
from core.units import NANOSECONDS_PER_DAY

QUARTER_NS = NANOSECONDS_PER_HOUR // 4
RATED_W = 7500.0
LIMIT = 1.0

DAY = {6: 0.55, 8: 0.82, 11: 1.08, 12: 0.35, 13: 0.79, 17: 0.0}
"""From which hour on the motor carries which load, over its rated torque; 0: it stands."""
LAST_HOUR = 20
"""From then on nothing is known."""


def quarters() -> list[LoadPoint]:
    """What is known of the motor each quarter of an hour, as a relay's load profile or its meters tell it."""
    points, load = [], 0.0
    for quarter in range(4 * LAST_HOUR):
        load = DAY.get(quarter // 4, load)
        points.append(
            LoadPoint(
                quarter * QUARTER_NS,
                Operation.RUNNING if load else Operation.NOT_RUNNING,
                load or None,
                RATED_W * load / 0.9 if load else 0.0,
            )
        )
    return points


def main() -> None:
    points = quarters()
    profile = load_profile(points, from_ns=0, to_ns=NANOSECONDS_PER_DAY, longest_ns=QUARTER_NS)
    print(
        f"{profile.running_hours:g} h running, {profile.standing_hours:g} h standing, "
        f"{profile.unknown_hours:g} h unknown; {profile.starts} start, {profile.energy_kWh:.1f} kWh, "
        f"mean load {profile.mean_load:.0%}"
    )
    for one in profile.classes:
        if one.hours:
            end = "above" if one.to_level is None else f"to {one.to_level:.0%}"
            print(f"  {one.from_level:4.0%} {end:>8}  {one.hours:4.1f} h  {one.energy_kWh:5.1f} kWh")
    beyond = hours_beyond(
        [DatedValue(point.time_ns, point.load_level) for point in points],
        LIMIT,
        until_ns=NANOSECONDS_PER_DAY,
        longest_ns=QUARTER_NS,
    )
    print(
        f"beyond {LIMIT:.0%}: {beyond.hours:g} h, {beyond.longest_hours:g} h without a break, "
        f"at most {beyond.worst:.0%}"
    )


if __name__ == "__main__":
    main()
