"""Which recordings of an archive are diagnosed again."""

import pytest

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records.actors import SERVICE
from service.storage.states import JobState
from testing.service.diagnosed import add_diagnosed
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, healthy

MOTOR = "PUMP-A1"
METHOD, MODEL, OTHER = "evidence", "coil", "shorted-winding"

BOTH = pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)


@pytest.fixture
def recordings(repository: Repository, store: RecordingStore) -> list[str]:
    """Three recordings, diagnosed a second apart from NOW_NS on by the default method and model."""
    return [
        add_diagnosed(repository, store, healthy(), NOW_NS + k * SECOND_NS, name=f"E{k}") for k in range(3)
    ]


def to_do(repository: Repository, model: str = MODEL, made_before_ns: int = 0) -> tuple[int, int]:
    return repository.repetitions_to_do(MOTOR, method=METHOD, model=model, made_before_ns=made_before_ns)


@BOTH
def test_what_is_made_in_this_way_is_done(repository: Repository, recordings: list[str]) -> None:
    assert to_do(repository) == (0, 3)
    assert to_do(repository, OTHER) == (3, 3)
    assert to_do(repository, made_before_ns=NOW_NS + SECOND_NS) == (1, 3)


@pytest.mark.usefixtures("recordings")
def test_what_was_made_before_the_parameters_changed_is_to_do(repository: Repository) -> None:
    document = {
        "nameplate": {},
        "parameters": {"stator_resistance_ohm": 8.4},
        "tolerances": {"source": "given"},
        "sensors": {},
        "limits": {},
    }
    edited = document | {"parameters": {"stator_resistance_ohm": 8.5}}
    repository.note_motors({MOTOR: document}, now_ns=NOW_NS)
    assert to_do(repository) == (0, 3)
    repository.note_motors({MOTOR: edited}, now_ns=NOW_NS + 2 * SECOND_NS)
    assert to_do(repository) == (2, 3), "the third began when the new ones were known"


def test_what_was_made_before_the_baseline_is_to_do(repository: Repository, recordings: list[str]) -> None:
    chosen_ns = NOW_NS + SECOND_NS
    repository.set_baseline(MOTOR, recordings[:1], by=SERVICE, reason="new bearings", now_ns=chosen_ns)
    assert to_do(repository) == (1, 3)
    repository.delete_baseline(MOTOR, by=SERVICE, now_ns=NOW_NS + 9 * SECOND_NS)
    assert to_do(repository) == (3, 3)


@BOTH
def test_no_recording_is_queued_twice(repository: Repository, recordings: list[str]) -> None:
    wanted = {"method": METHOD, "model": OTHER, "by": SERVICE, "now_ns": NOW_NS + 60 * SECOND_NS}
    first = repository.repeat_diagnoses(MOTOR, **wanted, limit=2)  # type: ignore[arg-type]
    rest = repository.repeat_diagnoses(MOTOR, **wanted, limit=2, after=first.next)  # type: ignore[arg-type]
    assert [job.recording_id for job in (*first.items, *rest.items)] == recordings
    again = repository.repeat_diagnoses(MOTOR, **wanted, limit=9)  # type: ignore[arg-type]
    assert again.items == (*first.items, *rest.items)
    assert again.next is None


def test_jobs_that_have_ended_are_told(repository: Repository, recordings: list[str]) -> None:
    now_ns = NOW_NS + 60 * SECOND_NS
    jobs = [repository.request_diagnosis(one, now_ns=now_ns) for one in recordings]
    claimed = repository.claim_job(now_ns=now_ns, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(healthy()), recorded_ns=NOW_NS, now_ns=now_ns, runner=RUNNER
    )
    ended = repository.ended_jobs([*(job.id for job in jobs), "deleted with its recording"])
    assert {id_: job and job.state for id_, job in ended.items()} == {
        claimed.job.id: JobState.DONE,
        "deleted with its recording": None,
    }
