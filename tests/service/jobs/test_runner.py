"""The job runner with real worker processes."""

import multiprocessing.forkserver
import os
import signal
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import Event

import pytest
from sqlalchemy import Engine
from structlog.testing import capture_logs

from service.recording_store.folder import FolderStore
from service.recording_store.recording import LocalFile
from service.storage import Repository, connect
from service.storage.records import RemoteRecord
from service.storage.states import AlarmKind, JobState, RecordingRequestState, RecordingState
from testing.service.rotor_and_supply import ECCENTRIC_ROTOR, SWINGING_LOAD
from testing.waiting import wait_until
from tests.service.jobs.running import LIMITS, add, ended, running
from tests.service.jobs.stand_ins import (
    RESULTS,
    STRANGE,
    UNMOUNTING,
    fail_to_start,
    mount,
    prepare_when_told,
    unmount,
)

LEASE_S = 1.5


def test_every_recording_comes_to_its_end_whatever_the_workers_do(
    repository: Repository, store: FolderStore
) -> None:
    """One run for all of it: worker processes take a second to start."""
    told = ("fine", "reject", "raise", "die", "die once", "broken bars", "hot start")
    ids = {what: add(repository, store, what) for what in told}
    ids["foreign"] = add(repository, store, "fine too", "FAN-A2")
    ids["lost"] = add(repository, store, "lost")
    lost = repository.recording(ids["lost"]).digest
    assert lost is not None
    store.entry(lost).unlink()
    with running(repository, store) as runner:
        wait_until(lambda: ended(repository, *ids.values()), within_s=60)
        wait_until(lambda: runner.problem() is None)
    recordings = {what: repository.recording(id_) for what, id_ in ids.items()}
    assert {what: str(recording.state) for what, recording in recordings.items()} == {
        "fine": "diagnosed",
        "reject": "rejected",
        "raise": "failed",
        "die": "failed",
        "die once": "diagnosed",
        "broken bars": "diagnosed",
        "hot start": "diagnosed",
        "foreign": "rejected",
        "lost": "rejected",
    }
    reasons = {what: recording.reason or "" for what, recording in recordings.items()}
    assert reasons["reject"] == "E.CFF: line 1: expected a FID, found nothing"
    assert reasons["raise"] == "gave up after 2 attempts: ArithmeticError: no such number"
    assert "the worker process died" in reasons["die"]
    assert "FAN-A2 is not in the plant" in reasons["foreign"]
    assert "exactly one file" in reasons["lost"]
    (rotor,) = (
        one
        for one in repository.rotor_trend("PUMP-A1", limit=10).items
        if one.finding.severity_dB is not None
    )
    (supply,) = repository.supply_trend("PUMP-A1", limit=10).items
    assert (rotor.recording_id, supply.recording_id) == (ids["broken bars"],) * 2
    alarms = {one.kind: one for one in repository.open_alarms(motor="PUMP-A1", limit=10).items}
    assert set(alarms) == {AlarmKind.ROTOR_WATCH, AlarmKind.HARD_STARTS}
    assert alarms[AlarmKind.HARD_STARTS].recording_id == ids["hot start"]
    stored = repository.current_diagnosis(ids["broken bars"])
    assert stored is not None
    assert stored.document["eccentricity"] == ECCENTRIC_ROTOR.as_dict()
    assert stored.document["pulsation"] == SWINGING_LOAD.as_dict()


def test_whatever_a_result_holds_its_job_alone_fails(
    repository: Repository, store: FolderStore, engine: Engine
) -> None:
    ids = {
        what: add(repository, store, what)
        for what in (*RESULTS, "year 9999", "raise strange text", "reject strange text", "fine")
    }
    with running(repository, store, replace(LIMITS, attempts=1)) as runner:
        wait_until(lambda: ended(repository, *ids.values()), within_s=60)
        wait_until(lambda: runner.problem() is None)
    recordings = {what: repository.recording(id_) for what, id_ in ids.items()}
    assert {what for what, recording in recordings.items() if recording.state == "diagnosed"} == {
        "fine",
        "strange text",
    }
    reasons = {what: recording.reason or "" for what, recording in recordings.items()}
    ways = {
        "not a number": "mu_f",
        "infinite": "mu_f_ci95.1",
        "minus infinite": "load_level",
        "not a number deep inside": "quality.1.limit",
        "huge integer": "evaluations",
    }
    refused = "gave up after 1 attempts: the diagnosis cannot be stored: "
    for what, way in ways.items():
        assert reasons[what] == f"{refused}{way} is not JSON compliant: it is no finite number"
    assert reasons["no such thing"] == f"{refused}Object of type object is not JSON serializable"
    assert reasons["far too much text"].startswith(f"{refused}expected at most 262144 bytes, found 60")
    assert reasons["year 9999"] == f"{refused}the record's time, 2.53e+20 ns, is beyond the year 2262"
    assert reasons["huge winding"].startswith("gave up after 1 attempts: the result cannot be stored: ")
    readable = STRANGE.replace("\0", "\ufffd").replace("\ud800", "\ufffd")
    assert readable in reasons["raise strange text"]
    assert reasons["reject strange text"].startswith(readable)
    assert max(map(len, reasons.values())) < 5000
    diagnosis = repository.current_diagnosis(ids["strange text"])
    assert diagnosis is not None
    assert diagnosis.document["reasons"] == [readable]


def test_a_mass_of_repetitions_delays_no_fresh_record(repository: Repository, store: FolderStore) -> None:
    old = add(repository, store, "slow")
    with running(repository, store, replace(LIMITS, workers=1)):
        wait_until(lambda: ended(repository, old), within_s=60)
        for _ in range(60):
            repository.request_diagnosis(old, now_ns=time.time_ns())
        wait_until(lambda: len(started(repository, old)) > 1)
        stored = store.store({"NEW.CFF": b"fine"})
        remote = RemoteRecord("NEW", 4, time.time_ns())
        fresh = repository.add_recording(
            stored, motor="PUMP-A1", relay="A1_SEL710", remote=remote, now_ns=time.time_ns()
        ).recording.id
        wait_until(lambda: ended(repository, fresh))
    ((_, fresh_ns),) = started(repository, fresh)
    (job,) = repository.jobs(fresh, limit=5).items
    between = [
        begun_ns for _, begun_ns in started(repository, old) if job.job.created_ns < begun_ns < fresh_ns
    ]
    assert len(between) <= 2, "the one that its worker had just begun, and one that was claimed meanwhile"
    assert repository.counts().jobs[JobState.QUEUED] > 30


def started(repository: Repository, recording_id: str) -> list[tuple[str, int]]:
    """The recording's jobs that were claimed, with the time of that."""
    jobs = [one.job for one in repository.jobs(recording_id, limit=100).items]
    return [(job.id, job.started_ns) for job in jobs if job.started_ns is not None]


class LostWhileClaiming(FolderStore):
    """A store whose folder goes as the first recording is looked up, which is after the runner has looked."""

    was_lost = False

    def source(self, digest: str) -> LocalFile:
        if not self.was_lost:
            self.was_lost = True
            unmount(self.root)
        return super().source(digest)


@pytest.mark.parametrize("told", ["fine", *UNMOUNTING])
def test_no_recording_is_at_fault_where_the_folder_of_all_is_gone(
    repository: Repository, store: FolderStore, told: str
) -> None:
    recording_id = add(repository, store, told)
    theirs = LostWhileClaiming(store.root) if told == "fine" else store
    with capture_logs() as said, running(repository, theirs) as runner:
        wait_until(lambda: "is it mounted?" in (runner.problem() or ""), within_s=60)
        # The problem is told a moment before the job is given back.
        wait_until(lambda: repository.jobs(recording_id, limit=5).items[0].job.state is JobState.QUEUED)
        (found,) = repository.jobs(recording_id, limit=5).items
        assert found.job.attempts == 0
        assert repository.recording(recording_id).state is RecordingState.FETCHED
        mount(store.root)
        wait_until(lambda: ended(repository, recording_id))
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED
    warnings = [one["event"] for one in said if one["log_level"] == "warning"]
    assert warnings == ["jobs wait for the recordings"]


def test_a_job_that_takes_too_long_is_given_up(repository: Repository, store: FolderStore) -> None:
    report = repository.request_recording("PUMP-A1", now_ns=time.time_ns())
    stored = store.store({"E.CFF": b"hang"})
    repository.add_recording(stored, motor="PUMP-A1", recording_request_id=report.id, now_ns=time.time_ns())
    limits = replace(LIMITS, workers=1, job_timeout_s=0.3, attempts=1)
    with running(repository, store, limits):
        wait_until(lambda: repository.recording_request(report.id).state is RecordingRequestState.FAILED)
    assert (
        repository.recording_request(report.id).reason == "gave up after 1 attempts: took longer than 0.3 s"
    )


def test_a_clean_stop_gives_running_jobs_back(repository: Repository, store: FolderStore) -> None:
    recording_id = add(repository, store, "hang once")
    with running(repository, store):
        wait_until(lambda: worker_of(store))
    (found,) = repository.jobs(recording_id, limit=5).items
    job = found.job
    assert (job.state, job.attempts) == (JobState.QUEUED, 0)
    with running(repository, store):
        wait_until(lambda: ended(repository, recording_id))


def serve_and_hang(url: str, root: Path, installation: str = "ours") -> None:
    store = FolderStore(root)
    with running(
        Repository(connect(url)), store, replace(LIMITS, lease_s=LEASE_S), installation=installation
    ):
        time.sleep(600)


def worker_of(store: FolderStore) -> int | None:
    """Process id of the worker that hangs."""
    for path in store.root.rglob("*.tried"):
        text = path.read_text()
        return int(text) if text else None
    return None


def alive(process_id: int) -> bool:
    try:
        os.kill(process_id, 0)
    except ProcessLookupError:
        return False
    # A process that has ended but was not waited for (a container without an init) is dead to us.
    return "\nState:\tZ" not in Path(f"/proc/{process_id}/status").read_text()


def test_a_killed_service_loses_no_job_and_leaves_no_worker(
    repository: Repository, store: FolderStore, database_url: str
) -> None:
    recording_id = add(repository, store, "hang once")
    context = multiprocessing.get_context("spawn")
    service = context.Process(target=serve_and_hang, args=(database_url, store.root))
    service.start()
    wait_until(lambda: worker_of(store))
    worker = worker_of(store)
    assert worker is not None
    assert service.pid is not None
    os.kill(service.pid, signal.SIGKILL)
    service.join()
    (found,) = repository.jobs(recording_id, limit=5).items
    job = found.job
    assert job.state is JobState.RUNNING
    with running(repository, store):
        wait_until(lambda: ended(repository, recording_id))
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED
    assert len(repository.trend("PUMP-A1", "mu_f", limit=5).items) == 1
    wait_until(lambda: not alive(worker))


def test_two_services_share_the_jobs_and_one_takes_over_from_a_killed_one(
    repository: Repository, store: FolderStore, database_url: str
) -> None:
    recording_id = add(repository, store, "hang once")
    context = multiprocessing.get_context("spawn")
    service = context.Process(target=serve_and_hang, args=(database_url, store.root, "elsewhere"))
    service.start()
    wait_until(lambda: worker_of(store))
    with running(repository, store, replace(LIMITS, lease_s=LEASE_S)):
        began_s = time.monotonic()
        while time.monotonic() - began_s < 2 * LEASE_S:
            (found,) = repository.jobs(recording_id, limit=5).items
            assert (found.job.state, found.job.attempts) == (JobState.RUNNING, 1), "it is the other's job"
            other = add(repository, store, f"fine {time.monotonic()}")
            wait_until(partial(ended, repository, other))
        assert service.pid is not None
        os.kill(service.pid, signal.SIGKILL)
        service.join()
        wait_until(lambda: ended(repository, recording_id))
    (found,) = repository.jobs(recording_id, limit=5).items
    assert (found.job.state, found.job.attempts) == (JobState.DONE, 2)


def test_the_runner_is_not_ready_before_its_workers_are(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    go = tmp_path / "go"
    recording_id = add(repository, store, "fine")
    with running(repository, store, prepare_worker=partial(prepare_when_told, go)) as runner:
        assert runner.problem() == "2 of 2 workers are still loading"
        assert not ended(repository, recording_id)
        go.touch()
        wait_until(lambda: runner.problem() is None)
        wait_until(lambda: ended(repository, recording_id))


def test_workers_that_cannot_start_show_in_the_problem(repository: Repository, store: FolderStore) -> None:
    recording_id = add(repository, store, "fine")
    with running(repository, store, prepare_worker=fail_to_start) as runner:
        wait_until(lambda: "the worker processes ended" in (runner.problem() or ""))
    (found,) = repository.jobs(recording_id, limit=5).items
    job = found.job
    assert (job.state, job.attempts) == (JobState.QUEUED, 0), "it was not the job's fault"


@pytest.fixture
def exhausted(monkeypatch: pytest.MonkeyPatch) -> Event:
    """While it is set, the workers' parent gets no process: it ends, and its sockets with it."""
    at_the_limit = Event()
    fork = multiprocessing.forkserver.connect_to_new_process

    def fork_or_fail(passed: Sequence[int]) -> tuple[int, int]:
        if at_the_limit.is_set():
            raise EOFError("unexpected EOF")
        return fork(passed)

    monkeypatch.setattr(multiprocessing.forkserver, "connect_to_new_process", fork_or_fail)
    return at_the_limit


NO_PROCESS = "cannot be started: their parent has ended"


def test_a_start_that_gets_no_process_is_told_and_tried_again(
    repository: Repository, store: FolderStore, exhausted: Event
) -> None:
    recording_id = add(repository, store, "fine")
    exhausted.set()
    with running(repository, store) as runner:
        wait_until(lambda: NO_PROCESS in (runner.problem() or ""))
        exhausted.clear()
        wait_until(lambda: ended(repository, recording_id))
        wait_until(lambda: runner.problem() is None)
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED


def test_workers_that_die_while_the_system_has_no_process_to_give_are_replaced_later(
    repository: Repository, store: FolderStore, exhausted: Event
) -> None:
    with running(repository, store) as runner:
        wait_until(lambda: runner.problem() is None)
        exhausted.set()
        for worker in idle_workers():
            os.kill(worker, signal.SIGKILL)
        wait_until(lambda: NO_PROCESS in (runner.problem() or ""))
        recording_id = add(repository, store, "fine")
        exhausted.clear()
        wait_until(lambda: ended(repository, recording_id))
        wait_until(lambda: runner.problem() is None)
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED


def test_workers_whose_parent_dies_are_replaced_and_none_is_left(
    repository: Repository, store: FolderStore
) -> None:
    with running(repository, store) as runner:
        wait_until(lambda: runner.problem() is None)
        before = idle_workers()
        (parent,) = {parent_of(worker) for worker in before}
        os.kill(parent, signal.SIGKILL)
        recording_id = add(repository, store, "fine")
        wait_until(lambda: ended(repository, recording_id))
        wait_until(lambda: not any(alive(worker) for worker in before))
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED


def test_workers_that_die_idle_are_replaced(repository: Repository, store: FolderStore) -> None:
    with running(repository, store) as runner:
        wait_until(lambda: runner.problem() is None)
        for worker in idle_workers():
            os.kill(worker, signal.SIGKILL)
        recording_id = add(repository, store, "fine")
        wait_until(lambda: ended(repository, recording_id))
        wait_until(lambda: runner.problem() is None)
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED


def parent_of(process_id: int) -> int:
    status = Path(f"/proc/{process_id}/status").read_text()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("PPid:"))


def idle_workers() -> list[int]:
    """Process ids of this process's workers."""
    return [child.pid for child in multiprocessing.active_children() if child.pid is not None]
