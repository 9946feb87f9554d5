"""What workers elsewhere find comes back as it was, and nothing else comes back."""

import json
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from core.machines.parameters import Motor
from core.recordings import Recording
from core.recordings.comtrade.writer import write
from service.jobs.dask_tasks import MOST_CHARACTERS
from service.jobs.plain import PlainDataError, outcome_text, read, read_outcome
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected
from service.jobs.worker import diagnose_recording
from service.jobs.workers import WorkerFailedError
from service.recording_store.errors import StoreUnreachableError
from service.recording_store.recording import LocalFile
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault
from testing.machines.starts import StartRecord
from testing.service.plants import NOW_NS, motor
from testing.service.real_recordings import running_record


def outcome_of(folder: Path, record: Recording, of: Motor) -> Diagnosed:
    entry = write(folder / "EVENT", record)
    outcome = diagnose_recording(DiagnosisTask(LocalFile(entry), of, "hcpa", "shorted-winding"))
    assert isinstance(outcome, Diagnosed)
    return outcome


@pytest.fixture(scope="module")
def faulty(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    record = running_record(begin_ns=NOW_NS, fault=Fault(0.02, 1))
    return outcome_of(tmp_path_factory.mktemp("faulty"), record, motor("PUMP-A1"))


def text_of(outcome: Outcome) -> str:
    return outcome_text(lambda: outcome)


def raising(error: Exception) -> Callable[[], Outcome]:
    def find() -> Outcome:
        raise error

    return find


def test_what_a_record_shows_comes_back_as_it_was(faulty: Diagnosed) -> None:
    assert faulty.observation is not None
    assert faulty.classification is not None
    assert faulty.diagnosis.hypotheses
    assert faulty.classification.likelihoods
    text = text_of(faulty)
    assert len(text) < MOST_CHARACTERS / 100
    assert read_outcome(text) == faulty


@pytest.fixture(scope="module")
def started(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    return outcome_of(
        tmp_path_factory.mktemp("started"), StartRecord(load_level=0.5).of(REFERENCE), REFERENCE
    )


def test_a_start_comes_back_as_it_was(started: Diagnosed) -> None:
    assert started.start is not None
    assert read_outcome(text_of(started)) == started


def test_a_rejection_comes_back() -> None:
    assert read_outcome(text_of(Rejected("no currents"))) == Rejected("no currents")


def test_errors_come_back_as_words() -> None:
    with pytest.raises(StoreUnreachableError, match=r"^no answer$"):
        read_outcome(outcome_text(raising(StoreUnreachableError("no answer"))))
    with pytest.raises(WorkerFailedError, match=r"^FileNotFoundError: EVENT\.CFF: host B does not see it$"):
        read_outcome(outcome_text(raising(FileNotFoundError("EVENT.CFF: host B does not see it"))))


WRONG: dict[str, tuple[tuple[str | int, ...], object]] = {
    "diagnosed.recorded_ns: expected a int, found '7'": (("recorded_ns",), "7"),
    "diagnosed.recorded_ns: expected a int, found True": (("recorded_ns",), True),
    "diagnosed.diagnosis.verdict: expected a Verdict, found 'doomed'": (("diagnosis", "verdict"), "doomed"),
    "diagnosed.diagnosis.theta_f: expected one of (0, 1, 2), found 3": (("diagnosis", "theta_f"), 3),
    "diagnosed.diagnosis.mu_f_ci95: expected 2 values": (("diagnosis", "mu_f_ci95"), [0.1, 0.2, 0.3]),
    "diagnosed.diagnosis.reasons: expected a list": (("diagnosis", "reasons"), "because"),
    "diagnosed.diagnosis.quality: expected a list": (("diagnosis", "quality"), {"__reduce__": "x"}),
    "diagnosed.observation.positive_voltage_V: expected two": (("observation", "positive_voltage_V"), [1.0]),
    "diagnosed.classification.answer.causes: expected a Cause": (
        ("classification", "answer", "causes"), ["gremlins"],
    ),
    "diagnosed.length: expected the fields duration_s, pre_trigger_s": (("length",), {"duration_s": 1.0}),
}  # fmt: skip


@pytest.mark.parametrize("said", WRONG)
def test_what_is_of_another_type_is_refused_with_its_place(faulty: Diagnosed, said: str) -> None:
    keys, value = WRONG[said]
    document: dict[str, Any] = json.loads(text_of(faulty))
    part: Any = document["diagnosed"]
    for key in keys[:-1]:
        part = part[key]
    part[keys[-1]] = value
    with pytest.raises(PlainDataError) as refusal:
        read_outcome(json.dumps(document))
    assert str(refusal.value).startswith(said)


def test_a_key_that_comes_twice_is_refused(started: Diagnosed) -> None:
    document = json.loads(text_of(started))
    values = document["diagnosed"]["start"]["parameters"]["values"]
    values.append(deepcopy(values[0]))
    with pytest.raises(PlainDataError, match="each key once"):
        read_outcome(json.dumps(document))


@pytest.mark.parametrize(
    "text", ["", "nonsense", "7", "[" * 100_000, '{"rejected": ' + "9" * 5000 + "}", "{}", '{"a": 1, "b": 2}']
)
def test_what_is_no_outcome_is_refused(text: str) -> None:
    with pytest.raises(PlainDataError):
        read_outcome(text)


def test_a_text_that_is_too_long_is_not_even_looked_at() -> None:
    with pytest.raises(PlainDataError, match="characters at most"):
        read_outcome(" " * (MOST_CHARACTERS + 1))


def test_a_type_that_has_no_rule_is_an_error_of_ours() -> None:
    with pytest.raises(TypeError, match="no rule"):
        read({}, object, "here")
