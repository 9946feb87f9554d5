"""What records show by themselves: before and since a change, and nothing of what they do not tell."""

from dataclasses import replace

from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from service.condition.shown_records import asymmetry_of_records, load_points, supply_points
from service.storage.records import ConditionFigures
from service.storage.records.history import SeenRecord
from testing.service.observations import OBSERVATION, records_of_a_motor
from testing.service.plants import motor

PUMP = motor("PUMP-A1")


def seen(observed: list[Observation], figures: ConditionFigures | None = None) -> list[SeenRecord]:
    return [SeenRecord(str(number), one, figures) for number, one in enumerate(observed)]


def test_records_are_parted_at_the_change() -> None:
    records = records_of_a_motor(20, fault_from=12)
    found = asymmetry_of_records(seen(records), PUMP, since_ns=records[12].time_ns)
    assert (len(found.before), len(found.since)) == (12, 8)
    assert found.standing is not None
    assert found.now is not None
    assert abs(found.now - found.standing) > 3.0 * abs(found.standing)
    whole = asymmetry_of_records(seen(records), PUMP, since_ns=None)
    assert (len(whole.before), whole.since, whole.now) == (20, [], None)


def test_a_mean_of_two_records_is_none() -> None:
    found = asymmetry_of_records(seen(records_of_a_motor(2)), PUMP, since_ns=None)
    assert (len(found.before), found.standing) == (2, None)


def test_a_record_that_tells_no_asymmetry_is_left_out() -> None:
    standing = replace(OBSERVATION, positive_current_A=0j)
    found = asymmetry_of_records(seen([OBSERVATION, standing]), PUMP, since_ns=None)
    assert len(found.before) == 1
    (known, unknown) = supply_points(seen([OBSERVATION, standing]))
    assert known.current_unbalance < 0.1
    assert unknown.current_unbalance != unknown.current_unbalance


def test_levels_are_shown_where_level_and_load_are_known() -> None:
    figures = ConditionFigures(state=State.WATCH, kind=Kind.UNCLEAR, mu_f=0.01)
    (point,) = load_points(
        [
            *seen([OBSERVATION], figures),
            *seen([replace(OBSERVATION, load_level=None)], figures),
            *seen([OBSERVATION]),
        ]
    )
    assert (point.load, point.level, point.state) == (0.48, 0.01, "watch")
