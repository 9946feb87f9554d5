"""The days of a motor's condition follow each fold, on both databases."""

from dataclasses import replace

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import ConditionDay, FoldInput, FoldResult
from service.storage.states import DeletedBy
from testing.service.following import PUMP, Recorder
from testing.service.observations import observation
from testing.service.plants import NOW_NS
from tests.service.storage.conditions.test_condition_rows import began, nothing_more

TODAY_NS = NOW_NS - NOW_NS % NANOSECONDS_PER_DAY
TOMORROW_NS = TODAY_NS + NANOSECONDS_PER_DAY


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    return Recorder(repository, store)


def told(fold: FoldInput, *levels: float) -> FoldResult:
    """A fold that says these levels from its records on."""
    result = nothing_more(fold)
    points = [replace(point, mu_f=level) for point, level in zip(result.points, levels, strict=True)]
    return replace(result, points=points)


def days(repository: Repository, from_ns: int = 0) -> tuple[ConditionDay, ...]:
    return repository.condition_days([PUMP], from_ns=from_ns).get(PUMP, ())


def test_a_day_has_the_levels_of_all_its_records(repository: Repository, recorder: Recorder) -> None:
    for hour in (0, 1, 24):
        recorder.record(observation(hour))
    fold = began(repository)
    assert repository.finish_fold(fold, told(fold, 0.25, 0.75, 0.002), now_ns=NOW_NS)
    assert days(repository) == (
        ConditionDay(TODAY_NS, 2, 0.25, 0.5, 0.75),
        ConditionDay(TOMORROW_NS, 1, 0.002, 0.002, 0.002),
    )
    assert [day.day_ns for day in days(repository, NOW_NS + NANOSECONDS_PER_DAY)] == [TOMORROW_NS]
    assert repository.condition_days(["FAN-A2"], from_ns=0) == {}


def test_a_fold_of_the_latest_records_leaves_the_days_before(
    repository: Repository, recorder: Recorder
) -> None:
    recorder.record(observation(0))
    recorder.record(observation(24))
    fold = began(repository)
    repository.finish_fold(fold, told(fold, 0.001, 0.002), now_ns=NOW_NS)
    recorder.record(observation(25))
    fold = began(repository)
    assert len(fold.observations) == 1
    repository.finish_fold(fold, told(fold, 0.006), now_ns=NOW_NS)
    assert [(day.records, day.mu_f_largest) for day in days(repository)] == [(1, 0.001), (2, 0.006)]


def test_a_fold_in_pieces_ends_with_the_same_days(repository: Repository, recorder: Recorder) -> None:
    for hour in (0, 1, 24, 25):
        recorder.record(observation(hour))
    pieces = 0
    while (fold := repository.begin_fold(PUMP, 1)) is not None:
        repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
        pieces += 1
    assert pieces == 4
    assert [day.records for day in days(repository)] == [2, 2]


def test_a_deleted_record_leaves_its_day(repository: Repository, recorder: Recorder) -> None:
    recorder.record(observation(0))
    gone = recorder.record(observation(24))
    fold = began(repository)
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    assert len(days(repository)) == 2
    repository.delete_recording(gone, "of another motor", now_ns=NOW_NS, deleted_by=DeletedBy.PERSON)
    fold = began(repository)
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    assert [day.day_ns for day in days(repository)] == [TODAY_NS]
