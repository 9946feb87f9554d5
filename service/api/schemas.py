"""Documents of the API. Fields that are null are not known (yet)."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Literal
from uuid import UUID

from pydantic import AfterValidator, BaseModel, ConfigDict, FailFast, Field, StringConstraints, create_model

from core.condition.kinds import Kind, State
from core.diagnosis import methods
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.verdict import Verdict
from core.machines.parameters import ParametersSource
from core.operation import Operation
from service.api.condition_schemas import Condition
from service.api.document import Document, Listed, Person, Reason, RequestDocument
from service.api.examined_schemas import RotorFinding, SupplyFigures
from service.api.relays.schemas import RelayClock
from service.api.times import Time
from service.plant import MeteredQuantity
from service.storage.states import (
    JobState,
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)


def _one_of(known: Iterable[str]) -> AfterValidator:
    """Return a validator that refuses what the core does not know: a job with it could only fail."""
    names = tuple(known)

    def check(name: str) -> str:
        if name not in names:
            raise ValueError(f"expected one of {', '.join(names)}, found {name[:100]!r}")
        return name

    return AfterValidator(check)


Choice = Annotated[str, StringConstraints(max_length=50)]
Method = Annotated[Choice, _one_of(methods.Method), Field(json_schema_extra={"enum": [*methods.Method]})]
Model = Annotated[Choice, _one_of(methods.Model), Field(json_schema_extra={"enum": [*methods.Model]})]


class Site(Document):
    name: str
    description: str


class Motor(Document):
    """A motor; `schedule`, a cron expression in UTC, says when it is recorded without anybody asking.

    parameters_source: where its parameters come from: given in the motors file, commissioned from a recorded
    start, from a data sheet, or typical of its rating. With typical ones the motor is on watch at most.
    """

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None
    parameters_source: ParametersSource


class QualityFinding(Document):
    """One check of the quality gate: the figure it measured, its limit and what that means.

    One that passed and has a message is a warning, such as of a file that departs from its standard.
    """

    name: str
    value: float
    limit: float
    unit: str
    passed: bool
    message: str


class Indicators(Document):
    """Model-free figures of the line quantities, for comparison beside the fit."""

    current_unbalance: float
    voltage_unbalance: float
    negative_sequence_current_A: float
    negative_sequence_impedance_ohm: float
    park_axis_ratio: float
    park_axis_angle_deg: float


class FittedParameters(Document):
    """The hypothesis that explains the currents best; `recordings/{recording_id}/model` draws it.

    It is not the verdict: mu_f may lie within chance, or below zero.
    """

    mu_f: float
    theta_f: Literal[0, 1, 2]
    load_level: float
    time_offset_s: float
    path_ratio: float


class Diagnosis(Document):
    """The result for one recording, as `mcc diagnose --json` prints it.

    mu_f: equivalent fault level, fraction of the phase turns. theta_f: 0, 1, 2 = winding on terminals
    a, b, c. load_level: load torque over rated torque. ..._ci95: 95 % interval from noise, sensors and
    parameters. ..._scatter95: from the record's own scatter alone. speed_rpm: of the shaft, from the fit.
    detection_limit: nine of ten such recordings show a fault of that mu_f. currents_only: the voltages are
    assumed. operation: what the motor does in the recording. rotor, supply: what it shows of them.
    Diagnoses of earlier versions lack some: of those that knew only the scatter, ..._ci95 is null.
    """

    verdict: Verdict
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    mu_f_scatter95: tuple[float, float] | None = None
    detection_limit: float | None = None
    theta_f: int | None
    phase: Literal["a", "b", "c"] | None
    load_level: float | None
    time_offset_s: float | None
    residual_rms_A: float | None
    evaluations: int
    compute_seconds: float
    quality: Listed[QualityFinding]
    reasons: Listed[str]
    model: str
    method: str
    load_level_ci95: tuple[float, float] | None = None
    load_level_scatter95: tuple[float, float] | None = None
    speed_rpm: float | None = None
    indicators: Indicators | None = None
    currents_only: bool = False
    operation: Operation | None = None
    fit: FittedParameters | None = None
    rotor: RotorFinding | None = None
    supply: SupplyFigures | None = None

    @property
    def rotor_slip(self) -> float | None:
        """The slip with which the rotor was examined."""
        return None if self.rotor is None else self.rotor.slip


class EventReport(Document):
    """A recording request: somebody, or the motor's schedule, asked a relay for a recording.

    It has the time of each state it went through.
    """

    id: str
    motor: str
    ied: str
    origin: RecordingRequestOrigin
    state: RecordingRequestState
    reason: str | None
    recording_id: str | None
    requested_time: Time = Field(validation_alias="requested_ns")
    triggered_time: Time | None = Field(validation_alias="triggered_ns")
    recorded_time: Time | None = Field(validation_alias="recorded_ns")
    fetched_time: Time | None = Field(validation_alias="fetched_ns")
    diagnosed_time: Time | None = Field(validation_alias="diagnosed_ns")
    failed_time: Time | None = Field(validation_alias="failed_ns")


class Recording(RelayClock):
    """A recording. `recorded_time` is the trigger time written in the record, known once it was read.

    operation: what the motor does in it; null while nobody has looked, or it cannot be told.
    operation_remark: why the motor's parameters cannot be estimated from this start.
    That time is the relay's; `clock_...` is the latest comparison of its clock when the recording was stored,
    null where that was not made within an hour of it.
    """

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    size_bytes: int
    state: RecordingState
    reason: str | None
    operation: Operation | None
    operation_remark: str | None
    announced_time: Time = Field(validation_alias="announced_ns")
    fetched_time: Time | None = Field(validation_alias="fetched_ns")
    recorded_time: Time | None = Field(validation_alias="recorded_ns")


class ListedRecording(Recording):
    """A recording with the verdict of its latest diagnosis; null without one."""

    verdict: Verdict | None = None


class BaselineRequest(RequestDocument):
    """The recordings that stand for a motor's healthy condition.

    reason, by: why they do, and who says so; needed where a recording is in doubt.
    """

    recording_ids: Annotated[set[UUID], Field(min_length=3, max_length=100), FailFast()]
    reason: Reason | None = None
    by: Person | None = None


class BaselineDoubt(Document):
    """What spoke against a recording as one of a healthy motor when it was chosen."""

    recording_id: str
    doubt: str


class Baseline(Document):
    """The motor's healthy recordings; empty where it has no baseline.

    When they were chosen, why and by whom, where that was said, and which of them were in doubt.
    """

    recordings: Listed[Recording]
    chosen_time: Time | None = Field(validation_alias="chosen_ns")
    reason: str | None
    by: str | None
    doubts: Listed[BaselineDoubt]


class RecordingFile(Document):
    name: str
    size_bytes: int
    sha256: str


class RecordingDetails(Recording):
    """A recording with its files and its latest diagnosis."""

    files: Listed[RecordingFile]
    diagnosis: Diagnosis | None


class DiagnosisRun(Document):
    """A diagnosis asked for: queued, running, done with its `result`, or failed with its `error`.

    started_time, finished_time: of the latest attempt.
    """

    id: str
    recording_id: str
    method: str
    model: str
    state: JobState
    attempts: int
    error: str | None
    created_time: Time = Field(validation_alias="created_ns")
    started_time: Time | None = Field(validation_alias="started_ns")
    finished_time: Time | None = Field(validation_alias="finished_ns")
    result: Diagnosis | None = None


class DiagnosisRequest(RequestDocument):
    """How to diagnose: the optimiser and the machine model."""

    model_config = ConfigDict(extra="forbid")

    method: Method = DEFAULT_METHOD
    model: Model = DEFAULT_MODEL


class RecordedStarts(Document):
    """The starts of a motor from which its parameters can be estimated: how many, and the latest one's time.

    advice: the command that does it; null where the motor's parameters were estimated already.
    """

    number: int
    latest_time: Time = Field(validation_alias="latest_ns")
    advice: str | None


class Health(Document):
    """What is known of a motor now: its condition, the diagnosis of its latest recording, its relay's link.

    What is said of verdict, level, phase, load and reasons beside the condition repeats the diagnosis; null
    and empty before the first one. Recordings in which the motor stands, starts, stops or trips say nothing
    of it, and are told by last_recording alone. starts: those among them that its parameters follow from.
    stood_time: when the motor was last seen to stand still.
    """

    motor: str
    site: str
    ied: str
    condition: Condition
    parameters_source: ParametersSource
    verdict: Verdict | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    mu_f_scatter95: tuple[float, float] | None
    detection_limit: float | None
    phase: Literal["a", "b", "c"] | None
    load_level: float | None
    load_level_ci95: tuple[float, float] | None
    reasons: Listed[str]
    recording_id: str | None
    recorded_time: Time | None
    link_state: LinkState
    link_reason: str | None
    last_success_time: Time | None
    last_recording: Recording | None
    starts: RecordedStarts | None
    stood_time: Time | None


class ListedMotor(Motor):
    """A motor in a list, with its health where that was asked for."""

    health: Health | None = None


class TrendPoint(Document):
    """One recording's figure; `value` is null where the recording does not tell it.

    ci95: 95 % interval from noise, sensors and parameters, of all but theta_f. Of mu_f only: scatter95, from
    the record's own scatter alone; detection_limit, the level that nine of ten such recordings show.
    verdict: of the recording alone; null, and replaced by state, kind and phase, where the figure is one of
    the motor's condition from that recording on.
    """

    time: Time = Field(validation_alias="recorded_ns")
    value: float | None
    ci95: tuple[float, float] | None
    scatter95: tuple[float, float] | None
    detection_limit: float | None
    verdict: Verdict | None
    recording_id: str
    state: State | None = None
    kind: Kind | None = None
    phase: Literal["a", "b", "c"] | None = None


class MeasurementTime(Document):
    """When it was measured: at `time`, or `samples` times from then on."""

    time: Time = Field(validation_alias="time_ns")
    samples: int


if TYPE_CHECKING:
    _Measurement = MeasurementTime
else:
    _Measurement = create_model(
        "_Measurement",
        __base__=MeasurementTime,
        **{quantity.value: (float | None, ...) for quantity in MeteredQuantity},
    )


class Measurement(_Measurement):
    """What the relay measured: at `time`, or means of `samples` values from then on."""


class Status(BaseModel):
    status: Literal["ok", "ready"]
    parts: dict[str, str] = {}
