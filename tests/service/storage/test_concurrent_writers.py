"""The service and its collector write the same SQLite file: two real processes, no write lost or refused."""

import multiprocessing
import sqlite3
import statistics
import time
from contextlib import closing
from multiprocessing.queues import Queue
from threading import Thread

import pytest

from service.storage import Repository, connect
from service.storage.engine import BUSY_TIMEOUT_S
from service.storage.records import RemoteRecord
from service.storage.states import LinkState
from testing.service.job_runner import RUNNER, register_runner
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, two_motor_plant

ROUNDS = 60


def request_and_trigger(url: str, motor: str, done: "Queue[str]") -> None:
    engine = connect(url)
    repository = Repository(engine)
    try:
        for i in range(ROUNDS):
            request = repository.request_recording(motor, now_ns=NOW_NS + i)
            repository.mark_triggered(request.id, now_ns=NOW_NS + i)
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
    assert counts.recording_requests == {"triggered": 2 * ROUNDS}
    assert counts.recordings == {"announced": ROUNDS}, "each record is announced once, whoever saw it first"


ON_SQLITE = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)


@ON_SQLITE
def test_a_waiting_writer_goes_on_as_soon_as_the_other_is_done(
    database_url: str, repository: Repository
) -> None:
    """Looks 100 ms apart would take 50 ms on the average and miss most gaps of a busy process."""
    repository.sync_plant(two_motor_plant())
    delays_s = []
    with closing(sqlite3.connect(database_url.removeprefix("sqlite:///"), isolation_level=None)) as other:
        for number in range(9):
            other.execute("BEGIN IMMEDIATE")
            written_s: list[float] = []

            def write(written_s: list[float] = written_s) -> None:
                set_link_state(repository, "A1_SEL710", LinkState.UP, None, now_ns=NOW_NS)
                written_s.append(time.monotonic())

            writer = Thread(target=write)
            writer.start()
            time.sleep(0.3 + number / 90)  # it has waited for a while
            assert written_s == []
            let_go_s = time.monotonic()
            other.execute("ROLLBACK")
            writer.join(30)
            delays_s.append(written_s[0] - let_go_s)
    assert statistics.median(delays_s) < 0.04, delays_s


@ON_SQLITE
def test_a_renewal_goes_ahead_of_the_threads_that_wait(database_url: str, repository: Repository) -> None:
    """A gateway that has just connected 250 relays has as many threads with something to write."""
    repository.sync_plant(two_motor_plant())
    repository.register_gateway("gateway", host="host", process_id=1, now_ns=NOW_NS)
    order: list[str] = []

    def note() -> None:
        set_link_state(repository, "A1_SEL710", LinkState.UP, None, now_ns=NOW_NS)
        order.append("note")

    def renew() -> None:
        repository.share_relays("gateway", ["A1_SEL710"], most=1, problem=None)
        order.append("renewal")

    with closing(sqlite3.connect(database_url.removeprefix("sqlite:///"), isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        writers = [Thread(target=note) for _ in range(40)]
        for writer in writers:
            writer.start()
        renewal = Thread(target=renew)
        renewal.start()
        time.sleep(0.3)  # all of them wait by now
        assert order == []
        other.execute("ROLLBACK")
        for thread in (*writers, renewal):
            thread.join(30)
    assert len(order) == 41
    assert order.index("renewal") <= 2, order


@ON_SQLITE
def test_who_finds_nothing_to_do_waits_for_no_writer(database_url: str, repository: Repository) -> None:
    """Runner and gateways look all the time; nearly always there is no job and no request."""
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
    with closing(sqlite3.connect(database_url.removeprefix("sqlite:///"), isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        begun_s = time.monotonic()
        assert repository.claim_job(now_ns=NOW_NS, runner=RUNNER) is None
        assert repository.relays_with_requests() == ()
        assert time.monotonic() - begun_s < BUSY_TIMEOUT_S
