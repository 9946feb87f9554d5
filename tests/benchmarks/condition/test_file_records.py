"""Records that go through files: what happens to a motor begins where it is said to."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.condition import file_records
from benchmarks.condition.end_to_end import BusTask, observe_on_bus
from benchmarks.condition.file_records import SENSORS, Case, Course, through_files
from benchmarks.condition.operation import Operation, draw_operation
from core.condition.observation import Observation
from testing.machines.motors import REFERENCE

MOTOR = replace(REFERENCE, sensors=SENSORS)


def operation_of(records: int) -> Operation:
    """The same load, warmth and supply in every record."""
    drawn = draw_operation(np.random.default_rng(1), records)
    names = ("load", "warming", "relative_voltage", "unbalance", "displacement", "frequency_ratio")
    return replace(drawn, **{name: np.full(records, getattr(drawn, name)[0]) for name in names})


def observed(case: Case) -> list[Observation]:
    course = Course(MOTOR, case, 2, 1, operation_of(4), reverse=False, seed=1)
    found = through_files(course, np.random.default_rng(2))
    assert all(found)
    return [one for one in found if one is not None]


def voltage_ratios(found: list[Observation]) -> np.ndarray:
    return np.array([one.negative_voltage_V / one.positive_voltage_V for one in found])


def test_another_relay_shows_from_its_first_record_on_and_is_not_told() -> None:
    found = observed(Case.RELAY)
    before, after = voltage_ratios(found[:2]), voltage_ratios(found[2:])
    scatter = np.ptp(before.real) + np.ptp(before.imag)
    assert abs(after.mean() - before.mean()) > 10 * scatter
    assert len({one.recorder for one in found}) == 1


def test_a_voltage_channel_steps_by_one_percent() -> None:
    steps = voltage_ratios(observed(Case.VOLTAGE_STEP)) - voltage_ratios(observed(Case.HEALTHY))
    # A channel that reads 1 % more or less moves V2/V1 by a third of that.
    np.testing.assert_allclose(np.abs(steps), [0.0, 0.0, 0.01 / 3, 0.01 / 3], atol=2e-4)


def test_coarser_steps_of_the_integration_change_nothing_that_matters(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    coarse = observed(Case.PATH_1)
    monkeypatch.setattr(file_records, "STEP_RATE_HZ", 20_000.0)
    fine = observed(Case.PATH_1)
    for one, other in zip(coarse, fine, strict=True):
        assert abs(one.negative_current_A - other.negative_current_A) < 5e-6 * abs(other.positive_current_A)


def test_a_step_of_the_supply_is_seen_by_all_motors_of_a_bus() -> None:
    tasks = [BusTask(Case.SUPPLY, 0, place, before=2, after=2) for place in range(2)]
    first, second = ([one for one in observe_on_bus(task) if one] for task in tasks)
    assert [one.time_ns for one in first] == [one.time_ns for one in second]
    steps = [voltage_ratios(found)[2] - voltage_ratios(found)[1] for found in (first, second)]
    assert abs(steps[0]) > 8e-3
    # Their voltages are read by relays of their own, and wander within the minute.
    assert abs(steps[0] - steps[1]) < 1e-3
