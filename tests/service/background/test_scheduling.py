"""Motors are recorded when their schedule says so: once, in time, and never in heaps."""

import time
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.units import NANOSECONDS_PER_DAY
from service.background.scheduling import LONGEST_DELAY_NS, Scheduler
from service.plant import Bus, Schedule
from service.storage import Repository
from service.storage.records import RecordingRequest, Sample
from service.storage.states import RecordingRequestState
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

MINUTE_NS = 60 * SECOND_NS
DUE_NS = NOW_NS - NOW_NS % MINUTE_NS + MINUTE_NS
"""The next full minute."""


def scheduler(repository: Repository, expression: str = "* * * * *", since_ns: int = NOW_NS) -> Scheduler:
    pump, fan = two_motor_plant().motors
    motors = [replace(pump, schedule=Schedule.parse(expression)), fan]
    return Scheduler(motors, repository, since_ns=since_ns)


def reports(repository: Repository) -> list[RecordingRequest]:
    return list(repository.recording_requests(limit=100).items)


def end(repository: Repository) -> None:
    """The relay made no record."""
    for report in reports(repository):
        if report.failed_ns is None:
            repository.fail_recording_request(report.id, "no record", now_ns=NOW_NS)


def test_a_schedule_asks_once_when_it_is_due(repository: Repository) -> None:
    scheduled = scheduler(repository)
    scheduled.request_due(DUE_NS - 1)
    assert reports(repository) == []
    scheduled.request_due(DUE_NS)
    scheduled.request_due(DUE_NS + 1)
    (report,) = reports(repository)
    assert (report.motor, report.origin, report.requested_ns) == ("PUMP-A1", "schedule", DUE_NS)
    end(repository)
    scheduled.request_due(DUE_NS + MINUTE_NS - 1)
    assert len(reports(repository)) == 1
    scheduled.request_due(DUE_NS + MINUTE_NS + 5)
    assert len(reports(repository)) == 2


def test_two_services_ask_once(repository: Repository) -> None:
    for scheduled in (scheduler(repository), scheduler(repository)):
        scheduled.request_due(DUE_NS + 1)
        end(repository)
    assert len(reports(repository)) == 1


def test_triggers_do_not_pile_up_at_a_relay_that_makes_no_records(repository: Repository) -> None:
    scheduled = scheduler(repository)
    by_hand = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    for minute in range(3):
        scheduled.request_due(DUE_NS + minute * MINUTE_NS)
    assert reports(repository) == [by_hand]
    end(repository)
    scheduled.request_due(DUE_NS + 3 * MINUTE_NS)
    assert len(reports(repository)) == 2


def test_what_was_slept_through_is_not_made_up_for(repository: Repository) -> None:
    scheduled = scheduler(repository, "0 * * * *")
    hour_ns = NOW_NS - NOW_NS % (60 * MINUTE_NS) + 60 * MINUTE_NS
    scheduled.request_due(hour_ns + LONGEST_DELAY_NS + SECOND_NS)
    assert reports(repository) == []
    scheduled.request_due(hour_ns + 60 * MINUTE_NS - SECOND_NS)
    scheduled.request_due(hour_ns + 60 * MINUTE_NS + SECOND_NS)
    assert len(reports(repository)) == 1


def test_a_clock_that_jumps_back_repeats_nothing(repository: Repository) -> None:
    scheduled = scheduler(repository)
    scheduled.request_due(DUE_NS)
    end(repository)
    scheduled.request_due(DUE_NS - 10 * SECOND_NS)
    scheduled.request_due(DUE_NS + SECOND_NS)
    assert len(reports(repository)) == 1
    scheduled.request_due(DUE_NS - NANOSECONDS_PER_DAY)
    scheduled.request_due(DUE_NS - NANOSECONDS_PER_DAY + SECOND_NS)
    assert len(reports(repository)) == 1
    scheduled.request_due(DUE_NS - NANOSECONDS_PER_DAY + MINUTE_NS)
    assert len(reports(repository)) == 2, "it goes on by the new time, not in a day"


def test_all_motors_of_a_bus_are_asked_for_in_one_go(repository: Repository) -> None:
    pump, fan = two_motor_plant().motors
    bus = Bus("MCC-A", (pump.name, fan.name), Schedule.parse("* * * * *"))
    scheduled = Scheduler([pump, fan], repository, buses=[bus], since_ns=NOW_NS)
    scheduled.request_due(DUE_NS - 1)
    assert reports(repository) == []
    scheduled.request_due(DUE_NS)
    asked = reports(repository)
    assert sorted(report.motor for report in asked) == [fan.name, pump.name]
    assert {report.requested_ns for report in asked} == {DUE_NS}


def test_a_motor_that_is_scheduled_alone_and_with_its_bus_is_asked_for_once(repository: Repository) -> None:
    pump, fan = two_motor_plant().motors
    every_minute = Schedule.parse("* * * * *")
    alone = [replace(pump, schedule=every_minute), fan]
    bus = Bus("MCC-A", (pump.name,), every_minute)
    Scheduler(alone, repository, buses=[bus], since_ns=NOW_NS).request_due(DUE_NS)
    assert [report.motor for report in reports(repository)] == [pump.name]


def test_a_motor_that_still_waits_does_not_keep_its_bus_waiting(repository: Repository) -> None:
    pump, fan = two_motor_plant().motors
    bus = Bus("MCC-A", (pump.name, fan.name), Schedule.parse("* * * * *"))
    repository.request_recording(pump.name, now_ns=NOW_NS)
    Scheduler([pump, fan], repository, buses=[bus], since_ns=NOW_NS).request_due(DUE_NS)
    assert [report.motor for report in reports(repository) if report.origin == "schedule"] == [fan.name]


def test_a_new_scheduler_requests_nothing_of_the_past(repository: Repository) -> None:
    pump, _ = two_motor_plant().motors
    scheduled = Scheduler([replace(pump, schedule=Schedule.parse("0 0 1 1 *"))], repository)
    scheduled.request_due(time.time_ns())
    assert reports(repository) == []


def test_a_plant_without_schedules_requests_nothing(repository: Repository) -> None:
    idle = Scheduler(two_motor_plant().motors, repository, since_ns=NOW_NS)
    idle.request_due(DUE_NS)
    assert reports(repository) == []


@pytest.mark.parametrize("words", ["", "* * * *", "* * * * * *", "61 * * * *", "x * * * *", "0 0 30 2 *"])
def test_what_is_no_schedule_is_refused(words: str) -> None:
    with pytest.raises(ValueError, match=r"fields|cron expression"):
        Schedule.parse(words)


@given(
    minute=st.integers(0, 59),
    hour=st.integers(0, 23),
    after_s=st.integers(min_value=0, max_value=7_000_000_000),
)
def test_a_daily_time_is_the_next_of_its_kind(minute: int, hour: int, after_s: int) -> None:
    of_day_s = 60 * (60 * hour + minute)
    days, passed_s = divmod(after_s, 86_400)
    expected_s = 86_400 * (days + (passed_s >= of_day_s)) + of_day_s
    assert Schedule.parse(f"{minute} {hour} * * *").next_after(after_s * SECOND_NS) == expected_s * SECOND_NS


def only_running(repository: Repository) -> Scheduler:
    pump, fan = two_motor_plant().motors
    schedule = Schedule.parse("* * * * *", only_running=True)
    return Scheduler([replace(pump, schedule=schedule), fan], repository, since_ns=NOW_NS)


def measured(repository: Repository, time_ns: int, **currents_A: float) -> None:
    repository.add_samples([Sample("PUMP-A1", time_ns, dict(currents_A))])


def test_a_motor_that_stands_is_not_recorded_and_that_is_told(repository: Repository) -> None:
    scheduled = only_running(repository)
    measured(repository, DUE_NS - 5 * SECOND_NS, ia_A=0.001, ib_A=0.002, ic_A=0.0)
    scheduled.request_due(DUE_NS)
    (report,) = reports(repository)
    assert report.state is RecordingRequestState.SKIPPED
    assert report.reason is not None
    assert report.reason.startswith("the motor stands: its relay measures 0.002 A")
    assert repository.open_recording_requests("A1_SEL710") == ()
    assert repository.condition("PUMP-A1").stood_ns == DUE_NS
    assert repository.counts().recording_requests[RecordingRequestState.SKIPPED] == 1


def test_a_motor_that_runs_is_recorded(repository: Repository) -> None:
    measured(repository, DUE_NS - 5 * SECOND_NS, ia_A=1.2, ib_A=1.2, ic_A=1.1)
    only_running(repository).request_due(DUE_NS)
    assert [report.state for report in reports(repository)] == [RecordingRequestState.REQUESTED]


@pytest.mark.parametrize("values", [{"power_W": 0.0}, {}], ids=["no currents", "nothing"])
def test_a_motor_of_which_no_current_is_known_is_recorded(
    repository: Repository, values: dict[str, float]
) -> None:
    measured(repository, DUE_NS - 5 * SECOND_NS, **values)
    only_running(repository).request_due(DUE_NS)
    assert [report.state for report in reports(repository)] == [RecordingRequestState.REQUESTED]


def test_old_values_tell_nothing(repository: Repository) -> None:
    measured(repository, DUE_NS - 5 * MINUTE_NS, ia_A=0.0, ib_A=0.0, ic_A=0.0)
    only_running(repository).request_due(DUE_NS)
    assert [report.state for report in reports(repository)] == [RecordingRequestState.REQUESTED]


def test_two_services_skip_once(repository: Repository) -> None:
    first, second = only_running(repository), only_running(repository)
    measured(repository, DUE_NS, ia_A=0.0)
    first.request_due(DUE_NS)
    second.request_due(DUE_NS)
    assert len(reports(repository)) == 1
