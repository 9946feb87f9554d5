"""One event that a relay gave in two formats counts once in its motor's condition."""

from dataclasses import replace

from core.condition.observation import Observation
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import RecordingState
from testing.service.following import FAN, PUMP, Recorder, fold_all
from tests.service.condition.tasks import RECORDS

EVENT = RECORDS[1]


def as_text(observation: Observation) -> Observation:
    """What another format of the same record tells: the values have fewer digits."""
    return replace(
        observation,
        time_ns=observation.time_ns + 999,
        positive_current_A=observation.positive_current_A * (1.0 + 2e-5j),
        scatter=1.01 * observation.scatter,
    )


def folded(repository: Repository, motor: str = PUMP) -> list[str]:
    fold_all(repository)
    return [point.recording_id for point in repository.condition_trend(motor, limit=9).items]


def test_a_copy_is_named_and_does_not_count(repository: Repository, store: RecordingStore) -> None:
    recorder = Recorder(repository, store)
    first, event, last = recorder.record_all(RECORDS[:3])
    copy = recorder.record(as_text(EVENT))
    assert folded(repository) == [first, event, last]
    kept = repository.recording(copy)
    assert kept.state is RecordingState.DIAGNOSED
    assert kept.reason == f"a copy of recording E ({event}): the same event, which counts once"
    assert repository.recording(event).reason is None


def test_diagnosing_either_again_changes_nothing(repository: Repository, store: RecordingStore) -> None:
    recorder = Recorder(repository, store)
    event, copy = recorder.record(EVENT), recorder.record(as_text(EVENT))
    recorder.diagnose_again(event, EVENT)
    recorder.diagnose_again(copy, as_text(EVENT))
    assert folded(repository) == [event]


def test_another_waveform_or_another_motor_is_another_event(
    repository: Repository, store: RecordingStore
) -> None:
    recorder = Recorder(repository, store)
    other = replace(EVENT, positive_current_A=1.01 * EVENT.positive_current_A)
    ids = {recorder.record(EVENT), recorder.record(other)}
    elsewhere = recorder.record(as_text(EVENT), FAN)
    assert set(folded(repository)) == ids
    assert folded(repository, FAN) == [elsewhere]
