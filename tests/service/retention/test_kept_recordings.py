"""What stays of a motor's recordings, whatever their age, also when the rules are applied again."""

import json
import uuid
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import Engine

from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.diagnosis.verdict import Verdict
from core.operation import Operation
from core.units import NANOSECONDS_PER_DAY as DAY_NS
from service.cli.app import main
from service.configuration.settings import Settings
from service.retention.batches import Batches, Pace
from service.retention.reasons import WORDS
from service.retention.rules import rules
from service.storage import Repository
from service.storage.models import (
    AlarmRow,
    ConditionChangeRow,
    ConditionCheckpointRow,
    ConditionEventRow,
    DiagnosisRow,
    JobRow,
    MotorRow,
    RecordingRow,
)
from service.storage.states import (
    AlarmKind,
    AlarmPriority,
    AlarmState,
    JobState,
    RecordingSource,
    RecordingState,
    StayReason,
)
from testing.service.plants import NOW_NS

SAYING = (Verdict.HEALTHY, Verdict.WATCH, Verdict.FAULT)
ALL_RULES = {f"{name}_days": 1 for name in (*SAYING, "undiagnosable", "not_running", "rejected")}
LATER_NS = NOW_NS + 5000 * DAY_NS


@dataclass(frozen=True)
class Made:
    """A recording of the test. verdict: None for one that was rejected."""

    hours: float
    verdict: Verdict | None = Verdict.HEALTHY
    operation: Operation = Operation.RUNNING

    @property
    def time_ns(self) -> int:
        return NOW_NS + round(self.hours / 24 * DAY_NS)


class PlantedRepository(Repository):
    """Can be given many recordings in one transaction. Rules look at its latest motor only."""

    latest_motor: str | None = None

    def all_motors(self) -> tuple[str, ...]:
        return super().all_motors() if self.latest_motor is None else (self.latest_motor,)

    def add_motor(self) -> str:
        name = f"MOTOR-{uuid.uuid4()}"
        with self._write() as session:
            known = session.get_one(MotorRow, "PUMP-A1")
            columns = {column.name: getattr(known, column.name) for column in MotorRow.__table__.columns}
            session.add(MotorRow(**{**columns, "name": name}))
        self.latest_motor = name
        return name

    def add(self, motor: str, made: Sequence[Made]) -> list[str]:
        ids = [str(uuid.uuid4()) for _ in made]
        with self._write() as session:
            for id_, one in zip(ids, made, strict=True):
                session.add(_recording(id_, motor, one))
            session.flush()
            for id_, one in zip(ids, made, strict=True):
                session.add(
                    JobRow(
                        id=id_,
                        recording_id=id_,
                        motor=motor,
                        method="hcpa",
                        model="split-winding",
                        state=JobState.FAILED if one.verdict is None else JobState.DONE,
                        attempts=1,
                        not_before_ns=0,
                        created_ns=one.time_ns,
                    )
                )
            session.flush()
            session.add_all(
                _diagnosis(id_, motor, one) for id_, one in zip(ids, made, strict=True) if one.verdict
            )
        return ids

    def put(self, *rows: object) -> None:
        with self._write() as session:
            session.add_all(rows)


def _recording(id_: str, motor: str, made: Made) -> RecordingRow:
    return RecordingRow(
        id=id_,
        motor=motor,
        source=RecordingSource.UPLOAD,
        name=id_,
        size_bytes=100,
        state=RecordingState.REJECTED if made.verdict is None else RecordingState.DIAGNOSED,
        attempts=0,
        announced_ns=made.time_ns,
        recorded_ns=None if made.verdict is None else made.time_ns,
        operation=made.operation,
        operation_remark="of a test",
    )


def _diagnosis(id_: str, motor: str, made: Made) -> DiagnosisRow:
    return DiagnosisRow(
        id=id_,
        job_id=id_,
        recording_id=id_,
        motor=motor,
        current=True,
        created_ns=made.time_ns,
        recorded_ns=made.time_ns,
        verdict=made.verdict,
        method="hcpa",
        model="split-winding",
        document={},
        says_nothing=made.verdict is Verdict.UNDIAGNOSABLE and made.operation is not Operation.RUNNING,
    )


@pytest.fixture
def planted(engine: Engine, repository: Repository) -> PlantedRepository:
    assert repository.all_motors()
    return PlantedRepository(engine)


def settings_of(**kept: object) -> Settings:
    return Settings.model_validate({"retention": {"keep_newest": 1, **ALL_RULES, **kept}})


def apply(repository: Repository, kept: Settings, now_ns: int = LATER_NS) -> int:
    """How many recordings the rules deleted."""
    batches = Batches(Pace(round_s=inf, rest=0.0))
    done = [rule.forget(batches) for rule in rules(kept, repository, now_ns) if rule.days is not None]
    return sum(done)


def left(repository: Repository, motor: str) -> set[str]:
    return {entry.id for entry in repository.recordings(motor=motor, limit=200).items}


def stays(repository: Repository, kept: Settings, motor: str) -> dict[str, StayReason | None]:
    return {
        one.id: one.stays
        for rule in rules(kept, repository, LATER_NS)
        for one in rule.listed()
        if one.motor == motor
    }


def changes(recordings: Sequence[tuple[str, Made]]) -> Iterator[tuple[str, str]]:
    """The recordings before and after each change of verdict, in the order of time."""
    said = sorted(
        (one for one in recordings if one[1].verdict in SAYING), key=lambda one: (one[1].time_ns, one[0])
    )
    for (before, old), (after, new) in pairwise(said):
        if old.verdict is not new.verdict:
            yield before, after


made_recordings = st.lists(
    st.builds(
        Made,
        hours=st.integers(0, 60 * 24).map(float),
        verdict=st.sampled_from([*SAYING, *SAYING, Verdict.UNDIAGNOSABLE, None]),
        operation=st.sampled_from([Operation.RUNNING, Operation.RUNNING, Operation.START, Operation.TRIP]),
    ),
    min_size=1,
    max_size=14,
)


@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    made=made_recordings,
    kept=st.fixed_dictionaries(
        {
            "keep_newest": st.integers(1, 4),
            "keep_first_days": st.sampled_from([None, 3, 20]),
            "keep_one_in_days": st.sampled_from([None, 1, 7]),
            "keep_operations": st.sampled_from([(), ("start",), ("start", "trip")]),
        }
    ),
)
def test_rules_applied_twice_delete_nothing_more_and_every_change_can_still_be_seen(
    planted: PlantedRepository, made: list[Made], kept: dict[str, object]
) -> None:
    motor = planted.add_motor()
    recordings = list(zip(planted.add(motor, made), made, strict=True))
    chosen = settings_of(keep_changes=True, **kept)
    promised = stays(planted, chosen, motor)
    apply(planted, chosen)
    remaining = left(planted, motor)
    assert remaining == {id_ for id_, reason in promised.items() if reason is not None}, "as the dry run said"
    assert apply(planted, chosen) == 0
    before = list(changes(recordings))
    assert list(changes([one for one in recordings if one[0] in remaining])) == before
    assert {id_ for pair in before for id_ in pair} <= remaining
    operations = kept["keep_operations"]
    assert isinstance(operations, tuple)
    assert {id_ for id_, one in recordings if one.operation in operations} <= remaining
    if kept["keep_one_in_days"] is not None:
        assert isinstance(kept["keep_one_in_days"], int)
        period_ns = kept["keep_one_in_days"] * DAY_NS
        windows, kept_windows = (
            {one.time_ns // period_ns for id_, one in recordings if one.verdict in SAYING and id_ in some}
            for some in ({id_ for id_, _ in recordings}, remaining)
        )
        assert kept_windows == windows


def test_a_healthy_motor_is_thinned_to_one_recording_a_week_after_its_first_days(
    planted: PlantedRepository,
) -> None:
    motor = planted.add_motor()
    planted.add(motor, [Made(24.0 * day) for day in range(0, 100, 2)])
    kept = settings_of(keep_first_days=30, keep_one_in_days=7, keep_changes=True)
    apply(planted, kept)
    entries = planted.recordings(motor=motor, limit=200).items
    days = sorted((entry.announced_ns - NOW_NS) / DAY_NS for entry in entries)
    assert [day for day in days if day < 30] == list(range(0, 30, 2)), "all of them"
    weeks = [(NOW_NS / DAY_NS + day) // 7 for day in days if 30 <= day < 98]
    assert all(later - week == 1 for week, later in pairwise(weeks)), "one of each week"
    assert days[-1] == 98, "the newest"


def test_a_recording_of_wrong_time_does_not_move_the_first_year(planted: PlantedRepository) -> None:
    """A relay's clock may say 1970: the first year counts from what the service saw first."""
    motor = planted.add_motor()
    first = planted.add(motor, [Made(0), Made(24 * 300), Made(24 * 400), Made(24 * 401), Made(24 * 500)])
    with planted._write() as session:
        session.get_one(RecordingRow, first[3]).recorded_ns = 5
        session.get_one(DiagnosisRow, first[3]).recorded_ns = 5
    kept = settings_of(keep_first_days=365)
    assert apply(planted, kept) > 0
    assert {first[0], first[1], first[4]} <= left(planted, motor)
    planted.delete_recording(first[0], "a test", now_ns=LATER_NS)
    assert stays(planted, kept, motor)[first[1]] is StayReason.FIRST, "though the first one is deleted"


def test_what_an_alarm_rests_on_stays_until_it_is_over(planted: PlantedRepository) -> None:
    motor = planted.add_motor()
    ids = planted.add(motor, [Made(24.0 * day, Verdict.FAULT) for day in range(7)])
    planted.put(
        ConditionChangeRow(
            id=ids[2],
            motor=motor,
            time_ns=NOW_NS + 2 * DAY_NS,
            recording_id=ids[2],
            state=State.FAULT,
            kind=Kind.SHORTED_TURNS,
        ),
        AlarmRow(
            id=str(uuid.uuid4()),
            site="FACTORY_A",
            ied="A1_SEL710",
            motor=motor,
            kind=AlarmKind.CONDITION_FAULT,
            subject="shorted-turns",
            reason="a test",
            recording_id=ids[4],
            priority=AlarmPriority.HIGH,
            state=AlarmState.RETURNED_UNACKNOWLEDGED,
            urgency=1,
            raised_ns=NOW_NS,
            raises=1,
            cleared_ns=NOW_NS + DAY_NS,
            changed_ns=NOW_NS,
            changed_by="a test",
        ),
    )
    reasons = stays(planted, settings_of(), motor)
    assert {reasons[ids[2]], reasons[ids[4]]} == {StayReason.ALARM}, "nobody has acknowledged it"
    apply(planted, settings_of())
    assert left(planted, motor) == {ids[2], ids[4], ids[6]}
    with planted._write() as session:
        alarm = session.query(AlarmRow).filter_by(motor=motor).one()
        alarm.state = AlarmState.NORMAL
    apply(planted, settings_of())
    assert left(planted, motor) == {ids[6]}


def test_what_notes_and_checkpoints_of_the_condition_need_stays(planted: PlantedRepository) -> None:
    motor = planted.add_motor()
    ids = planted.add(motor, [Made(24.0 * day) for day in range(10)])
    told = {"motor": motor, "reason": "a test", "account": "tests", "by": "a test", "made_ns": NOW_NS}
    withdrawn = {**told, "withdrawn_ns": NOW_NS, "withdrawn_by": "a test", "withdrawn_reason": "wrong"}
    at_ns = NOW_NS + DAY_NS // 2
    planted.put(
        ConditionEventRow(id=str(uuid.uuid4()), time_ns=at_ns + 3 * DAY_NS, kind=EventKind.NOTE, **told),
        ConditionEventRow(id=str(uuid.uuid4()), time_ns=at_ns + DAY_NS, kind=EventKind.REWOUND, **withdrawn),
        ConditionCheckpointRow(motor=motor, time_ns=NOW_NS + 7 * DAY_NS, records=8, state=b"", tracking={}),
    )
    reasons = stays(planted, settings_of(), motor)
    assert {id_: reason for id_, reason in reasons.items() if reason is not None} == {
        ids[3]: StayReason.NOTE,
        ids[4]: StayReason.NOTE,
        ids[7]: StayReason.CHECKPOINT,
        ids[9]: StayReason.NEWEST,
    }
    apply(planted, settings_of())
    assert left(planted, motor) == {ids[3], ids[4], ids[7], ids[9]}
    assert apply(planted, settings_of()) == 0


def test_every_reason_has_words() -> None:
    assert set(WORDS) == set(StayReason)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_the_dry_run_lists_each_recording_with_the_reason(
    planted: PlantedRepository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ids = planted.add("PUMP-A1", [Made(0), Made(24), Made(48, Verdict.FAULT), Made(72, Verdict.FAULT)])
    config = tmp_path / "mcc.toml"
    config.write_text(
        'data_directory = "."\n[retention]\nhealthy_days = 30\nfault_days = 30\nkeep_newest = 1\n'
        "keep_changes = true\n"
    )
    asked = ["retention", "--dry-run", "--list", "--config", str(config)]
    assert main(asked) == 0
    lines = capsys.readouterr().out.splitlines()
    of_first = next(line for line in lines if ids[0] in line)
    assert of_first.startswith("stays  PUMP-A1  2025-10-09T08:53:20Z"), "before it there was no verdict"
    assert main([*asked, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    told = {one["recording"]: (one["goes"], one["reason"]) for one in document["recordings"]}
    change = (False, WORDS[StayReason.CHANGE])
    assert told == {
        ids[0]: change,
        ids[1]: change,
        ids[2]: change,
        ids[3]: (False, WORDS[StayReason.NEWEST]),
    }
    config.write_text(config.read_text().replace("keep_changes = true", ""))
    assert main([*asked, "--json"]) == 0
    goes = {
        one["recording"]: one["reason"]
        for one in json.loads(capsys.readouterr().out)["recordings"]
        if one["goes"]
    }
    assert goes == {
        ids[0]: "older than retention.healthy_days = 30",
        ids[1]: "older than retention.healthy_days = 30",
        ids[2]: "older than retention.fault_days = 30",
    }
    assert len(left(planted, "PUMP-A1")) == 4, "nothing was deleted"
