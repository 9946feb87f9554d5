"""The service and its collector write the same SQLite file: two real processes, no write lost or refused."""

import multiprocessing
from multiprocessing.queues import Queue

from service.storage import Repository, connect
from service.storage.records import RemoteRecord
from tests.service.plants import NOW_NS, two_motor_plant

ROUNDS = 60


def request_and_trigger(url: str, motor: str, done: "Queue[str]") -> None:
    engine = connect(url)
    repository = Repository(engine)
    try:
        for i in range(ROUNDS):
            report = repository.request_event_report(motor, now_ns=NOW_NS + i)
            repository.mark_triggered(report.id, now_ns=NOW_NS + i)
            remote = RemoteRecord("SAME", i, NOW_NS)
            repository.announce_recording("A1_SEL710", "PUMP-A1", remote, now_ns=NOW_NS)
    finally:
        engine.dispose()
    done.put(motor)


def test_two_processes_write_at_once(database_url: str, repository: Repository) -> None:
    repository.sync_plant(two_motor_plant())
    context = multiprocessing.get_context("spawn")
    done: Queue[str] = context.Queue()
    writers = [
        context.Process(target=request_and_trigger, args=(database_url, motor, done))
        for motor in ("PUMP-A1", "FAN-A2")
    ]
    for writer in writers:
        writer.start()
    assert {done.get(timeout=60) for _ in writers} == {"PUMP-A1", "FAN-A2"}
    for writer in writers:
        writer.join(timeout=10)
        assert writer.exitcode == 0
    counts = repository.counts()
    assert counts.event_reports == {"triggered": 2 * ROUNDS}
    assert counts.recordings == {"announced": ROUNDS}, "each record is announced once, whoever saw it first"
