"""Joins what is stored of a motor, and weighs its causes."""

from dataclasses import dataclass

from core.classification.classification import Classification
from core.classification.motor import MOST_LOADS, MOST_RECORDS, MotorEvidence, classify_motor
from core.classification.record_answer import RecordAnswer
from core.condition.kinds import Kind, State
from core.starts.compared import StartChanges
from service.alarms.start_rules import LATEST
from service.storage import Repository


@dataclass(frozen=True, slots=True)
class MotorAnswer:
    """The answer of a motor, and the number of records that took part."""

    classification: Classification
    records: int


def motor_answer(repository: Repository, motor: str) -> MotorAnswer:
    """Return the answer of a motor. Raises NotFoundError."""
    condition = repository.health(motor).condition
    document = condition.document or {}
    answers = repository.latest_answers(motor, limit=MOST_RECORDS)
    entries = repository.latest_rotor_findings(motor, limit=MOST_LOADS)
    levels = [one.finding.load_level for one in entries if one.finding.load_level is not None]
    candidates = document.get("candidates")
    known = MotorEvidence(
        state=State.UNKNOWN if condition.document is None else condition.state,
        kind=condition.kind,
        candidates=tuple(map(Kind, candidates)) if isinstance(candidates, list) else (),
        phase=condition.phase,
        rotor=repository.rotor_condition(motor),
        records=[RecordAnswer.from_dict(one) for one in answers],
        load_levels=levels,
        starts=_starts(repository, motor),
        tracked=repository.tracked_parameters(motor),
    )
    return MotorAnswer(classify_motor(known), len(answers))


def _starts(repository: Repository, motor: str) -> StartChanges | None:
    latest = repository.starts(motor, limit=LATEST).items
    return repository.start_reference(motor).compared(latest) if latest else None
