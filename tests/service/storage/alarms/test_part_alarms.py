"""Alarms of a motor's parts follow its condition, and one of a part takes the place of another."""

from dataclasses import replace

import pytest

from core.condition.kinds import Kind, State
from service.recording_store.store import RecordingStore
from service.retention.deletion import delete_recording
from service.storage import Repository
from service.storage.states import AlarmKind, AlarmState
from testing.service.plants import NOW_NS
from testing.service.rotor_and_supply import BROKEN_ROTOR, SOUND_ROTOR, SUPPLY, ExaminedRecordings

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
        delete_recording(repository, store, one, "of another motor", now_ns=NOW_NS)
    found = repository.condition(MOTOR)
    assert (found.state, found.kind, found.as_of_ns) == (State.UNKNOWN, Kind.NONE, None)
