"""What workers elsewhere find comes back as it was, and nothing else comes back."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from core.machines.parameters import Motor
from core.recordings import Recording
from core.recordings.comtrade.writer import write
from service.jobs.dask_tasks import MOST_CHARACTERS
from service.jobs.plain import PlainDataError, outcome_text, read_outcome
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
    assert faulty.findings.observation is not None
    assert faulty.findings.classification is not None
    assert faulty.findings.diagnosis.hypotheses
    assert faulty.findings.classification.likelihoods
    text = text_of(faulty)
    assert len(text) < MOST_CHARACTERS / 100
    assert read_outcome(text) == faulty


@pytest.fixture(scope="module")
def started(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    return outcome_of(
        tmp_path_factory.mktemp("started"), StartRecord(load_level=0.5).of(REFERENCE), REFERENCE
    )


def test_a_start_comes_back_as_it_was(started: Diagnosed) -> None:
    assert started.findings.start is not None
    assert read_outcome(text_of(started)) == started


def test_a_rejection_comes_back() -> None:
    assert read_outcome(text_of(Rejected("no currents"))) == Rejected("no currents")


def test_errors_come_back_as_words() -> None:
    with pytest.raises(StoreUnreachableError, match=r"^no answer$"):
        read_outcome(outcome_text(raising(StoreUnreachableError("no answer"))))
    with pytest.raises(WorkerFailedError, match=r"^FileNotFoundError: EVENT\.CFF: host B does not see it$"):
        read_outcome(outcome_text(raising(FileNotFoundError("EVENT.CFF: host B does not see it"))))


WRONG: dict[str, tuple[tuple[str | int, ...], object]] = {
    "diagnosed.recorded_ns: Input should be a valid integer, found '7'": (("recorded_ns",), "7"),
    "diagnosed.recorded_ns: Input should be a valid integer, found True": (("recorded_ns",), True),
    "diagnosed.findings.diagnosis.verdict: Input should be 'healthy', 'watch'": (
        ("findings", "diagnosis", "verdict"), "doomed",
    ),
    "diagnosed.findings.diagnosis.theta_f: Input should be 0, 1 or 2, found 3": (
        ("findings", "diagnosis", "theta_f"), 3,
    ),
    "diagnosed.findings.diagnosis.mu_f_ci95": (("findings", "diagnosis", "mu_f_ci95"), [0.1, 0.2, 0.3]),
    "diagnosed.findings.diagnosis.reasons": (("findings", "diagnosis", "reasons"), "because"),
    "diagnosed.findings.diagnosis.quality": (("findings", "diagnosis", "quality"), {"__reduce__": "x"}),
    "diagnosed.findings.observation.positive_voltage_V": (
        ("findings", "observation", "positive_voltage_V"), [1.0],
    ),
    "diagnosed.findings.classification.answer.causes.0: Input should be": (
        ("findings", "classification", "answer", "causes"), ["gremlins"],
    ),
    "diagnosed.findings.rotor.state: Field required": (("findings", "rotor"), {"duration_s": 1.0}),
    "diagnosed.findings.rotten: Unexpected keyword argument": (("findings", "rotten"), 1),
}  # fmt: skip


@pytest.mark.parametrize("said", WRONG)
def test_what_is_of_another_type_is_refused_with_its_place(faulty: Diagnosed, said: str) -> None:
    keys, value = WRONG[said]
    document: dict[str, Any] = json.loads(text_of(faulty))
    part: Any = document
    for key in ("diagnosed", *keys[:-1]):
        part = part[key]
    part[keys[-1]] = value
    with pytest.raises(PlainDataError) as refusal:
        read_outcome(json.dumps(document))
    assert str(refusal.value).startswith(said)


@pytest.mark.parametrize(
    "text", ["", "nonsense", "7", "[" * 100_000, '{"rejected": ' + "9" * 5000 + "}", "{}", '{"a": 1, "b": 2}']
)
def test_what_is_no_outcome_is_refused(text: str) -> None:
    with pytest.raises(PlainDataError):
        read_outcome(text)


def test_a_text_that_is_too_long_is_not_even_looked_at() -> None:
    with pytest.raises(PlainDataError, match="characters at most"):
        read_outcome(" " * (MOST_CHARACTERS + 1))
