"""The alarm of a motor's rotor: raised when records agree, worse, milder, and over; once for each cause."""

from dataclasses import replace

import pytest

from core.condition.kinds import Kind, State
from core.rotor.finding import RotorState
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, Alarm
from service.storage.states import AlarmKind, AlarmState
from testing.service.plants import NOW_NS, two_motor_plant
from testing.service.rotor_and_supply import BROKEN_ROTOR, SHORT_RECORD, SOUND_ROTOR, ExaminedRecordings

UNEVEN = replace(BROKEN_ROTOR, state=RotorState.WATCH, severity_dB=-38.0, severity_dB_ci95=(-40.0, -36.0))
ADA = Actor("ada", "::1")


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


def settled(recorded: ExaminedRecordings) -> list[tuple[AlarmKind, AlarmState]]:
    """Settle the alarm; return what is not over, of kind and state."""
    recorded.repository.settle_motor_condition("PUMP-A1", now_ns=NOW_NS)
    return [(one.kind, one.state) for one in opened(recorded.repository)]


def opened(repository: Repository) -> tuple[Alarm, ...]:
    return repository.open_alarms(motor="PUMP-A1", limit=10).items


def test_a_fault_is_told_when_two_records_agree_and_is_over_when_they_do_no_more(
    recorded: ExaminedRecordings,
) -> None:
    calls = AlarmState.UNACKNOWLEDGED
    recorded.add(SOUND_ROTOR)
    assert settled(recorded) == []
    recorded.add(BROKEN_ROTOR)
    assert settled(recorded) == [(AlarmKind.ROTOR_WATCH, calls)]
    latest = recorded.add(BROKEN_ROTOR)
    assert settled(recorded) == [(AlarmKind.ROTOR_FAULT, calls)]
    (alarm,) = opened(recorded.repository)
    assert "rotor bar severity -29.0 dB; 2 of the latest 3 records show a fault" in alarm.reason
    assert alarm.what_to_do.startswith("Have the cage inspected at the next planned stop")
    assert (alarm.recording_id, alarm.priority) == (latest, "high")

    recorded.repository.acknowledge_alarm(alarm.id, by=ADA, comment="ordered", now_ns=NOW_NS)
    for _ in range(3):
        recorded.add(SOUND_ROTOR)
    assert settled(recorded) == []


def test_the_fleet_shows_a_rotor_and_since_which_record(recorded: ExaminedRecordings) -> None:
    first, *_ = (recorded.add(finding) for finding in (SOUND_ROTOR, SOUND_ROTOR, UNEVEN, UNEVEN, UNEVEN))
    repository = recorded.repository
    repository.settle_motor_condition("PUMP-A1", now_ns=NOW_NS)
    course = repository.rotor_condition("PUMP-A1")
    pump, fan = sorted(repository.fleet(), key=lambda one: one.motor.name, reverse=True)
    assert (pump.condition.state, pump.condition.kind) == (State.WATCH, Kind.ROTOR)
    assert pump.condition.since_ns == course.since_ns
    assert (course.since_ns or 0) > (repository.recording(first).recorded_ns or 0)
    assert fan.condition.state is State.UNKNOWN


def test_the_alarm_says_the_same_however_often_it_is_settled(recorded: ExaminedRecordings) -> None:
    for _ in range(2):
        recorded.add(UNEVEN)
    assert settled(recorded) == settled(recorded) == [(AlarmKind.ROTOR_WATCH, AlarmState.UNACKNOWLEDGED)]
    (alarm,) = opened(recorded.repository)
    assert alarm.raises == 1


def test_a_record_that_cannot_tell_changes_nothing(recorded: ExaminedRecordings) -> None:
    for finding in (BROKEN_ROTOR, BROKEN_ROTOR, SHORT_RECORD, SHORT_RECORD, SHORT_RECORD):
        recorded.add(finding)
    assert settled(recorded) == [(AlarmKind.ROTOR_FAULT, AlarmState.UNACKNOWLEDGED)]


def test_a_service_that_starts_settles_what_one_before_left(recorded: ExaminedRecordings) -> None:
    for _ in range(2):
        recorded.add(BROKEN_ROTOR)
    repository = recorded.repository
    repository.settle_motor_condition("PUMP-A1", now_ns=NOW_NS)
    assert [one.kind for one in opened(repository)] == [AlarmKind.ROTOR_FAULT]

    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    repository.settle_alarms(now_ns=NOW_NS)
    assert not any(one.standing for one in opened(repository))
