"""Alarms of a motor's parts follow its condition, and one of a part takes the place of another."""

from dataclasses import replace

import pytest

from core.condition.kinds import Kind, State
from service.recording_store.store import RecordingStore
from service.retention.deletion import delete_recording
from service.storage import Repository
from service.storage.states import AlarmKind, AlarmState
from testing.service.plants import NOW_NS
from testing.service.rotor_and_supply import BROKEN_ROTOR, LOSSES, SOUND_ROTOR, SUPPLY, ExaminedRecordings

MOTOR = "PUMP-A1"


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


def opened(recorded: ExaminedRecordings, unbalance: float) -> list[tuple[AlarmKind, AlarmState, bool]]:
    for _ in range(3):
        recorded.add(SOUND_ROTOR, replace(SUPPLY, voltage_unbalance_nema=unbalance))
    recorded.repository.settle_motor_condition(MOTOR, now_ns=NOW_NS)
    found = recorded.repository.open_alarms(motor=MOTOR, limit=10).items
    return [(one.kind, one.state, one.standing) for one in found]


def test_a_supply_that_gets_worse_has_one_alarm_at_a_time(recorded: ExaminedRecordings) -> None:
    assert opened(recorded, 0.001) == []
    assert opened(recorded, 0.03) == [(AlarmKind.SUPPLY_WATCH, AlarmState.UNACKNOWLEDGED, True)]
    assert opened(recorded, 0.06) == [(AlarmKind.SUPPLY_FAULT, AlarmState.UNACKNOWLEDGED, True)]
    assert opened(recorded, 0.03) == [(AlarmKind.SUPPLY_WATCH, AlarmState.UNACKNOWLEDGED, True)]
    assert [standing for _, _, standing in opened(recorded, 0.001)] == [False]


def test_a_condition_follows_records_that_are_deleted(
    recorded: ExaminedRecordings, store: RecordingStore
) -> None:
    repository = recorded.repository
    ids = [recorded.add(BROKEN_ROTOR) for _ in range(3)]
    repository.settle_motor_condition(MOTOR, now_ns=NOW_NS)
    found = repository.condition(MOTOR)
    assert (found.state, found.kind) == (State.FAULT, Kind.ROTOR)
    assert found.as_of_ns == repository.recording(ids[-1]).recorded_ns
    for one in ids:
        delete_recording(repository, one, "of another motor", now_ns=NOW_NS)
    found = repository.condition(MOTOR)
    assert (found.state, found.kind, found.as_of_ns) == (State.UNKNOWN, Kind.NONE, None)


def test_what_costs_more_than_it_should_has_an_alarm_and_leaves_the_motor_healthy(
    recorded: ExaminedRecordings,
) -> None:
    repository = recorded.repository
    for _ in range(3):
        recorded.add(SOUND_ROTOR, SUPPLY, losses=replace(LOSSES, unbalance_loss_W=30.0))
    repository.settle_motor_condition(MOTOR, now_ns=NOW_NS)
    (alarm,) = repository.open_alarms(motor=MOTOR, limit=10).items
    assert (alarm.kind, alarm.standing) == (AlarmKind.INEFFICIENT, True)
    assert "unbalance of the supply 30 W" in (alarm.reason or "")
    found = repository.condition(MOTOR)
    assert found.kind is Kind.NONE
    assert found.document is not None
    assert "losses" not in str(found.document["finding"])
    for _ in range(3):
        recorded.add(SOUND_ROTOR, SUPPLY, losses=replace(LOSSES, turns_loss_W=0.0))
    repository.settle_motor_condition(MOTOR, now_ns=NOW_NS)
    assert [one.standing for one in repository.open_alarms(motor=MOTOR, limit=10).items] == [False]


def test_a_small_load_most_of_the_time_has_the_same_alarm(recorded: ExaminedRecordings) -> None:
    for _ in range(12):
        recorded.add(replace(SOUND_ROTOR, load_level=0.3, load_bin=3), SUPPLY)
    recorded.repository.settle_motor_condition(MOTOR, now_ns=NOW_NS)
    (alarm,) = recorded.repository.open_alarms(motor=MOTOR, limit=10).items
    assert alarm.kind is AlarmKind.INEFFICIENT
    assert "12 of the latest 12 records have less than 40% of the rated load" in (alarm.reason or "")
