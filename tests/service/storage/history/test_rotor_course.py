"""The rotor of a motor over all its records, however they come, change and go."""

from collections.abc import Sequence
from dataclasses import replace
from random import Random
from statistics import median

import pytest

from core.rotor.finding import RotorFinding, RotorState
from core.rotor.trend import condition_of_findings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.rotor_and_supply import BROKEN_ROTOR, SHORT_RECORD, SOUND_ROTOR, ExaminedRecordings

PERSON = Actor("ada", "tests")
MOTOR = "PUMP-A1"
Expected = tuple[RotorState, int | None, float | None, list[tuple[int, int, float | None]]]


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


def _sound(severity_dB: float, load_bin: int = 6) -> RotorFinding:
    return replace(SOUND_ROTOR, severity_dB=severity_dB, load_bin=load_bin)


def test_the_condition_begins_with_the_record_that_changed_it(recorded: ExaminedRecordings) -> None:
    repository = recorded.repository
    assert repository.rotor_condition(MOTOR).state is RotorState.UNSUPPORTED
    for finding in (*[SOUND_ROTOR] * 4, BROKEN_ROTOR, BROKEN_ROTOR, SHORT_RECORD, SHORT_RECORD):
        recorded.add(finding)
    condition = repository.rotor_condition(MOTOR)
    assert condition.state is RotorState.FAULT
    assert condition.since_ns == NOW_NS + 6 * SECOND_NS
    assert condition.bins[0][:2] == (6, 6)


def test_a_motor_that_is_repaired_is_healthy_again(recorded: ExaminedRecordings) -> None:
    for finding in (*[BROKEN_ROTOR] * 3, *[SOUND_ROTOR] * 3):
        recorded.add(finding)
    condition = recorded.repository.rotor_condition(MOTOR)
    assert condition.state is RotorState.HEALTHY
    assert condition.since_ns == NOW_NS + 6 * SECOND_NS
    assert condition.change_dB == -21.0


def test_all_records_count_not_only_the_first_and_the_latest(recorded: ExaminedRecordings) -> None:
    """A load that is run now and then has its baseline wherever its records are among the others."""
    for number in range(60):
        recorded.add(_sound(-49.0, 3) if number in (29, 30, 31) else _sound(-60.0, 9))
    for severity_dB in (-44.0, -44.5):
        recorded.add(_sound(severity_dB, 3))
    condition = recorded.repository.rotor_condition(MOTOR)
    assert condition.state is RotorState.WATCH
    assert [tuple(one) for one in condition.bins] == [(3, 5, -49.0), (9, 57, -50.0)]


def test_a_joined_recording_stands_for_its_parts(recorded: ExaminedRecordings) -> None:
    repository = recorded.repository
    parts = [recorded.add(BROKEN_ROTOR) for _ in range(3)]
    joined = recorded.join(parts, SOUND_ROTOR)
    condition = repository.rotor_condition(MOTOR)
    assert condition.state is RotorState.HEALTHY
    assert condition.bins[0].records == 1

    recorded.diagnose_again(parts[1], BROKEN_ROTOR)
    assert repository.rotor_condition(MOTOR) == condition

    recorded.diagnose_again(joined, SHORT_RECORD)  # cannot tell: the parts do
    assert repository.rotor_condition(MOTOR).state is RotorState.FAULT
    assert repository.rotor_condition(MOTOR).bins[0].records == 3

    recorded.diagnose_again(joined, SOUND_ROTOR)
    assert repository.rotor_condition(MOTOR).bins[0].records == 1
    repository.delete_recording(joined, "another motor's", by=PERSON, now_ns=NOW_NS)
    assert repository.rotor_condition(MOTOR).bins[0].records == 3


def test_a_record_that_leaves_a_baseline_is_compared_with_it(recorded: ExaminedRecordings) -> None:
    """The level stays, and the record lies behind those that are judged again for their place."""
    other_load = replace(_sound(-70.0), load_bin=6)
    loud = replace(other_load, state=RotorState.WATCH)
    third = _sound(-43.5, 3)
    for finding in (_sound(-48.0, 3), _sound(-48.0, 3), *[other_load] * 4, third, loud):
        recorded.add(finding)
    assert recorded.repository.rotor_condition(MOTOR).state is RotorState.HEALTHY
    recorded.add(_sound(-48.0, 3), at_ns=NOW_NS)
    assert recorded.repository.rotor_condition(MOTOR).state is RotorState.WATCH
    assert recorded.repository.rotor_condition(MOTOR).since_ns == NOW_NS + 8 * SECOND_NS


@pytest.mark.parametrize("seed", range(4))
def test_however_records_come_and_go_the_condition_is_that_of_all_in_their_order(
    recorded: ExaminedRecordings, seed: int
) -> None:
    random = Random(seed)
    present: dict[str, tuple[int, RotorFinding]] = {}
    for _ in range(40):
        choice = random.random()
        if choice < 0.7 or not present:
            finding, at_ns = _drawn(random), NOW_NS + random.randrange(1000) * SECOND_NS
            present[recorded.add(finding, at_ns=at_ns)] = (at_ns, finding)
        elif choice < 0.85:
            changed = random.choice(sorted(present))
            at_ns, finding = present[changed][0], _drawn(random)
            recorded.diagnose_again(changed, finding, at_ns=at_ns)
            present[changed] = (at_ns, finding)
        else:
            gone = random.choice(sorted(present))
            recorded.repository.delete_recording(gone, "wrong", by=PERSON, now_ns=NOW_NS)
            del present[gone]
        in_order = sorted((at_ns, one, finding) for one, (at_ns, finding) in present.items())
        condition = recorded.repository.rotor_condition(MOTOR)
        found = (
            condition.state,
            condition.since_ns,
            condition.change_dB,
            [tuple(one) for one in condition.bins],
        )
        assert found == _expected([(at_ns, finding) for at_ns, _, finding in in_order])


def _drawn(random: Random) -> RotorFinding:
    if random.random() < 0.15:
        return SHORT_RECORD
    severity_dB = random.choice([-70.0, -48.0, -47.0, -43.5, -40.0, -30.0])
    state = RotorState.FAULT if severity_dB > -36.0 else RotorState.HEALTHY
    return replace(
        SOUND_ROTOR,
        state=RotorState.WATCH if severity_dB == -40.0 else state,
        severity_dB=severity_dB,
        load_bin=random.choice([3, 6]),
    )


def _expected(findings: Sequence[tuple[int, RotorFinding]]) -> Expected:
    """Judge all records one after the other."""
    first: dict[int, list[float]] = {}
    counts: dict[int, int] = {}
    seen: list[tuple[int, RotorState, float | None]] = []
    states: list[RotorState] = []
    for at_ns, finding in findings:
        if finding.state is RotorState.UNSUPPORTED or finding.severity_dB is None or finding.load_bin is None:
            continue
        level, of_bin = max(finding.severity_dB, -50.0), first.setdefault(finding.load_bin, [])
        counts[finding.load_bin] = counts.get(finding.load_bin, 0) + 1
        change = level - median(of_bin) if len(of_bin) == 3 else None
        if len(of_bin) < 3:
            of_bin.append(level)
        seen.append((at_ns, finding.state, change))
        faults = sum(state is RotorState.FAULT for _, state, _ in seen[-3:])
        notable = sum(state is not RotorState.HEALTHY or (rise or 0.0) >= 4.0 for _, state, rise in seen[-3:])
        watched = RotorState.WATCH if faults or notable >= 2 else RotorState.HEALTHY
        states.append(RotorState.FAULT if faults >= 2 else watched)
    if not seen:
        return RotorState.UNSUPPORTED, None, None, []
    others = [k for k, state in enumerate(states) if state is not states[-1]]
    changes = [rise for _, _, rise in seen[-3:] if rise is not None]
    bins = [
        (load_bin, counts[load_bin], median(levels) if len(levels) == 3 else None)
        for load_bin, levels in sorted(first.items())
    ]
    since_ns = seen[others[-1] + 1 if others else 0][0]
    return states[-1], since_ns, median(changes) if changes else None, bins


def test_files_alone_tell_the_same_as_the_database(recorded: ExaminedRecordings) -> None:
    repository = recorded.repository
    louder = replace(SOUND_ROTOR, severity_dB=-60.0, severity_dB_ci95=(-62.0, -58.0))
    other_load = replace(louder, load_bin=2)
    findings = [SOUND_ROTOR, other_load, louder, SHORT_RECORD, louder, BROKEN_ROTOR, louder, BROKEN_ROTOR]
    for number in range(len(findings)):
        recorded.add(findings[number])
        times = [one.recorded_ns or 0 for one in repository.recordings(motor=MOTOR, limit=100).items]
        followed = condition_of_findings(list(zip(sorted(times), findings, strict=False)))
        assert followed == repository.rotor_condition(MOTOR)
