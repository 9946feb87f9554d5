"""Hours, energy and starts of courses that are counted by hand."""

import pytest

from core.load.course import NANOSECONDS_PER_HOUR as HOUR
from core.load.course import LoadPoint
from core.load.profile import LoadProfile, class_of, load_profile
from core.operation import Operation

RUNNING, STANDING, START = Operation.RUNNING, Operation.NOT_RUNNING, Operation.START


def day(points: list[tuple[float, Operation | None, float | None, float | None]]) -> LoadProfile:
    """The profile of a day of points, each of which holds for two hours at most."""
    course = [
        LoadPoint(round(hour * HOUR), operation, load, power) for hour, operation, load, power in points
    ]
    return load_profile(course, from_ns=0, to_ns=24 * HOUR, longest_ns=2 * HOUR)


def test_hours_and_energy_go_to_the_class_of_the_torque() -> None:
    found = day([(0, RUNNING, 0.55, 6000.0), (1, RUNNING, 0.85, 9000.0), (2.5, STANDING, None, None)])

    assert found.classes[5].hours == 1.0
    assert found.classes[5].energy_kWh == pytest.approx(6.0)
    assert found.classes[8].hours == 1.5
    assert found.classes[8].energy_kWh == pytest.approx(13.5)
    assert found.energy_kWh == pytest.approx(19.5)
    assert found.mean_load == pytest.approx((0.55 + 1.5 * 0.85) / 2.5)
    assert (found.running_hours, found.standing_hours, found.unknown_hours) == (2.5, 2.0, 19.5)
    assert found.duty == pytest.approx(2.5 / 4.5)
    assert len(found.classes) == 12
    assert found.classes[-1].to_level is None


def test_a_gap_is_unknown_and_neither_running_nor_standing() -> None:
    found = day([(0, RUNNING, 0.5, None), (20, RUNNING, 0.5, None)])

    assert found.running_hours == 4.0
    assert found.unknown_hours == 20.0
    assert found.duty == 1.0


def test_points_that_tell_nothing_are_unknown() -> None:
    found = day([(0, None, None, None), (1, Operation.TRIP, None, None)])

    assert found.unknown_hours == 24.0
    assert found.duty is found.mean_load is None


def test_a_motor_of_which_nothing_is_known_has_a_profile_that_says_so() -> None:
    found = day([])
    assert (found.running_hours, found.standing_hours, found.unknown_hours) == (0.0, 0.0, 24.0)
    assert found.mean_load is None


def test_running_without_a_load_is_counted_apart() -> None:
    found = day([(0, RUNNING, None, None), (1, RUNNING, 0.5, 5000.0)])

    assert found.unclassed_hours == 1.0
    assert sum(one.hours for one in found.classes) == 2.0


def test_starts_are_counted_once_each_also_across_gaps() -> None:
    found = day(
        [
            (0, STANDING, None, None),
            (1, START, None, None),
            (1.1, RUNNING, 0.5, None),
            (2, STANDING, None, None),
            (12, None, None, None),
            (20, RUNNING, 0.5, None),
            (23, RUNNING, 0.5, None),
        ]
    )

    assert found.starts == 2
    assert day([(0, START, None, None), (0.1, RUNNING, 0.5, None)]).starts == 1
    assert day([(0, RUNNING, 0.5, None)]).starts == 0


@pytest.mark.parametrize(("load", "number"), [(-0.3, 0), (0.0, 0), (0.3, 3), (0.7, 7), (1.19, 11), (9.0, 11)])
def test_classes_are_tenths_of_the_rated_torque(load: float, number: int) -> None:
    assert class_of(load) == number


def test_points_out_of_order_are_refused() -> None:
    with pytest.raises(ValueError, match="order"):
        day([(2, RUNNING, 0.5, None), (1, RUNNING, 0.5, None)])
    with pytest.raises(ValueError, match="before"):
        day([(-1, RUNNING, 0.5, None)])


def test_a_profile_is_json() -> None:
    document = day([(0, RUNNING, 0.5, 1000.0)]).as_dict()

    classes = document["classes"]
    assert isinstance(classes, list)
    assert classes[5] == {"from_level": 0.5, "to_level": 0.6, "hours": 2.0, "energy_kWh": 2.0}
