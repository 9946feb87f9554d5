"""The alarms of a motor's starts: raised, told with their cause and since when, and over."""

from dataclasses import replace

import pytest

from core.condition.events import Event, EventKind
from core.starts.examined import ExaminedStart, StartStress
from core.starts.figures import MotorStart
from core.time_stamps import rfc3339
from service.recording_store.store import RecordingStore
from service.retention.deletion import delete_recording
from service.storage import Repository
from service.storage.records import Actor, Alarm, ReportedStart
from service.storage.states import AlarmKind, AlarmState
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from testing.service.starts import START, RecordedStarts

ADA = Actor("ada", "::1")
HOUR_NS = 3600 * SECOND_NS
LATER_NS = NOW_NS + 1000 * HOUR_NS


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> RecordedStarts:
    return RecordedStarts(repository, store)


def stress(heat: float, allowed: int | None = 2) -> StartStress:
    return StartStress(10_000.0, None, heat, None, "motor file", allowed)


def weak(share: float = 0.88) -> MotorStart:
    """Return a start at a weak supply."""
    curve = replace(START.curve, voltage_V=tuple(share * one for one in START.curve.voltage_V or ()))
    return replace(START, acceleration_s=1.7, curve=curve)


def standing(repository: Repository) -> list[Alarm]:
    """Settle the alarms; return those whose cause stands."""
    repository.settle_start_alarms_of("PUMP-A1", now_ns=LATER_NS)
    return told(repository)


def told(repository: Repository) -> list[Alarm]:
    return [one for one in repository.open_alarms(motor="PUMP-A1", limit=10).items if one.standing]


def add(recorded: RecordedStarts, start: MotorStart, hours: float, heat: float = 0.5) -> str:
    at_ns = NOW_NS + round(hours * HOUR_NS)
    return recorded.add(ExaminedStart(start, stress=stress(heat)), at_ns=at_ns)


def test_starts_that_come_too_soon_are_told_until_three_later_ones_do_not(recorded: RecordedStarts) -> None:
    repository = recorded.repository
    add(recorded, START, 0.0)
    add(recorded, START, 0.2)
    assert standing(repository) == []
    third = add(recorded, START, 0.4)
    (alarm,) = standing(repository)
    assert (alarm.kind, alarm.state) == (AlarmKind.HARD_STARTS, AlarmState.UNACKNOWLEDGED)
    assert alarm.reason.startswith("3 starts in the hour up to ")
    assert (alarm.recording_id, alarm.priority) == (third, "high")

    for hours in (5.0, 10.0):
        add(recorded, START, hours)
    assert [one.id for one in standing(repository)] == [alarm.id]
    add(recorded, START, 15.0)
    assert standing(repository) == []


def test_a_start_near_the_rotor_s_limit_is_told(recorded: RecordedStarts) -> None:
    add(recorded, START, 0.0, heat=0.89)
    assert standing(recorded.repository) == []
    hot = add(recorded, START, 9.0, heat=0.93)
    (alarm,) = standing(recorded.repository)
    assert "brought 93 % of the heat that the rotor withstands (motor file)" in alarm.reason
    assert alarm.recording_id == hot


def test_changed_starts_are_told_with_cause_and_since_when_and_are_over(recorded: RecordedStarts) -> None:
    repository = recorded.repository
    for number in range(8):
        add(recorded, START, 2.0 * number)
    add(recorded, weak(), 16.0)
    assert standing(repository) == []
    first_ns = NOW_NS + 16 * HOUR_NS
    for number in range(9, 13):
        add(recorded, weak(), 2.0 * number)
    (alarm,) = standing(repository)
    assert alarm.kind is AlarmKind.CHANGED_STARTS
    since = repository.starts("PUMP-A1", limit=5).items[-1]
    assert since.time_ns == first_ns
    assert alarm.reason.startswith(f"the supply, since the start of {rfc3339(first_ns)[:19]}Z; ")
    assert alarm.what_to_do.startswith("Check the voltage while it starts")
    assert [one.raises for one in standing(repository)] == [1]

    for number in range(13, 16):
        add(recorded, START, 2.0 * number)
    assert standing(repository) == []


def test_another_reference_ends_it_and_its_withdrawal_brings_it_back(recorded: RecordedStarts) -> None:
    repository = recorded.repository
    for number in range(5):
        add(recorded, START, 2.0 * number)
    for number in range(5, 8):
        add(recorded, weak(), 2.0 * number)
    assert [one.kind for one in standing(repository)] == [AlarmKind.CHANGED_STARTS]

    event = Event(NOW_NS + 9 * HOUR_NS, EventKind.REFERENCE_RESTARTED, "another transformer")
    kept = repository.add_event("PUMP-A1", event, by=ADA, now_ns=LATER_NS)
    assert told(repository) == []
    repository.withdraw_event("PUMP-A1", kept.id, by=ADA, reason="wrong motor", now_ns=LATER_NS)
    assert [one.kind for one in told(repository)] == [AlarmKind.CHANGED_STARTS]


def test_a_start_that_somebody_deletes_counts_no_more(
    recorded: RecordedStarts, store: RecordingStore
) -> None:
    add(recorded, START, 0.0)
    hot = add(recorded, START, 9.0, heat=0.93)
    assert standing(recorded.repository)
    delete_recording(recorded.repository, hot, "of another motor", by=ADA, now_ns=LATER_NS)
    assert told(recorded.repository) == []


def test_reported_starts_are_settled_with_the_report(repository: Repository) -> None:
    starts = [
        ReportedStart(NOW_NS + number * 60 * SECOND_NS, ExaminedStart(START, stress=stress(0.5)))
        for number in range(3)
    ]
    repository.add_reported_starts("PUMP-A1", starts, by=ADA, now_ns=LATER_NS)
    (alarm,) = told(repository)
    assert (alarm.kind, alarm.recording_id) == (AlarmKind.HARD_STARTS, None)


def test_a_service_that_starts_settles_what_one_before_left(recorded: RecordedStarts) -> None:
    repository = recorded.repository
    add(recorded, START, 0.0, heat=0.95)
    repository.settle_start_alarms(now_ns=NOW_NS + HOUR_NS)
    assert [one.kind for one in told(repository)] == [AlarmKind.HARD_STARTS]

    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    repository.settle_start_alarms(now_ns=LATER_NS)
    assert told(repository) == []
