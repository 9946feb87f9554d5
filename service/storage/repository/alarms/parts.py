"""The alarms of the parts of a motor: they follow its condition."""

from collections.abc import Iterable

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.motor_condition.parts import Part, PartCondition
from service.alarms.part_rules import OVER, PART_ALARMS, PART_OF_ALARM
from service.storage.models import AlarmRow, DiagnosisRow, MotorRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.repository.alarms.causes import (
    LEFT_THE_PLANT,
    end_of_motor,
    locked_place,
    raised_at,
    supersede,
)
from service.storage.repository.alarms.changes import locked


def settle_part_alarms(
    session: Session, motor: MotorRow, parts: Iterable[PartCondition], *, now_ns: int
) -> None:
    """Make the alarms of a motor's parts say what its condition says: one a part at most."""
    rows = locked(session, AlarmRow.motor == motor.name, AlarmRow.kind.in_(PART_OF_ALARM), is_open())
    told = set[Part]()
    for part in parts if motor.in_service else ():
        kind = PART_ALARMS.get((part.part, part.state))
        if kind is None or not part.counts:
            continue
        told.add(part.part)
        spec = AlarmSpec(
            kind,
            reason="; ".join((part.finding, *part.reasons)),
            subject=part.part.words,
            one_of_kind=True,
            advice=part.advice,
            recording_id=_latest_recording(session, motor.name),
        )
        place = locked_place(session, AlarmPlace(motor=motor.name))
        raised = raised_at(session, place, spec, now_ns=now_ns)
        for other in rows:
            if PART_OF_ALARM[other.kind] is part.part and other.kind is not kind:
                supersede(session, other, raised, now_ns=now_ns)
    why = OVER if motor.in_service else LEFT_THE_PLANT
    end_of_motor(
        session, motor.name, [row for row in rows if PART_OF_ALARM[row.kind] not in told], why, now_ns=now_ns
    )


def _latest_recording(session: Session, motor: str) -> str | None:
    """Return the latest recording of a motor that runs, with which its parts were judged."""
    query = select(DiagnosisRow.recording_id).where(
        DiagnosisRow.motor == motor, DiagnosisRow.current, DiagnosisRow.says_nothing.is_(False)
    )
    order = (DiagnosisRow.recorded_ns.desc(), DiagnosisRow.id.desc())
    return session.scalar(query.order_by(*order).limit(1))
