"""One event in several files counts once in its motor's condition, by the finest of them."""

from dataclasses import replace

import pytest

from core.condition.copies import Outline
from core.condition.observation import Observation
from core.recordings.fidelity import Fidelity
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.errors import UnusableBaselineError
from service.storage.records.actors import SERVICE
from service.storage.states import DeletedBy, RecordingState
from testing.service.following import FAN, PUMP, Recorder, fold_all
from testing.service.plants import NOW_NS
from testing.service.rotor_and_supply import SOUND_ROTOR
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


def outline(observation: Observation, fidelity: Fidelity = Fidelity.BINARY) -> Outline:
    amps, volts = abs(observation.positive_current_A), abs(observation.positive_voltage_V)
    return Outline(observation.time_ns, fidelity, (amps, amps, 1.03 * amps), (volts,) * 3)


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    return Recorder(repository, store)


def record(recorder: Recorder, seen: Observation, fidelity: Fidelity, motor: str = PUMP) -> str:
    return recorder.record(seen, motor, outline=outline(seen, fidelity))


def folded(repository: Repository, motor: str = PUMP) -> list[str]:
    fold_all(repository)
    return [point.recording_id for point in repository.condition_trend(motor, limit=9).items]


def test_a_coarser_copy_is_named_and_does_not_count(repository: Repository, recorder: Recorder) -> None:
    first, event, last = (record(recorder, one, Fidelity.BINARY) for one in RECORDS[:3])
    copy = record(recorder, as_text(EVENT), Fidelity.TEXT)
    assert folded(repository) == [first, event, last]
    kept = repository.recording(copy)
    assert (kept.state, kept.copy_of) == (RecordingState.DIAGNOSED, event)
    assert kept.reason == f"a copy of recording E ({event}): the same event, which counts once"
    assert repository.recording(event).reason is None
    assert [one.id for one in repository.copies_of(event)] == [copy]
    with pytest.raises(UnusableBaselineError, match=f"it is a copy: take recording {event}"):
        repository.set_baseline(PUMP, [copy], by=SERVICE, now_ns=NOW_NS)


def test_a_finer_copy_that_comes_later_counts_in_its_place(
    repository: Repository, recorder: Recorder
) -> None:
    text = record(recorder, as_text(EVENT), Fidelity.TEXT)
    assert folded(repository) == [text]
    binary = record(recorder, EVENT, Fidelity.BINARY)
    assert folded(repository) == [binary]
    fine = record(recorder, EVENT, Fidelity.FLOAT)
    assert folded(repository) == [fine]
    assert {repository.recording(one).copy_of for one in (text, binary)} == {fine}
    assert {one.id for one in repository.copies_of(fine)} == {text, binary}
    assert repository.observation(text) is None
    assert repository.condition(PUMP).document is not None


def test_of_copies_as_fine_the_first_counts_whichever_is_diagnosed_again(
    repository: Repository, recorder: Recorder
) -> None:
    event, copy = (record(recorder, EVENT, Fidelity.BINARY) for _ in range(2))
    recorder.diagnose_again(event, EVENT, outline(EVENT))
    recorder.diagnose_again(copy, EVENT, outline(EVENT))
    assert folded(repository) == [event]
    assert repository.recording(copy).copy_of == event


def test_another_waveform_or_another_motor_is_another_event(
    repository: Repository, recorder: Recorder
) -> None:
    other = replace(EVENT, positive_current_A=1.01 * EVENT.positive_current_A)
    ids = {record(recorder, one, Fidelity.BINARY) for one in (EVENT, other)}
    elsewhere = record(recorder, as_text(EVENT), Fidelity.TEXT, FAN)
    assert set(folded(repository)) == ids
    assert folded(repository, FAN) == [elsewhere]


def test_where_the_counted_one_is_deleted_the_finest_copy_takes_its_place(
    repository: Repository, recorder: Recorder
) -> None:
    text = record(recorder, as_text(EVENT), Fidelity.TEXT)
    fine = record(recorder, EVENT, Fidelity.FLOAT)
    binary = record(recorder, EVENT, Fidelity.BINARY)
    repository.delete_recording(fine, "of another motor", now_ns=NOW_NS)
    assert folded(repository) == []
    for _ in range(2):  # which of both is diagnosed first does not matter
        claimed = recorder.claim()
        is_text = claimed.job.recording_id == text
        seen = as_text(EVENT) if is_text else EVENT
        recorder.finish(claimed, seen, outline(seen, Fidelity.TEXT if is_text else Fidelity.BINARY))
    assert folded(repository) == [binary]
    assert repository.recording(text).copy_of == binary


def test_a_counted_one_that_a_rule_deletes_counts_on(repository: Repository, recorder: Recorder) -> None:
    fine = record(recorder, EVENT, Fidelity.FLOAT)
    copy = record(recorder, as_text(EVENT), Fidelity.TEXT)
    repository.delete_recording(fine, "30 days", now_ns=NOW_NS, deleted_by=DeletedBy.RETENTION)
    recorder.diagnose_again(copy, as_text(EVENT), outline(as_text(EVENT), Fidelity.TEXT))
    late = record(recorder, EVENT, Fidelity.FLOAT)
    assert folded(repository) == [fine]
    assert {repository.recording(one).copy_of for one in (copy, late)} == {fine}


def test_one_that_turns_out_to_be_another_event_lets_its_copies_go(
    repository: Repository, recorder: Recorder
) -> None:
    event = record(recorder, EVENT, Fidelity.BINARY)
    copy = record(recorder, as_text(EVENT), Fidelity.TEXT)
    other = replace(EVENT, positive_current_A=1.01 * EVENT.positive_current_A)
    recorder.diagnose_again(event, other, outline(other))
    recorder.diagnose(as_text(EVENT), outline(as_text(EVENT), Fidelity.TEXT))
    assert set(folded(repository)) == {event, copy}
    assert repository.recording(copy).copy_of is None


def test_a_copy_tells_nothing_of_rotor_or_starts_either(repository: Repository, recorder: Recorder) -> None:
    text = recorder.record(None, outline=outline(EVENT, Fidelity.TEXT), rotor=SOUND_ROTOR)
    fine = recorder.record(None, outline=outline(EVENT, Fidelity.FLOAT), rotor=SOUND_ROTOR)
    assert [one.recording_id for one in repository.latest_rotor_findings(PUMP, limit=9)] == [fine]
    assert repository.recording(text).copy_of == fine
