"""What was said of motors in the past, and what changed."""

from dataclasses import replace

import pytest

from core.condition.kinds import State
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import HOUR_NS, observation
from testing.service.plants import NOW_NS, fault, two_motor_plant


@pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)
def test_what_was_said_from_the_latest_record_until_then(
    repository: Repository, store: RecordingStore
) -> None:
    for hour in range(3):
        told = observation(hour)
        add_diagnosed(repository, store, fault(), told.time_ns, name=f"E{hour}", observed=told)
    tell(repository, FAULT)
    assert repository.conditions_at(NOW_NS - 1) == {}
    then = repository.conditions_at(NOW_NS + HOUR_NS)
    assert list(then) == ["PUMP-A1"], "of the other one nothing is known"
    assert then["PUMP-A1"].time_ns == NOW_NS + HOUR_NS
    assert then["PUMP-A1"].state is State.FAULT
    assert then["PUMP-A1"].mu_f_ci95 == FAULT.mu_f_ci95
    assert repository.conditions_at(NOW_NS + 9 * HOUR_NS)["PUMP-A1"].time_ns == NOW_NS + 2 * HOUR_NS


def test_changes_of_a_time_oldest_first(repository: Repository) -> None:
    tell(repository, HEALTHY, now_ns=NOW_NS)
    tell(repository, FAULT, now_ns=NOW_NS + HOUR_NS)
    tell(repository, replace(FAULT, motor="FAN-A2"), now_ns=NOW_NS + 2 * HOUR_NS)
    changes = repository.condition_changes_between(NOW_NS, NOW_NS + 2 * HOUR_NS, limit=10)
    assert [(one.motor, one.time_ns) for one in changes] == [
        ("PUMP-A1", NOW_NS + HOUR_NS),
        ("FAN-A2", NOW_NS + 2 * HOUR_NS),
    ]
    (latest,) = repository.condition_changes_between(NOW_NS - 1, NOW_NS + 2 * HOUR_NS, limit=1)
    assert latest.motor == "FAN-A2"


def test_a_motor_that_left_the_plant_is_not_told(repository: Repository) -> None:
    tell(repository, FAULT)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    assert repository.condition_changes_between(NOW_NS - 1, NOW_NS + 1, limit=9) == ()
