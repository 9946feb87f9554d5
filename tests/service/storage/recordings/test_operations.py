"""What a motor does in its recordings: kept with them, and counted among the bad ones nowhere."""

from dataclasses import replace

import pytest

from core.diagnosis.verdict import Diagnosis, Verdict
from core.operation import Operation
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.repository.recordings.kept_recordings import Keeping
from service.storage.repository.recordings.retention import ExpiredRecordings
from service.storage.states import RecordingState
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault

MOTOR = "PUMP-A1"


def of(operation: Operation | None) -> Diagnosis:
    if operation is Operation.RUNNING:
        return replace(fault(), operation=operation)
    return replace(
        fault(), verdict=Verdict.UNDIAGNOSABLE, mu_f=None, mu_f_ci95=None, theta_f=None, operation=operation
    )


class Recorded:
    """Recordings of a motor, one a second."""

    def __init__(self, repository: Repository, store: RecordingStore) -> None:
        self.repository, self._store, self._number = repository, store, 0

    def add(self, operation: Operation | None, remark: str | None = None) -> str:
        self._number += 1
        now_ns = NOW_NS + self._number * SECOND_NS
        stored = self._store.store({f"E{self._number}.CFF": str(self._number).encode()})
        added = self.repository.add_recording(stored, motor=MOTOR, now_ns=now_ns)
        claimed = self.repository.claim_job(now_ns=now_ns, runner=RUNNER)
        assert claimed is not None
        self.repository.finish_job(
            claimed.job.id,
            findings_of(of(operation), not_commissioned_from=remark),
            recorded_ns=now_ns,
            now_ns=now_ns,
            runner=RUNNER,
        )
        return added.recording.id


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> Recorded:
    return Recorded(repository, store)


def test_recordings_are_listed_by_what_the_motor_does(recorded: Recorded) -> None:
    running, start, unknown = (recorded.add(each) for each in (Operation.RUNNING, Operation.START, None))
    found = recorded.repository.recordings(limit=10, operation=Operation.START).items
    assert [(one.id, one.operation) for one in found] == [(start, Operation.START)]
    assert recorded.repository.recording(running).operation is Operation.RUNNING
    assert recorded.repository.recording(unknown).operation is None


def test_a_motor_that_stands_keeps_its_latest_verdict(recorded: Recorded) -> None:
    running = recorded.add(Operation.RUNNING)
    for other in (Operation.START, Operation.STOP, Operation.TRIP, Operation.NOT_RUNNING):
        latest = recorded.add(other)
    health = recorded.repository.health(MOTOR)
    assert health.diagnosis is not None
    assert health.diagnosis.recording_id == running
    assert health.last_recording is not None
    assert health.last_recording.id == latest
    assert [point.recording_id for point in recorded.repository.trend(MOTOR, "mu_f", limit=9).items] == [
        running
    ]


def test_a_record_that_is_bad_is_the_latest(recorded: Recorded) -> None:
    recorded.add(Operation.RUNNING)
    bad = recorded.add(None)
    health = recorded.repository.health(MOTOR)
    assert health.diagnosis is not None
    assert (health.diagnosis.recording_id, health.diagnosis.verdict) == (bad, Verdict.UNDIAGNOSABLE)


def test_only_starts_that_can_be_used_are_offered(recorded: Recorded) -> None:
    assert recorded.repository.health(MOTOR).starts is None
    recorded.add(Operation.START, "a soft starter")
    assert recorded.repository.health(MOTOR).starts is None
    recorded.add(Operation.START)
    recorded.add(Operation.START)
    starts = recorded.repository.health(MOTOR).starts
    assert starts is not None
    assert (starts.number, starts.latest_ns) == (2, NOW_NS + 3 * SECOND_NS)


def test_a_motor_is_known_to_have_stood(recorded: Recorded) -> None:
    recorded.add(Operation.START)
    assert recorded.repository.condition(MOTOR).stood_ns is None
    recorded.add(Operation.NOT_RUNNING)
    recorded.add(Operation.RUNNING)
    assert recorded.repository.condition(MOTOR).stood_ns == NOW_NS + 2 * SECOND_NS


def test_retention_keeps_the_newest_starts(recorded: Recorded) -> None:
    old, kept = recorded.add(Operation.START), recorded.add(Operation.START)
    standing = recorded.add(Operation.NOT_RUNNING)
    refused = recorded.add(None)
    recorded.add(Operation.RUNNING)
    for says_nothing, deleted in ((True, {old, standing}), (False, {refused})):
        expired = ExpiredRecordings(
            RecordingState.DIAGNOSED,
            Verdict.UNDIAGNOSABLE,
            NOW_NS + 60 * SECOND_NS,
            Keeping(newest=1, starts=1),
            says_nothing=says_nothing,
        )
        before = {one.id for one in recorded.repository.recordings(limit=10).items}
        recorded.repository.forget_recordings(MOTOR, 10, expired=expired, reason="old", now_ns=NOW_NS)
        left = {one.id for one in recorded.repository.recordings(limit=10).items}
        assert before - left == deleted
        assert kept in left
