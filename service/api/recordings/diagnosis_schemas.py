"""Documents of diagnoses. Fields that are null are not known (yet)."""

from collections.abc import Iterable
from typing import Annotated, Literal

from pydantic import AfterValidator, ConfigDict, Field, StringConstraints

from core.diagnosis import methods
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.verdict import Verdict
from core.operation import Operation
from service.api.classification.schemas import Classification
from service.api.document import Document, Listed, RequestDocument
from service.api.rotor_and_supply.schemas import (
    EccentricityFinding,
    PulsationFinding,
    RotorFinding,
    SupplyFigures,
)
from service.api.times import Time
from service.storage.states import JobState


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
    classification: which causes are likely. eccentricity, pulsation: what it shows of the air gap, and of a
    load that swings.
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
    classification: Classification | None = None
    eccentricity: EccentricityFinding | None = None
    pulsation: PulsationFinding | None = None

    @property
    def rotor_slip(self) -> float | None:
        """The slip with which the rotor was examined."""
        return None if self.rotor is None else self.rotor.slip


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
