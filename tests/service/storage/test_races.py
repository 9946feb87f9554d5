"""Two writers who do the same at the same time: the second is given what the first made."""

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Barrier
from typing import TypeVar

import pytest
from sqlalchemy import Engine

from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
from service.storage.records import RemoteRecord
from service.storage.repository.recordings.recordings import AddedRecording
from service.storage.states import AlarmKind
from testing.service.plants import NOW_NS, two_motor_plant
from testing.service.postgresql import PostgresServer

T = TypeVar("T")

WRITERS = 4
ROUNDS = 10
REMOTE = RemoteRecord("C_0001", 13, NOW_NS)


def at_once(do: Callable[[], T]) -> list[T]:
    """What several threads get that begin together."""
    together = Barrier(WRITERS)

    def begin() -> T:
        together.wait(10)
        return do()

    with ThreadPoolExecutor(WRITERS) as pool:
        futures = [pool.submit(begin) for _ in range(WRITERS)]
        return [future.result(timeout=60) for future in futures]


def test_one_key_gives_one_request(repository: Repository) -> None:
    for number in range(ROUNDS):
        request = partial(
            repository.request_recording, "PUMP-A1", now_ns=NOW_NS, idempotency_key=f"key {number}"
        )
        requests = at_once(request)
        assert len({request.id for request in requests}) == 1
    assert len(repository.recording_requests(limit=100).items) == ROUNDS


def test_a_schedule_asks_once(repository: Repository) -> None:
    requests = at_once(lambda: repository.schedule_recording("PUMP-A1", due_ns=NOW_NS, now_ns=NOW_NS))
    assert len({request.id for request in requests if request is not None}) == 1
    assert None not in requests


def upload_next(repository: Repository, records: Iterator[StoredRecording]) -> AddedRecording:
    return repository.add_recording(next(records), motor="PUMP-A1", now_ns=NOW_NS)


@pytest.mark.parametrize("renamed", [False, True])
def test_equal_uploads_are_one_recording(
    repository: Repository, store: RecordingStore, *, renamed: bool
) -> None:
    for number in range(ROUNDS):
        content = b"samples %d" % number
        names = iter(f"E{writer if renamed else 0}.CFF" for writer in range(WRITERS))
        records = iter([store.store({name: content}) for name in names])
        added = at_once(partial(upload_next, repository, records))
        assert len({one.recording.id for one in added}) == 1
        assert [one.created for one in added].count(True) == 1
    assert repository.counts().jobs == {"queued": ROUNDS}


def test_a_record_that_is_uploaded_and_pulled_is_one_recording(
    repository: Repository, store: RecordingStore
) -> None:
    stored = store.store({"C_0001.CFF": b"samples"})
    sources = iter([(None, None), ("A1_SEL710", REMOTE)] * (WRITERS // 2))

    def add() -> AddedRecording:
        relay, remote = next(sources)
        return repository.add_recording(stored, motor="PUMP-A1", relay=relay, remote=remote, now_ns=NOW_NS)

    added = at_once(add)
    assert len({one.recording.id for one in added}) == 1


def test_a_record_is_announced_once(repository: Repository) -> None:
    at_once(lambda: repository.announce_recording("A1_SEL710", "PUMP-A1", REMOTE, now_ns=NOW_NS))
    assert repository.counts().recordings == {"announced": 1}


def test_an_alarm_stands_once(repository: Repository) -> None:
    at_once(lambda: repository.raise_alarm("A1_SEL710", AlarmKind.DAILY_LIMIT, "", "full", now_ns=NOW_NS))
    assert len(repository.standing_alarms("A1_SEL710")) == 1


def test_a_plant_is_told_by_several_services(engine: Engine) -> None:
    repository = Repository(engine)
    at_once(lambda: repository.sync_plant(two_motor_plant()))
    assert len(repository.motors(limit=10).items) == 2


def test_services_that_start_at_once_migrate_once(postgresql: PostgresServer) -> None:
    with postgresql.database(migrated=False) as url:
        at_once(lambda: migrate(url))
        engine = connect(url)
        Repository(engine).sync_plant(two_motor_plant())
        engine.dispose()
