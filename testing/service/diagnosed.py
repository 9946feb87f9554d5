"""Diagnosed recordings for tests, without a worker that diagnoses them."""

from core.condition.observation import Observation
from core.diagnosis.verdict import Diagnosis
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER


def add_diagnosed(
    repository: Repository,
    store: RecordingStore,
    diagnosis: Diagnosis,
    recorded_ns: int,
    *,
    motor: str = "PUMP-A1",
    name: str = "E1",
    observed: Observation | None = None,
) -> str:
    """Add a recording with its diagnosis, and what it tells, and return its id.

    RUNNER has to be registered.
    """
    stored = store.store({f"{name}.CFF": f"samples of {motor}, {name}, at {recorded_ns}".encode()})
    added = repository.add_recording(stored, motor=motor, now_ns=recorded_ns)
    claimed = repository.claim_job(now_ns=recorded_ns, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id,
        findings_of(diagnosis, observation=observed),
        recorded_ns=recorded_ns,
        now_ns=recorded_ns,
        runner=RUNNER,
    )
    return added.recording.id
