"""A motor's condition in the database is that of its records and events, in whatever order they came."""

import json
import os
import random
import signal
from collections.abc import Sequence
from dataclasses import replace
from multiprocessing import get_context

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.condition.events import Event, EventKind
from core.condition.following.follower import Follower
from core.condition.observation import Observation
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Motor, ParametersSource
from core.machines.stator_winding import StatorWinding, WindingKind
from core.machines.typical import TYPICAL_TOLERANCES, typical_parameters
from service.alarms.condition_rules import ConditionRules
from service.condition import worker
from service.condition.motor_data import document_of
from service.condition.worker import fold_due
from service.plant import Bus
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.models import ConditionCheckpointRow
from service.storage.records import SERVICE, FoldInput, FoldResult
from service.storage.repository.conditions.folding import FoldingRows
from testing.service.following import FAN, PUMP, Recorder, fold_all, note_motors, on_one_bus
from testing.service.observations import records_of_a_motor
from testing.service.plants import NOW_NS, SECOND_NS, motor

RECORDS = records_of_a_motor(30, fault_from=18)


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    note_motors(repository)
    return Recorder(repository, store)


def followed(records: Sequence[Observation], name: str = PUMP) -> Follower:
    """The core's own answer: all records folded at once."""
    follower = Follower(motor(name))
    for record in sorted(records, key=lambda record: record.time_ns):
        follower.fold(record)
    return follower


def require_same(repository: Repository, follower: Follower, of: Motor | None = None) -> None:
    """The condition in the database is the follower's, and so is the state that is gone on from."""
    assessment = follower.assessment()
    assert assessment is not None
    condition = condition_of(of or motor(PUMP), assessment, assessment.as_of_ns)
    found = repository.condition(PUMP)
    expected = condition.as_dict()
    assert found.document is not None
    assert json.dumps({name: found.document[name] for name in expected}) == json.dumps(expected)
    assert (found.state, found.kind, found.as_of_ns) == (condition.state, condition.kind, condition.as_of_ns)
    assert repository.checkpoints(PUMP)[-1].state == follower.save()


@pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)  # both in every run
def test_records_in_any_order_of_arrival_give_the_condition_of_all_at_once(
    repository: Repository, recorder: Recorder
) -> None:
    order = list(RECORDS)
    random.Random(7).shuffle(order)
    for some in (order[:1], order[1:4], order[4:15], order[15:29], order[29:]):
        recorder.record_all(some)
        fold_all(repository)
    require_same(repository, followed(RECORDS))
    points = repository.condition_trend(PUMP, limit=100).items
    assert [point.time_ns for point in points] == [record.time_ns for record in RECORDS]
    changes = repository.condition_history(PUMP, limit=100).items[::-1]
    said = {p.time_ns: (p.state, p.kind, p.phase, frozenset(p.candidates)) for p in points}
    assert len({kinds for *_, kinds in said.values()}) > 1
    assert [
        (one.time_ns, (one.state, one.kind, one.phase, frozenset(one.candidates))) for one in changes
    ] == [
        (time_ns, now)
        for (time_ns, now), before in zip(said.items(), [None, *said.values()], strict=False)
        if now != before
    ]


def test_a_recording_that_is_deleted_or_diagnosed_again_counts_no_more_as_it_was(
    repository: Repository, recorder: Recorder
) -> None:
    ids = recorder.record_all(RECORDS[:25])
    fold_all(repository)
    repository.delete_recording(ids[12], "of another motor", now_ns=NOW_NS)
    fold_all(repository)
    require_same(repository, followed([*RECORDS[:12], *RECORDS[13:25]]))
    other = replace(RECORDS[3], negative_voltage_V=1.5 + 0.5j)
    recorder.diagnose_again(ids[3], other)
    recorder.diagnose_again(ids[24], None)
    fold_all(repository)
    require_same(repository, followed([*RECORDS[:3], other, *RECORDS[4:12], *RECORDS[13:24]]))


def test_without_records_nothing_is_known(repository: Repository, recorder: Recorder) -> None:
    (only,) = recorder.record_all(RECORDS[:1])
    fold_all(repository)
    assert repository.condition(PUMP).state == "healthy"
    repository.delete_recording(only, "of another motor", now_ns=NOW_NS)
    repository.add_event(PUMP, Event(NOW_NS, EventKind.MAINTENANCE, "cleaned"), by=SERVICE, now_ns=NOW_NS)
    fold_all(repository)
    condition = repository.condition(PUMP)
    assert (condition.state, condition.as_of_ns) == ("unknown", None)
    assert condition.document is not None
    assert [change.state for change in repository.condition_history(PUMP, limit=10).items] == ["unknown"]


@pytest.mark.parametrize("kind", [EventKind.REWOUND, EventKind.MAINTENANCE])
def test_an_event_counts_from_its_time_and_is_in_the_history(
    repository: Repository, recorder: Recorder, kind: EventKind
) -> None:
    recorder.record_all(RECORDS)
    fold_all(repository)
    event = Event(RECORDS[22].time_ns, kind, "winding of phase b replaced")
    kept = repository.add_event(PUMP, event, by=SERVICE, now_ns=NOW_NS)
    fold_all(repository)
    follower = followed(RECORDS[:22])
    follower.apply(event)
    for record in RECORDS[22:]:
        follower.fold(record)
    require_same(repository, follower)
    history = repository.condition_history(PUMP, limit=100).items
    (noted,) = (one for one in history if one.event_id is not None)
    assert (noted.event_id, noted.recording_id, noted.state, noted.time_ns) == (
        kept.id,
        None,
        "unknown",
        event.time_ns,
    )


def edited(name: str = PUMP) -> Motor:
    plain = motor(name)
    return replace(plain, parameters=replace(plain.parameters, rotor_resistance_ohm=9.1))


def test_edited_parameters_are_an_event_and_count_from_then_on(
    repository: Repository, recorder: Recorder
) -> None:
    recorder.record_all(RECORDS[:20])
    fold_all(repository)
    now_ns = RECORDS[20].time_ns - SECOND_NS
    for _ in range(2):
        repository.note_motors({PUMP: document_of(edited())}, now_ns=now_ns)
    (event,) = repository.events(PUMP, limit=10).items
    old = motor(PUMP).parameters.rotor_resistance_ohm
    assert (event.kind, event.by, event.time_ns) == ("parameters-edited", "motors file", now_ns)
    assert event.reason == f"rotor_resistance_ohm 9.1 instead of {old}"
    recorder.record_all(RECORDS[20:])
    fold_all(repository, edited())
    follower = followed(RECORDS[:20])
    follower.apply(event.event, edited())
    for record in RECORDS[20:]:
        follower.fold(record)
    require_same(repository, follower, edited())

    recorder.record(
        replace(RECORDS[5], time_ns=RECORDS[5].time_ns + SECOND_NS)
    )  # late: the motor as it was then
    fold_all(repository, edited())
    late = followed([*RECORDS[:20], replace(RECORDS[5], time_ns=RECORDS[5].time_ns + SECOND_NS)])
    late.apply(event.event, edited())
    for record in RECORDS[20:]:
        late.fold(record)
    require_same(repository, late, edited())


def typical(name: str = PUMP) -> Motor:
    """The motor as it is before anybody has commissioned it."""
    plain = motor(name)
    return replace(
        plain,
        parameters=typical_parameters(plain.nameplate).parameters,
        parameters_source=ParametersSource.TYPICAL,
        tolerances=TYPICAL_TOLERANCES,
    )


def test_a_commissioned_motor_has_its_records_judged_again_from_the_first(
    repository: Repository, recorder: Recorder
) -> None:
    repository.note_motors({PUMP: document_of(typical())}, now_ns=NOW_NS)
    recorder.record_all(RECORDS[:17])
    fold_all(repository, typical())
    before = repository.condition(PUMP)
    assert before.state == "unknown"
    assert str((before.document or {})["advice"]).startswith("collecting; commission me")
    repository.note_motors({PUMP: document_of(motor(PUMP))}, now_ns=NOW_NS + 10**15)
    fold_all(repository)
    require_same(repository, followed(RECORDS[:17]))
    assert repository.condition(PUMP).state == "healthy"
    assert repository.events(PUMP, limit=10).items == ()


def test_another_class_of_the_sensors_has_always_been_so(repository: Repository, recorder: Recorder) -> None:
    recorder.record_all(RECORDS[:20])
    fold_all(repository)
    plain = motor(PUMP)
    better = replace(plain, sensors=replace(plain.sensors, voltage_gain=0.002))
    repository.note_motors({PUMP: document_of(better)}, now_ns=NOW_NS)
    fold_all(repository, better)
    follower = Follower(better)
    for record in RECORDS[:20]:
        follower.fold(record)
    require_same(repository, follower, better)
    assert repository.events(PUMP, limit=10).items == ()


def test_a_stator_winding_has_always_been_so(repository: Repository, recorder: Recorder) -> None:
    recorder.record_all(RECORDS[:20])
    fold_all(repository)
    told = replace(motor(PUMP), winding=StatorWinding(WindingKind.LAP, 24))
    other = replace(told, winding=StatorWinding(WindingKind.CONCENTRIC, 24, 1))
    for now in (told, other, motor(PUMP)):
        repository.note_motors({PUMP: document_of(now)}, now_ns=NOW_NS)
        assert repository.motors_to_fold() == (PUMP,)
        (version,) = repository.motor_versions(PUMP)
        assert version.document == document_of(now)
        fold_all(repository, now)
        follower = Follower(now)
        for record in RECORDS[:20]:
            follower.fold(record)
        require_same(repository, follower, now)
    assert repository.events(PUMP, limit=10).items == ()


def test_another_limit_counts_from_the_latest_record_on(repository: Repository, recorder: Recorder) -> None:
    recorder.record_all(RECORDS[:20])
    fold_all(repository)
    plain = motor(PUMP)
    stricter = replace(plain, limits=replace(plain.limits, fault_level=0.002))
    repository.note_motors({PUMP: document_of(stricter)}, now_ns=NOW_NS)
    assert repository.motors_to_fold() == (PUMP,)
    fold_all(repository, stricter)
    require_same(repository, followed(RECORDS[:20]), stricter)


def test_a_checkpoint_of_another_version_is_left_and_all_is_folded_anew(
    repository: Repository, recorder: Recorder, engine: Engine
) -> None:
    recorder.record_all(RECORDS[:20])
    fold_all(repository)
    with Session(engine) as session, session.begin():
        for row in session.query(ConditionCheckpointRow):
            row.state = b"of another version"
    recorder.record(RECORDS[20])
    fold_all(repository)
    require_same(repository, followed(RECORDS[:21]))


def killed(database_url: str, step: str) -> None:
    """Fold, and be killed before or after a part is kept, or within the transaction that keeps it."""
    worker.RECORDS_A_FOLD = 7
    finish = FoldingRows.finish_fold

    def finish_and_die(
        repository: FoldingRows, due: FoldInput, result: FoldResult, *, now_ns: int, rules: ConditionRules
    ) -> bool:
        if step == "before":
            os.kill(os.getpid(), signal.SIGKILL)
        if step == "within":
            result = replace(result, kept_checkpoints=_Deadly(result.kept_checkpoints))
        kept = finish(repository, due, result, now_ns=now_ns, rules=rules)
        os.kill(os.getpid(), signal.SIGKILL)
        return kept

    FoldingRows.finish_fold = finish_and_die  # type: ignore[assignment,method-assign]  # in a process of its own
    fold_due(Repository(connect(database_url)), motor(PUMP))


class _Deadly(list[int]):
    """Kills its process when it is read: after the points and the changes, before the checkpoints."""

    def __iter__(self):  # type: ignore[no-untyped-def]  # it returns nothing
        os.kill(os.getpid(), signal.SIGKILL)


def test_a_fold_that_is_killed_loses_nothing(
    repository: Repository, recorder: Recorder, database_url: str
) -> None:
    recorder.record_all(RECORDS)
    for number, step in enumerate(("before", "within", "after", "within", "after")):
        process = get_context("fork").Process(target=killed, args=(database_url, step))
        process.start()
        process.join(60)
        assert process.exitcode == -signal.SIGKILL
        parts_kept = ("before", "within", "after", "within", "after")[: number + 1].count("after")
        assert len(repository.condition_trend(PUMP, limit=100).items) == 7 * parts_kept
        assert repository.motors_to_fold() == (PUMP,)
    fold_all(repository)
    require_same(repository, followed(RECORDS))


def test_two_services_fold_the_same_motors(
    repository: Repository, recorder: Recorder, database_url: str
) -> None:
    """Each folds all there is, while records come in any order."""
    order = list(RECORDS)
    random.Random(3).shuffle(order)
    context = get_context("fork")
    end = context.Event()
    services = [context.Process(target=fold_until, args=(database_url, end)) for _ in range(2)]
    for service in services:
        service.start()
    try:
        recorder.record_all(order)
    finally:
        end.set()
    for service in services:
        service.join(60)
        assert service.exitcode == 0
    assert repository.motors_to_fold() == ()
    require_same(repository, followed(RECORDS))


def fold_until(database_url: str, end) -> None:  # type: ignore[no-untyped-def]  # multiprocessing's own event
    engine = connect(database_url)
    repository = Repository(engine)
    while not end.wait(0.01) or repository.motors_to_fold():
        fold_due(repository, motor(PUMP))
    engine.dispose()


def test_motors_of_a_bus_come_to_the_same_in_any_order(
    repository: Repository, recorder: Recorder, engine: Engine
) -> None:
    repository.sync_plant(on_one_bus())
    beside = [
        replace(record, time_ns=record.time_ns + 20 * SECOND_NS) for record in records_of_a_motor(14, seed=2)
    ]
    come = [(PUMP, record) for record in RECORDS[:14]] + [(FAN, record) for record in beside]
    found = []
    for seed in (1, 2):
        random.Random(seed).shuffle(come)
        ids = []
        for at, (name, record) in enumerate(come):
            ids.append(recorder.record(record, name))
            if at % 10 == 0:
                fold_all(repository)
        fold_all(repository)
        documents = {name: json.dumps(repository.condition(name).document) for name in (PUMP, FAN)}
        found.append((documents, {name: repository.checkpoints(name)[-1].state for name in (PUMP, FAN)}))
        for id_ in ids:
            repository.delete_recording(id_, "again", now_ns=NOW_NS)
    assert found[0] == found[1]


def test_motors_behind_one_voltage_transformer_are_not_compared(
    repository: Repository, recorder: Recorder
) -> None:
    plant = on_one_bus()
    bus = Bus("BUS-A", (PUMP, FAN), common_voltage_transformer=True)
    repository.sync_plant(replace(plant, buses=(bus,)))
    recorder.record(RECORDS[0], FAN)
    recorder.record(RECORDS[0])
    fold = repository.begin_fold(PUMP, 10)
    assert fold is not None
    assert (fold.bus, fold.neighbours) == ((), ())
