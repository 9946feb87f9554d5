"""The one condition of each motor: what is kept of its parts, put together where one changes.

Whoever calls it has locked the condition's row, or is given it locked.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.classification.classification import Classification
from core.classification.motor import MOST_LOADS, MOST_RECORDS, MotorEvidence, classify_motor
from core.classification.record_answer import RecordAnswer
from core.condition.kinds import State
from core.condition.verdict.condition import Condition, unknown_condition
from core.machines.parameters import Limits
from core.motor_condition.condition import motor_condition
from core.motor_condition.efficiency import efficiency_part
from core.motor_condition.judging import parameters_part, rotor_part, starts_part, supply_part, voltages_agree
from core.motor_condition.parts import Part, PartCondition
from core.motor_condition.supply import LATEST_RECORDS, supply_condition
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.tracking.finding import TrackedParameters
from service.storage.models import ConditionRow, DiagnosisRow, MotorRow, MotorVersionRow, RotorFindingRow
from service.storage.records import ConditionEntry
from service.storage.repository.alarms.drift import settle_drift_alarm
from service.storage.repository.alarms.parts import settle_part_alarms
from service.storage.repository.alarms.starts import NotableStarts, notable_starts
from service.storage.repository.history.record_figures import latest_figures
from service.storage.repository.history.rotor_course import course_condition, latest_time_ns
from service.storage.repository.sessions import Sessions, found, record_of


@dataclass(frozen=True, slots=True)
class MotorAnswer:
    """The causes of all that is known of a motor, how many records took part, and its latest loads."""

    classification: Classification
    records: int
    load_levels: Sequence[float]


class MotorConditionRows(Sessions):
    def settle_motor_condition(self, motor: str, *, now_ns: int) -> None:
        """Make a motor's condition, and alarms, say what is kept of its parts. Raises NotFoundError."""
        with self._write() as session:
            settle_beside_fold(session, motor, now_ns=now_ns)

    def motor_answer(self, motor: str) -> MotorAnswer:
        """Return the causes of all that is known of a motor. Raises NotFoundError."""
        with self._read() as session:
            row = found(session, ConditionRow, motor, "motor")
            return _answer(session, row, course_condition(session, motor), notable_starts(session, motor))


def settle_beside_fold(session: Session, motor: str, *, now_ns: int) -> None:
    """Make a motor's condition follow what no fold brings: joined records, starts, deletions.

    Where it says anything else then, a fold that is under way begins anew: it may have said it before.
    Raises NotFoundError.
    """
    found(session, MotorRow, motor, "motor", lock=True)  # first, as all who keep a diagnosis or alarms do
    row = found(session, ConditionRow, motor, "motor", lock=True)
    before = row.document
    settle_motor_condition(session, row, now_ns=now_ns)
    if row.document != before:
        row.version += 1


def settle_motor_condition(session: Session, row: ConditionRow, *, now_ns: int) -> None:
    """Put a motor's condition together from what is kept of its parts, and have their alarms follow."""
    session.flush()
    rotor = course_condition(session, row.motor, dates_healthy=False)
    stator = _stator(row)
    if stator.as_of_ns is None:  # no record tells of the stator; some may of the rotor
        row.as_of_ns = latest_time_ns(session, row.motor)
        stator = replace(stator, as_of_ns=row.as_of_ns)
    supplies, losses = latest_figures(session, row.motor, LATEST_RECORDS)
    supply = supply_condition(
        supplies,
        _rated_frequency_hz(session, row.motor),
        voltages_agree=voltages_agree(stator),
    )
    starts = notable_starts(session, row.motor)
    answer = _answer(session, row, rotor, starts)
    is_new = row.document is None and row.stator is None and rotor.state is RotorState.UNSUPPORTED
    if is_new and supply.state is State.UNKNOWN and not starts.latest:
        return  # nothing is known of any part
    condition = motor_condition(
        stator,
        (
            rotor_part(rotor),
            supply_part(supply),
            starts_part(starts.latest, starts.change, starts.since_ns),
            parameters_part(_tracked(row)),
            efficiency_part(losses, answer.load_levels),
        ),
        answer.classification,
    )
    row.state, row.kind, row.since_ns = condition.state, condition.kind, condition.since_ns
    row.phase = stator.phase if condition.is_of_stator else None
    row.candidates = stator.candidates if condition.is_of_stator else ()
    row.document = condition.as_dict()
    settle_alarms_of_parts(session, row, condition.parts, now_ns=now_ns)


def settle_alarms_of_parts(
    session: Session, row: ConditionRow, parts: Sequence[PartCondition], *, now_ns: int
) -> None:
    """Make the alarms of a motor's parts say what its condition says."""
    motor = found(session, MotorRow, row.motor, "motor")
    settle_part_alarms(session, motor, parts, now_ns=now_ns)
    explained = any(one.part is Part.PARAMETERS and one.explained_by is not None for one in parts)
    settle_drift_alarm(session, motor, None if explained else row.parameters, now_ns=now_ns)


def stator_entry(row: ConditionRow) -> ConditionEntry:
    """Return what the condition of a motor's stator says; its alarms follow from that."""
    stator = _stator(row)
    return replace(
        record_of(ConditionEntry, row),
        document=row.stator,
        state=stator.state,
        kind=stator.kind,
        candidates=stator.candidates,
        phase=stator.phase,
        since_ns=stator.since_ns,
    )


def _stator(row: ConditionRow) -> Condition:
    if row.stator is None:
        return unknown_condition(row.motor, Limits().fault_level)
    return Condition.from_dict(row.stator)


def _answer(session: Session, row: ConditionRow, rotor: RotorCondition, starts: NotableStarts) -> MotorAnswer:
    answers, stator = _latest_answers(session, row.motor), _stator(row)
    known = MotorEvidence(
        state=stator.state,
        kind=stator.kind,
        candidates=stator.candidates,
        phase=stator.phase,
        rotor=rotor,
        records=[RecordAnswer.from_dict(one) for one in answers],
        load_levels=_load_levels(session, row.motor),
        starts=starts.compared,
        tracked=_tracked(row),
    )
    return MotorAnswer(classify_motor(known), len(answers), known.load_levels)


def _latest_answers(session: Session, motor: str) -> Sequence[Mapping[str, Any]]:
    """Return the classifications of the latest recordings of running, oldest first."""
    latest = (
        select(DiagnosisRow.document["classification"])
        .where(DiagnosisRow.motor == motor, DiagnosisRow.current, DiagnosisRow.says_nothing.is_(False))
        .order_by(DiagnosisRow.recorded_ns.desc(), DiagnosisRow.id.desc())
        .limit(MOST_RECORDS)
    )
    found = session.scalars(latest).all()
    return [cast(Mapping[str, Any], one) for one in reversed(found) if one is not None]


def _tracked(row: ConditionRow) -> TrackedParameters | None:
    return None if row.parameters is None else TrackedParameters.from_dict(row.parameters)


def _load_levels(session: Session, motor: str) -> Sequence[float]:
    """Return the loads of the latest records that tell one, oldest first."""
    latest = (
        select(RotorFindingRow.load_level)
        .where(RotorFindingRow.motor == motor)
        .order_by(RotorFindingRow.time_ns.desc(), RotorFindingRow.recording_id.desc())
        .limit(MOST_LOADS)
    )
    return [one for one in reversed(session.scalars(latest).all()) if one is not None]


def _rated_frequency_hz(session: Session, motor: str) -> float | None:
    """Return the rated frequency that the motors file says at last; None of a motor that it never had."""
    latest = (
        select(MotorVersionRow.document["nameplate"]["rated_frequency_hz"].as_float())
        .where(MotorVersionRow.motor == motor)
        .order_by(MotorVersionRow.from_ns.desc())
        .limit(1)
    )
    return session.scalar(latest)
