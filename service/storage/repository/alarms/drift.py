"""The alarm of parameters that drift: it follows what the motor's records tell of them."""

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy.orm import Session

from core.tracking.advice import drift_advice, drift_reason
from core.tracking.finding import TrackedParameters, TrackingState
from service.alarms.kinds import AlarmKind
from service.storage.models import AlarmRow, MotorRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.repository.alarms.causes import LEFT_THE_PLANT, end_of_motor, locked_place, raised_at
from service.storage.repository.alarms.changes import locked

SUBJECT: Final = "parameters"
OVER: Final = "the parameters are as in the first records again, or follow from another reference"


def settle_drift_alarm(
    session: Session, motor: MotorRow, document: Mapping[str, Any] | None, *, now_ns: int
) -> None:
    """Make the alarm of a motor's parameters say what its records say. document: of `as_dict`."""
    found = None if document is None else TrackedParameters.from_dict(document)
    drifts = found is not None and found.state is TrackingState.DRIFTING
    if found is not None and drifts and motor.in_service:
        spec = AlarmSpec(
            AlarmKind.PARAMETER_DRIFT,
            reason=drift_reason(found),
            subject=SUBJECT,
            one_of_kind=True,
            advice=drift_advice(found.causes),
        )
        raised_at(session, locked_place(session, AlarmPlace(motor=motor.name)), spec, now_ns=now_ns)
        return
    about = (AlarmRow.motor == motor.name, AlarmRow.kind == AlarmKind.PARAMETER_DRIFT)
    rows = locked(session, *about, is_open())
    why = OVER if motor.in_service else LEFT_THE_PLANT
    end_of_motor(session, motor.name, rows, why, now_ns=now_ns)
