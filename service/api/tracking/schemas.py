"""Documents of parameters that are followed while motors run. Fields that are null are not known (yet)."""

from core.tracking.advice import NOTHING_TO_DO, drift_advice
from core.tracking.finding import DriftCause, ParameterName, TrackedParameters, TrackingState
from service.api.document import Document, Listed
from service.api.times import Time
from service.storage.records import TrackedPoint

Interval = tuple[float, float]
PARAMETERS = ("stator_resistance", "rotor_resistance", "magnetising_inductance", "leakage_inductance")
NOT_FOLLOWED = "no record of the motor has been followed yet"


class TrackedParameter(Document):
    """One parameter, at the temperature of the first records.

    value: null where it is undetermined. reference: the motor file's. standing: by which fraction the first
    records differ from it, by errors of file and sensors; it is taken out of the value. change: a fraction,
    since the first records (..._ci95: 95 % interval). since: first record of the drift.
    """

    name: ParameterName
    value: float | None
    reference: float
    standing: float | None
    change: float | None
    change_ci95: Interval
    state: TrackingState
    since: Time | None
    reasons: Listed[str]


class TrackedMotor(Document):
    """The parameters of a motor, from all its recordings and starts.

    winding_excess_K: how much hotter the stator winding is than its load explains, against the first records.
    causes: what may have made parameters drift; several where the recordings do not tell them apart.
    advice: what is to be done.
    """

    motor: str
    state: TrackingState
    parameters: Listed[TrackedParameter]
    records: int
    as_of: Time | None
    reference_complete: bool
    winding_excess_K: float | None
    winding_excess_K_ci95: Interval | None
    causes: Listed[DriftCause]
    advice: str
    reasons: Listed[str]


class TrackedChange(Document):
    """Change of one parameter and its 95 % interval, fractions; null before there is a reference."""

    change: float | None
    change_ci95: Interval | None


class TrackedTrendPoint(Document):
    """The changes of a motor's parameters after one of its recordings."""

    time: Time
    recording_id: str
    stator_resistance: TrackedChange
    rotor_resistance: TrackedChange
    magnetising_inductance: TrackedChange
    leakage_inductance: TrackedChange


def tracked_motor(motor: str, found: TrackedParameters | None) -> TrackedMotor:
    """Return the document of a motor's parameters."""
    if found is None:
        return TrackedMotor(
            motor=motor,
            state=TrackingState.UNDETERMINED,
            parameters=[],
            records=0,
            as_of=None,
            reference_complete=False,
            winding_excess_K=None,
            winding_excess_K_ci95=None,
            causes=[],
            advice=NOTHING_TO_DO,
            reasons=[NOT_FOLLOWED],
        )
    document = found.as_dict()
    parameters = [{**one.as_dict(), "since": one.since_ns} for one in found.parameters]
    drifting = found.state is TrackingState.DRIFTING
    return TrackedMotor.model_validate(
        {
            **document,
            "motor": motor,
            "parameters": parameters,
            "as_of": found.as_of_ns,
            "advice": drift_advice(found.causes) if drifting else NOTHING_TO_DO,
        }
    )


def tracked_trend_point(point: TrackedPoint) -> TrackedTrendPoint:
    """Return the document of what follows from one recording."""
    changes = {name: _change(point, name) for name in PARAMETERS}
    return TrackedTrendPoint.model_validate(
        {**changes, "time": point.time_ns, "recording_id": point.recording_id}
    )


def _change(point: TrackedPoint, name: str) -> TrackedChange:
    change: float | None = getattr(point, f"{name}_change")
    margin: float | None = getattr(point, f"{name}_margin")
    if change is None or margin is None:
        return TrackedChange(change=None, change_ci95=None)
    return TrackedChange(change=change, change_ci95=(change - margin, change + margin))
