"""Observations, events and conditions in the database, on both databases."""

from dataclasses import replace
from math import nan

import pytest
from sqlalchemy import Engine

from core.condition.events import Event, EventKind
from core.condition.kinds import Kind, State
from core.condition.observation import VoltageChannels
from service.plant import Bus, Plant
from service.recording_store.store import RecordingStore
from service.storage import NotFoundError, Repository
from service.storage.errors import UnstorableDiagnosisError
from service.storage.records import (
    SERVICE,
    Checkpoint,
    ConditionChange,
    ConditionEntry,
    ConditionPoint,
    FoldInput,
    FoldResult,
)
from service.storage.states import DeletedBy
from testing.service.conditions import HEALTHY
from testing.service.following import FAN, PUMP, Recorder, on_one_bus
from testing.service.observations import HOUR_NS, OBSERVATION, observation
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    return Recorder(repository, store)


def began(repository: Repository, motor: str = PUMP, most: int = 100) -> FoldInput:
    fold = repository.begin_fold(motor, most)
    assert fold is not None
    return fold


def nothing_more(fold: FoldInput) -> FoldResult:
    """A fold that leaves a checkpoint at each of its records, and says the motor is healthy."""
    points = [
        ConditionPoint(
            recording_id=one.recording_id,
            time_ns=one.observation.time_ns,
            state=State.HEALTHY,
            kind=Kind.NONE,
            mu_f=0.001,
            mu_f_ci95_low=-0.001,
            mu_f_ci95_high=0.003,
        )
        for one in fold.observations
    ]
    records = 0 if fold.checkpoint is None else fold.checkpoint.records
    checkpoints = [
        Checkpoint(point.time_ns, records + number, f"up to {point.time_ns}".encode(), {})
        for number, point in enumerate(points, start=1)
    ]
    if fold.events and checkpoints:  # the last one is of all that was folded
        checkpoints[-1] = replace(
            checkpoints[-1], time_ns=max(checkpoints[-1].time_ns, fold.events[-1].time_ns)
        )
    condition = ConditionEntry(
        motor=fold.motor,
        version=0,
        state=State.HEALTHY,
        kind=Kind.NONE,
        since_ns=None,
        as_of_ns=points[-1].time_ns if points else None,
        document=replace(HEALTHY, motor=fold.motor).as_dict(),
    )
    return FoldResult(
        points, [], checkpoints, tuple(fold.earlier), condition if fold.next_ns is None else None
    )


def test_an_observation_is_kept_with_every_bit(repository: Repository, recorder: Recorder) -> None:
    delta = replace(
        OBSERVATION,
        zero_voltage_V=None,
        voltage_channels=VoltageChannels.TWO_LINES,
        load_level=None,
        scatter=1.0 / 3.0 * 1e-9,
        positive_voltage_V=complex(325.0 / 3.0, -1e-17),
    )
    ids = {recorder.record(one): one for one in (OBSERVATION, delta)}
    for recording_id, observed in ids.items():
        found = repository.observation(recording_id)
        assert found is not None
        assert (found.motor, found.observation) == (PUMP, observed)
    assert repository.observation(recorder.record(None)) is None
    assert repository.motors_to_fold() == (PUMP,)


def test_an_observation_that_is_no_number_is_refused(recorder: Recorder) -> None:
    with pytest.raises(UnstorableDiagnosisError, match="scatter is nan, no finite number"):
        recorder.record(replace(OBSERVATION, scatter=nan))


def test_every_motor_has_a_condition_from_the_first(repository: Repository) -> None:
    assert repository.condition(PUMP) == ConditionEntry(
        motor=PUMP,
        version=0,
        state=State.UNKNOWN,
        kind=Kind.NONE,
        since_ns=None,
        as_of_ns=None,
        document=None,
    )
    assert set(repository.conditions()) == {PUMP, FAN}
    assert set(repository.conditions([FAN, "NO-SUCH"])) == {FAN}
    assert repository.begin_fold(PUMP, 10) is None
    for ask in (repository.condition, lambda motor: repository.condition_history(motor, limit=1)):
        with pytest.raises(NotFoundError, match="motor 'NO-SUCH'"):
            ask("NO-SUCH")


def test_a_fold_is_kept_and_its_marks_are_gone(repository: Repository, recorder: Recorder) -> None:
    second, first = recorder.record(observation(1)), recorder.record(observation(0))
    fold = began(repository)
    assert [one.recording_id for one in fold.observations] == [first, second]
    assert (fold.checkpoint, fold.next_ns, fold.latest_change) == (None, None, None)
    change = ConditionChange(
        motor=PUMP,
        time_ns=NOW_NS,
        recording_id=first,
        event_id=None,
        state=State.HEALTHY,
        kind=Kind.NONE,
    )
    assert repository.finish_fold(fold, replace(nothing_more(fold), changes=[change]), now_ns=NOW_NS)
    condition = repository.condition(PUMP)
    assert (condition.version, condition.state, condition.as_of_ns) == (1, "healthy", NOW_NS + HOUR_NS)
    assert condition.document is not None
    assert condition.document["finding"] == "no shorted turns"
    assert repository.condition_history(PUMP, limit=10).items == (change,)
    points = repository.condition_trend(PUMP, limit=10).items
    assert [point.recording_id for point in points] == [first, second]
    assert points[0].mu_f_ci95 == (-0.001, 0.003)
    assert repository.motors_to_fold() == ()
    assert repository.begin_fold(PUMP, 10) is None


def test_a_fold_goes_on_from_the_last_checkpoint_before_what_changed(
    repository: Repository, recorder: Recorder
) -> None:
    ids = [recorder.record(observation(hour)) for hour in range(4)]
    fold = began(repository)
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    recorder.record(observation(4))
    fold = began(repository)
    assert fold.checkpoint == Checkpoint(
        NOW_NS + 3 * HOUR_NS, 4, f"up to {NOW_NS + 3 * HOUR_NS}".encode(), {}
    )
    assert [one.observation.time_ns for one in fold.observations] == [NOW_NS + 4 * HOUR_NS]
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    late = recorder.record(observation(1.5))
    fold = began(repository)
    assert fold.checkpoint is not None
    assert (fold.checkpoint.time_ns, len(fold.observations)) == (NOW_NS + HOUR_NS, 4)
    assert repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    assert [one.records for one in repository.checkpoints(PUMP)] == [1, 2, 3, 4, 5, 6]

    repository.delete_recording(late, "of another motor", now_ns=NOW_NS)
    fold = began(repository)
    assert [one.recording_id for one in fold.observations][:2] == ids[2:]
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    recorder.diagnose_again(ids[1], observation(1, 0.5j))
    fold = began(repository)
    assert fold.checkpoint is not None
    assert fold.checkpoint.time_ns == NOW_NS
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    recorder.diagnose_again(ids[1], observation(1, 0.5j))
    assert repository.begin_fold(PUMP, 10) is None, "it tells the same"

    recorder.diagnose_again(ids[0], None)
    fold = began(repository)
    assert fold.checkpoint is None
    assert [one.recording_id for one in fold.observations][:2] == ids[1:3]

    event = Event(NOW_NS + 3 * HOUR_NS, EventKind.MAINTENANCE, "new bearing")
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    kept = repository.add_event(PUMP, event, by=SERVICE, now_ns=NOW_NS)
    fold = began(repository)
    assert fold.checkpoint is not None
    assert fold.checkpoint.time_ns == NOW_NS + 2 * HOUR_NS
    assert fold.events == (kept,)
    assert kept.event == event
    assert repository.events(PUMP, limit=10).items == (kept,)


def test_a_long_fold_is_done_in_parts(repository: Repository, recorder: Recorder) -> None:
    hours = (0, 1, 1, 1, 2)
    for number, hour in enumerate(hours):
        recorder.record(observation(hour, complex(number)))  # of one time, and yet no copies
    event = Event(NOW_NS + HOUR_NS + 1, EventKind.REWOUND)
    repository.add_event(PUMP, event, by=SERVICE, now_ns=NOW_NS)
    parts = []
    while (fold := repository.begin_fold(PUMP, 2)) is not None:
        parts.append([one.observation.time_ns for one in fold.observations])
        assert len(fold.events) == (fold.next_ns == NOW_NS + 2 * HOUR_NS)
        result = nothing_more(fold)
        assert repository.finish_fold(
            fold, replace(result, checkpoints=result.checkpoints[-1:]), now_ns=NOW_NS
        )
        assert (repository.condition(PUMP).document is None) == (fold.next_ns is not None)
    assert parts == [[NOW_NS + hour * HOUR_NS for hour in part] for part in ((0,), (1, 1, 1), (2,))]
    assert [one.records for one in repository.checkpoints(PUMP)] == [1, 4, 5]


def test_the_slower_of_two_folds_is_not_kept(repository: Repository, recorder: Recorder) -> None:
    recorder.record(observation(0))
    slow, quick = began(repository), began(repository)
    recorder.record(observation(-1))
    assert repository.finish_fold(quick, nothing_more(quick), now_ns=NOW_NS)
    assert not repository.finish_fold(slow, nothing_more(slow), now_ns=NOW_NS)
    assert repository.condition(PUMP).version == 1
    again = began(repository)
    assert len(again.observations) == 2, "what came meanwhile is folded with what comes after it"


def test_records_of_a_bus_at_about_the_same_time_are_neighbours(
    repository: Repository, recorder: Recorder, engine: Engine
) -> None:
    repository.sync_plant(on_one_bus())
    for hour in (0, 1):
        recorder.record(observation(hour))
    fold = began(repository)
    assert fold.neighbours == ()
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    after = replace(observation(1), time_ns=NOW_NS + HOUR_NS + 59 * SECOND_NS)
    neighbour = recorder.record(after, FAN)
    assert repository.motors_to_fold() == (FAN, PUMP), "what the neighbour saw at that time counts"
    fold = began(repository)
    assert fold.checkpoint is not None
    assert fold.checkpoint.time_ns == NOW_NS
    assert [one.recording_id for one in fold.neighbours] == [neighbour]
    assert [one.motor for one in began(repository, FAN).neighbours] == [PUMP]
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)

    recorder.record(replace(after, time_ns=after.time_ns + 90 * SECOND_NS), FAN)
    assert repository.motors_to_fold() == (FAN,), "this was too late to see the same"
    repository.delete_recording(neighbour, "of another motor", now_ns=NOW_NS)
    assert repository.motors_to_fold() == (FAN, PUMP)


def test_a_rule_of_retention_leaves_what_a_recording_told(repository: Repository, recorder: Recorder) -> None:
    kept, deleted = recorder.record(observation(0)), recorder.record(observation(1))
    fold = began(repository)
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    for recording_id, deleted_by in ((kept, DeletedBy.RETENTION), (deleted, DeletedBy.PERSON)):
        repository.delete_recording(recording_id, "old", now_ns=NOW_NS, deleted_by=deleted_by)
    assert repository.observation(kept) is not None
    assert repository.observation(deleted) is None
    assert len(began(repository).observations) == 0
    assert [point.recording_id for point in repository.condition_trend(PUMP, limit=10).items] == [kept]


def test_motors_of_a_bus_that_another_joins_are_folded_anew(
    repository: Repository, recorder: Recorder
) -> None:
    plant = two_motor_plant()
    for motor in (PUMP, FAN):
        recorder.record(observation(0), motor)
        fold = began(repository, motor)
        repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    repository.sync_plant(plant)
    assert repository.motors_to_fold() == ()
    repository.sync_plant(on_buses(plant, {PUMP: "A", FAN: "B"}))
    together = on_buses(plant, {PUMP: "A", FAN: "A"})
    for motor in (PUMP, FAN):
        fold = began(repository, motor)
        assert fold.neighbours == ()
        repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    repository.sync_plant(together)
    assert repository.motors_to_fold() == (FAN, PUMP)
    for motor, other in ((PUMP, FAN), (FAN, PUMP)):
        fold = began(repository, motor)
        assert fold.checkpoint is None
        assert [one.motor for one in fold.neighbours] == [other]
        repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    repository.sync_plant(together)
    assert repository.motors_to_fold() == ()
    one_transformer = replace(together, buses=(Bus("A", (PUMP, FAN), common_voltage_transformer=True),))
    repository.sync_plant(one_transformer)
    assert repository.motors_to_fold() == (FAN, PUMP), "they have nothing to compare any more"
    for motor in (PUMP, FAN):
        fold = began(repository, motor)
        assert fold.neighbours == ()
        repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    repository.sync_plant(one_transformer)
    assert repository.motors_to_fold() == (), "nothing has changed"


def on_buses(plant: Plant, buses: dict[str, str]) -> Plant:
    return replace(plant, motors=tuple(replace(one, bus=buses[one.name]) for one in plant.motors))


def test_the_others_of_a_bus_are_judged_anew_where_the_standing_asymmetry_has_really_changed(
    repository: Repository, recorder: Recorder
) -> None:
    repository.sync_plant(on_one_bus())
    estimate = {
        "sequence": "abc",
        "asymmetry": [1e-3, 2e-3],
        "covariance": [[1e-8, 0.0], [0.0, 1e-8]],
        "channels": [[1e-5, 0.0], [0.0, 1e-5]],
        "others": 1,
    }
    recorder.record(observation(0), FAN)
    fold = began(repository, FAN)
    repository.finish_fold(fold, nothing_more(fold), now_ns=NOW_NS)
    # The third differs little from the second, and much from the one that the fan was judged with.
    for hour, (asymmetry, marked) in enumerate([(1e-3, True), (1.015e-3, False), (1.03e-3, True)], start=1):
        recorder.record(observation(hour))
        fold = began(repository)
        now = {**estimate, "asymmetry": [asymmetry, 2e-3]}
        repository.finish_fold(fold, replace(nothing_more(fold), standing=now), now_ns=NOW_NS)
        assert repository.motors_to_fold() == ((FAN,) if marked else ())
        while (fan := repository.begin_fold(FAN, 10)) is not None:
            assert fan.bus[0].standing is not None
            assert fan.bus[0].standing["asymmetry"] == [asymmetry, 2e-3]
            repository.finish_fold(fan, nothing_more(fan), now_ns=NOW_NS)
