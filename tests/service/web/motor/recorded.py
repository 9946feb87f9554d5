"""A motor with records, of which its condition follows: as a plant has them, without a relay."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import httpx

from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from service.condition.motor_data import document_of
from service.condition.worker import fold_due
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import HOUR_NS, records_of_a_motor
from testing.service.plants import fault, motor

MOTOR = "PUMP-A1"
DEVELOPING = records_of_a_motor(40, fault_from=25)


@dataclass(frozen=True, slots=True)
class Shown:
    """A site that tests only look at, and the ids of its motor's records, oldest first."""

    client: httpx.Client
    repository: Repository
    records: list[str]


def know(repository: Repository, name: str = MOTOR) -> None:
    """Have the database know what the motors file says of a motor."""
    repository.note_motors({name: document_of(motor(name))}, now_ns=time.time_ns())


def record(
    repository: Repository,
    store: RecordingStore,
    observations: Sequence[Observation] = DEVELOPING,
    *,
    name: str = MOTOR,
    ended_ns: int | None = None,
) -> list[str]:
    """Add hourly records, the last at a time or an hour ago, and fold them; return their ids."""
    know(repository, name)
    last_ns = time.time_ns() - HOUR_NS if ended_ns is None else ended_ns
    ids = []
    for ago, one in zip(range(len(observations) - 1, -1, -1), observations, strict=True):
        moved = replace(one, time_ns=last_ns - ago * HOUR_NS)
        ids.append(
            add_diagnosed(
                repository, store, fault(), moved.time_ns, motor=name, name=f"E{ago}", observed=moved
            )
        )
    while name in repository.motors_to_fold():
        fold_due(repository, motor(name))
    assert (repository.condition(name).state, repository.condition(name).kind) != (State.UNKNOWN, Kind.NONE)
    return ids
