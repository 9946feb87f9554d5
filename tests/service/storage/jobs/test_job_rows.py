from dataclasses import replace
from functools import partial
from typing import TypedDict

import pytest

from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository, StateConflictError
from service.storage.errors import RunnerEndedError, UnstorableDiagnosisError
from service.storage.records import ClaimedJob, RemoteRecord
from service.storage.states import JobState, RecordingRequestState, RecordingState
from service.timing.backoff import Backoff
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable


class Again(TypedDict):
    max_attempts: int
    backoff: Backoff


AGAIN = Again(max_attempts=3, backoff=Backoff(first_s=2.0, longest_s=60.0))


@pytest.fixture
def recording_id(repository: Repository, store: RecordingStore) -> str:
    stored = store.store({"E.CFF": b"samples"})
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    added = repository.add_recording(
        stored,
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=RemoteRecord("E", 7, 0),
        recording_request_id=request.id,
        now_ns=NOW_NS,
    )
    return added.recording.id


def claim(repository: Repository, now_ns: int = NOW_NS) -> ClaimedJob:
    claimed = repository.claim_job(now_ns=now_ns, runner=RUNNER)
    assert claimed is not None
    return claimed


def request_state(repository: Repository) -> tuple[RecordingRequestState, str | None]:
    (request,) = repository.recording_requests(limit=10).items
    return request.state, request.reason


def test_a_job_is_claimed_once(repository: Repository, recording_id: str) -> None:
    claimed = claim(repository)
    assert (claimed.job.state, claimed.job.attempts, claimed.job.recording_id) == ("running", 1, recording_id)
    assert repository.claim_job(now_ns=NOW_NS, runner=RUNNER) is None


def test_a_clock_that_is_set_back_holds_up_no_job(repository: Repository, recording_id: str) -> None:
    an_hour_ago_ns = NOW_NS - 3600 * SECOND_NS
    first = claim(repository, now_ns=an_hour_ago_ns)
    repository.retry_or_fail_job(first.job.id, "broken", now_ns=NOW_NS, runner=RUNNER, **AGAIN)
    assert repository.claim_job(now_ns=NOW_NS + SECOND_NS, runner=RUNNER) is None, "it is tried again later"
    second = claim(repository, now_ns=an_hour_ago_ns + SECOND_NS)
    assert (second.job.id, second.job.finished_ns) == (first.job.id, None)


def test_a_result_ends_job_recording_and_request(repository: Repository, recording_id: str) -> None:
    job_id = claim(repository).job.id
    for _ in range(2):
        repository.finish_job(
            job_id,
            findings_of(fault()),
            recorded_ns=NOW_NS - SECOND_NS,
            now_ns=NOW_NS + SECOND_NS,
            runner=RUNNER,
        )
    assert repository.job(recording_id, job_id).job.state is JobState.DONE
    recording = repository.recording(recording_id)
    assert (recording.state, recording.recorded_ns) == (RecordingState.DIAGNOSED, NOW_NS - SECOND_NS)
    assert request_state(repository) == (RecordingRequestState.DIAGNOSED, None)
    diagnosis = repository.current_diagnosis(recording_id)
    assert diagnosis is not None
    assert diagnosis.document == findings_of(fault()).as_dict()
    assert diagnosis == repository.job(recording_id, job_id).diagnosis
    assert len(repository.trend("PUMP-A1", "mu_f", limit=10).items) == 1


def test_an_unreadable_record_is_rejected_with_the_reason(repository: Repository, recording_id: str) -> None:
    repository.reject_recording(claim(repository).job.id, "E.CFF: checksum", now_ns=NOW_NS, runner=RUNNER)
    recording = repository.recording(recording_id)
    assert (recording.state, recording.reason) == (RecordingState.REJECTED, "E.CFF: checksum")
    assert request_state(repository) == (RecordingRequestState.FAILED, "E.CFF: checksum")
    assert repository.claim_job(now_ns=NOW_NS + 1000 * SECOND_NS, runner=RUNNER) is None


def test_an_error_is_retried_later_and_given_up_at_last(repository: Repository, recording_id: str) -> None:
    now_ns = NOW_NS
    for delay_s in (2, 4):
        job_id = claim(repository, now_ns).job.id
        assert (
            repository.retry_or_fail_job(job_id, "killed", now_ns=now_ns, runner=RUNNER, **AGAIN)
            is JobState.QUEUED
        )
        assert repository.claim_job(now_ns=now_ns + delay_s * SECOND_NS - 1, runner=RUNNER) is None
        now_ns += delay_s * SECOND_NS
    job_id = claim(repository, now_ns).job.id
    assert (
        repository.retry_or_fail_job(job_id, "killed", now_ns=now_ns, runner=RUNNER, **AGAIN)
        is JobState.FAILED
    )
    reason = "gave up after 3 attempts: killed"
    assert repository.recording(recording_id).state is RecordingState.FAILED
    assert request_state(repository) == (RecordingRequestState.FAILED, reason)
    assert (
        repository.retry_or_fail_job(job_id, "again", now_ns=now_ns, runner=RUNNER, **AGAIN)
        is JobState.FAILED
    )


def register(repository: Repository, runner: str, installation: str = "ours") -> int:
    return repository.register_runner(runner, installation=installation, now_ns=NOW_NS, max_attempts=3)


def test_interrupted_jobs_are_queued_again_but_not_for_ever(
    repository: Repository, recording_id: str
) -> None:
    assert register(repository, "start 0") == 0
    for start in range(3):
        assert repository.claim_job(now_ns=NOW_NS, runner=f"start {start}") is not None
        assert register(repository, f"start {start + 1}") == 1
    assert repository.claim_job(now_ns=NOW_NS, runner="start 3") is None
    assert repository.recording(recording_id).state is RecordingState.FAILED
    assert register(repository, "start 4") == 0


def test_a_start_leaves_the_jobs_of_other_installations_alone(
    repository: Repository, recording_id: str
) -> None:
    register(repository, "theirs", "elsewhere")
    claimed = repository.claim_job(now_ns=NOW_NS, runner="theirs")
    assert claimed is not None
    assert register(repository, "ours") == 0
    assert repository.claim_job(now_ns=NOW_NS, runner="ours") is None
    assert repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner="theirs"
    )


def test_what_a_runner_without_its_lease_brings_is_not_kept(
    repository: Repository, recording_id: str
) -> None:
    register(repository, "theirs", "elsewhere")
    register(repository, "ours")
    claimed = repository.claim_job(now_ns=NOW_NS, runner="theirs")
    assert claimed is not None
    seen = repository.renew_runner("ours")["theirs"]
    repository.renew_runner("theirs")
    end = partial(repository.end_runner, "theirs", now_ns=NOW_NS, max_attempts=3)
    assert not end(renewals=seen), "it has renewed its lease since"
    assert end(renewals=seen + 1)
    with pytest.raises(RunnerEndedError):
        repository.renew_runner("theirs")
    with pytest.raises(RunnerEndedError):
        repository.claim_job(now_ns=NOW_NS, runner="theirs")
    for taken_over in (False, True):
        if taken_over:
            assert repository.claim_job(now_ns=NOW_NS, runner="ours") is not None
        job_id = claimed.job.id
        before = repository.job(recording_id, job_id)
        late = partial(
            repository.finish_job, job_id, findings_of(fault(0.9)), recorded_ns=NOW_NS, now_ns=NOW_NS
        )
        assert not late(runner="theirs")
        repository.reject_recording(job_id, "late", now_ns=NOW_NS, runner="theirs")
        repository.retry_or_fail_job(job_id, "late", now_ns=NOW_NS, runner="theirs", **AGAIN)
        repository.release_job(job_id, runner="theirs")
        assert repository.job(recording_id, job_id) == before
    assert repository.finish_job(
        job_id, findings_of(fault(0.05)), recorded_ns=NOW_NS, now_ns=NOW_NS, runner="ours"
    )
    (point,) = repository.trend("PUMP-A1", "mu_f", limit=10).items
    assert point.value == 0.05


def test_a_released_job_has_lost_no_attempt(repository: Repository, recording_id: str) -> None:
    repository.release_job(claim(repository).job.id, runner=RUNNER)
    assert claim(repository).job.attempts == 1


def test_the_latest_diagnosis_of_a_recording_counts(repository: Repository, recording_id: str) -> None:
    repository.finish_job(
        claim(repository).job.id, findings_of(fault(0.05)), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    job = repository.request_diagnosis(recording_id, method="genetic", now_ns=NOW_NS + 1)
    claimed = claim(repository, NOW_NS + 1)
    assert (claimed.job.id, claimed.job.method) == (job.id, "genetic")
    repository.finish_job(
        job.id, findings_of(fault(0.06)), recorded_ns=NOW_NS, now_ns=NOW_NS + 2, runner=RUNNER
    )
    (point,) = repository.trend("PUMP-A1", "mu_f", limit=10).items
    assert point.value == 0.06
    diagnosed = repository.jobs(recording_id, limit=10).items
    assert [one.job.method for one in diagnosed] == ["genetic", "evidence"]


def test_a_failed_repetition_leaves_the_earlier_diagnosis(repository: Repository, recording_id: str) -> None:
    repository.finish_job(
        claim(repository).job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    repository.request_diagnosis(recording_id, now_ns=NOW_NS)
    repository.reject_recording(claim(repository).job.id, "no longer readable", now_ns=NOW_NS, runner=RUNNER)
    assert repository.recording(recording_id).state is RecordingState.DIAGNOSED
    assert repository.current_diagnosis(recording_id) is not None


def test_only_a_stored_recording_can_be_diagnosed(repository: Repository) -> None:
    announced = repository.announce_recording("A1_SEL710", "PUMP-A1", RemoteRecord("X", 1, 1), now_ns=NOW_NS)
    with pytest.raises(StateConflictError, match="is announced and cannot become diagnosed"):
        repository.request_diagnosis(announced.id, now_ns=NOW_NS)
    with pytest.raises(NotFoundError):
        repository.job(announced.id, "nope")


def test_a_result_that_is_no_json_is_refused(repository: Repository, recording_id: str) -> None:
    job_id = claim(repository).job.id
    broken = replace(fault(), residual_rms_A=float("nan"))
    with pytest.raises(UnstorableDiagnosisError, match="not JSON compliant"):
        repository.finish_job(job_id, findings_of(broken), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER)
    assert repository.job(recording_id, job_id).job.state is JobState.RUNNING


def test_trend_and_health(repository: Repository, store: RecordingStore) -> None:
    for i, diagnosis in enumerate([fault(0.01), fault(0.02), undiagnosable()]):
        repository.add_recording(store.store({f"U{i}.CFF": bytes([i])}), motor="FAN-A2", now_ns=NOW_NS + i)
        job_id = claim(repository, NOW_NS + i).job.id
        repository.finish_job(
            job_id,
            findings_of(diagnosis),
            recorded_ns=NOW_NS + i * SECOND_NS,
            now_ns=NOW_NS + 9,
            runner=RUNNER,
        )
    points = repository.trend("FAN-A2", "mu_f", limit=10).items
    assert [(p.time_ns, p.value, str(p.verdict)) for p in points] == [
        (NOW_NS, 0.01, "fault"),
        (NOW_NS + SECOND_NS, 0.02, "fault"),
        (NOW_NS + 2 * SECOND_NS, None, "undiagnosable"),
    ]
    assert points[0].ci95 == pytest.approx((0.006, 0.014))
    assert points[0].scatter95 == pytest.approx((0.009, 0.011))
    assert [p.detection_limit for p in points] == [0.021, 0.021, None]
    assert [p.value for p in repository.trend("FAN-A2", "theta_f", limit=10).items] == [1, 1, None]
    window = repository.trend(
        "FAN-A2", "load_level", from_ns=NOW_NS + 1, to_ns=NOW_NS + 2 * SECOND_NS, limit=10
    )
    assert [(p.value, p.ci95) for p in window.items] == [(0.48, (0.46, 0.5))]
    first = repository.trend("FAN-A2", "mu_f", limit=2)
    rest = repository.trend("FAN-A2", "mu_f", limit=2, after=first.next)
    assert (first.items + rest.items, rest.next) == (points, None)

    health = repository.health("FAN-A2")
    assert health.diagnosis is not None
    assert health.last_recording is not None
    assert (str(health.diagnosis.verdict), health.last_recording.name) == ("undiagnosable", "U2")
    idle = repository.health("PUMP-A1")
    assert (idle.diagnosis, idle.last_recording, idle.ied.name) == (None, None, "A1_SEL710")
    counts = repository.counts()
    assert (counts.recordings, counts.jobs) == ({"diagnosed": 3}, {"done": 3})
    assert (counts.links, counts.recording_requests) == ({"unknown": 2}, {})


def test_records_of_relays_come_first_and_repetitions_last(
    repository: Repository, store: RecordingStore
) -> None:
    old = repository.add_recording(store.store({"OLD.CFF": b"old"}), motor="PUMP-A1", now_ns=NOW_NS)
    job_id = claim(repository).job.id
    repository.finish_job(job_id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER)
    for _ in range(3):
        repository.request_diagnosis(old.recording.id, now_ns=NOW_NS)
    uploaded = repository.add_recording(
        store.store({"UP.CFF": b"up"}), motor="PUMP-A1", now_ns=NOW_NS + 1
    ).recording
    fresh = repository.add_recording(
        store.store({"NEW.CFF": b"new"}),
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=RemoteRecord("NEW", 3, NOW_NS),
        now_ns=NOW_NS + 2,
    ).recording
    claimed = [claim(repository, NOW_NS + 3).job.recording_id for _ in range(5)]
    assert claimed == [fresh.id, uploaded.id, *[old.recording.id] * 3]


def test_the_last_recording_is_the_one_made_last(repository: Repository, store: RecordingStore) -> None:
    for number, recorded_ns in enumerate([NOW_NS, NOW_NS - 1000 * SECOND_NS]):
        stored = store.store({f"U{number}.CFF": bytes([number])})
        repository.add_recording(stored, motor="FAN-A2", now_ns=NOW_NS + number)
        job_id = claim(repository, NOW_NS + number).job.id
        repository.finish_job(
            job_id, findings_of(fault()), recorded_ns=recorded_ns, now_ns=NOW_NS + number, runner=RUNNER
        )
    last = repository.health("FAN-A2").last_recording
    assert last is not None
    assert last.name == "U0", "U1 was uploaded later, and was made before it"
    repository.add_recording(store.store({"U2.CFF": b"2"}), motor="FAN-A2", now_ns=NOW_NS + 2)
    last = repository.health("FAN-A2").last_recording
    assert last is not None
    assert last.name == "U2", "its own time is not known yet"
