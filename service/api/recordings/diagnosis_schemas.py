"""Documents of diagnoses. Fields that are null are not known (yet)."""

from collections.abc import Iterable
from typing import Annotated, Literal

from pydantic import AfterValidator, ConfigDict, Field, StringConstraints

from core.diagnosis import methods
from core.diagnosis.causes import Cause
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.verdict import Verdict
from core.losses.figures import LossFigures
from core.operation import Operation
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.speed.finding import SpeedFinding
from core.supply.figures import SupplyFigures
from service.api.classification.schemas import Classification
from service.api.document import Document, Found, Listed, RequestDocument
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

    It is not the verdict: mu_f may lie within chance, or below zero. leakage: of the shorted turns, 1 where
    they have it to themselves. axis_rad: from the phase's axis to the coil's, positive as the field turns.
    linkage: field that a turn of the coil links, over that of the phase's mean turn.
    """

    mu_f: float
    theta_f: Literal[0, 1, 2]
    load_level: float
    time_offset_s: float
    leakage: float
    axis_rad: float
    linkage: float


class Hypothesis(Document):
    """One cause that the record's phasors were weighed for; the causes of a record exclude one another.

    log_likelihood_ratio: log of the likelihood of the record with this cause over that of a healthy motor.
    figure: what was measured of it, in words.
    """

    cause: Cause
    probability: float
    log_likelihood_ratio: float
    figure: str


class Diagnosis(Document):
    """The result for one recording, as `mcc diagnose --json` prints it.

    mu_f: equivalent fault level, fraction of the phase turns. theta_f: 0, 1, 2 = winding on terminals
    a, b, c; it and phase are null where no phase is named, which takes 0.95 of phase_probabilities.
    load_level: load torque over rated torque. ..._ci95: 95 % interval from noise, sensors, parameters, and
    what is not known of the turns. ..._scatter95: from the record's own scatter alone. speed_rpm: of the
    shaft, from the fit. detection_limit: nine of ten such recordings show a fault of that mu_f.
    currents_only: the voltages are assumed. operation: what the motor does in the recording.
    phase_probabilities: that shorted turns, if there are any, lie in the winding on terminal a, b, c; null of
    a motor with slip rings. hypotheses: the causes that the phasors were weighed for, the likeliest first.
    rotor, supply: what it shows of them. classification: which causes are likely, by all that was examined.
    eccentricity, pulsation: what it shows of the air gap, and of a load that swings. speed: of the shaft, as
    seen in the current or by the model. losses: with the efficiency, and what faults add to them.
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
    phase_probabilities: tuple[float, float, float] | None = None
    hypotheses: Listed[Hypothesis] = Field(default_factory=list)
    rotor: Found[RotorFinding] | None = None
    supply: Found[SupplyFigures] | None = None
    classification: Classification | None = None
    eccentricity: Found[EccentricityFinding] | None = None
    pulsation: Found[PulsationFinding] | None = None
    speed: Found[SpeedFinding] | None = None
    losses: Found[LossFigures] | None = None

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
    """How to diagnose: the method and the fault model.

    A search goes with a model of the thesis: with `coil`, `split-winding` is taken. The evidence goes with
    `coil`: with another model, `hybrid` is taken.
    """

    model_config = ConfigDict(extra="forbid")

    method: Method = DEFAULT_METHOD
    model: Model = DEFAULT_MODEL
