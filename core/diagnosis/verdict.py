"""What the diagnosis says of one recording; the shape of `mcc diagnose --json`."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from core.quality.finding import QualityFinding


class Verdict(StrEnum):
    HEALTHY = "healthy"
    WATCH = "watch"
    FAULT = "fault"
    UNDIAGNOSABLE = "undiagnosable"


@dataclass(frozen=True, slots=True)
class Indicators:
    """Of the line quantities, in the supply's own sequence.

    current_unbalance, voltage_unbalance: |I2| / |I1|, |V2| / |V1|.
    negative_sequence_current_A: |I2|, rms.  negative_sequence_impedance_ohm: |V2| / |I2|.
    park_axis_ratio: minor over major axis of the current's ellipse on the Clarke axes; 1 is a circle.
    park_axis_angle_deg: of the major axis against phase a, -90 to 90.
    """

    current_unbalance: float
    voltage_unbalance: float
    negative_sequence_current_A: float
    negative_sequence_impedance_ohm: float
    park_axis_ratio: float
    park_axis_angle_deg: float

    def as_dict(self) -> dict[str, float]:
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """The result for one recording. Figures are None where the quality gate refused the recording.

    mu_f: equivalent fault level, fraction of the phase turns, with its 95 % interval.
    theta_f: 0, 1, 2 = winding on terminals a, b, c; None unless shorted turns are found; `phase` likewise.
    load_level: load torque over rated torque.  time_offset_s: delay of the currents against the voltages.
    residual_rms_A: rms of measured minus modelled current over both Clarke axes.
    speed_rpm: of the shaft, from the fit.  detection_limit: least mu_f this recording would have shown.
    indicators: model-free figures beside the fit.  currents_only: the voltages are assumed, none were used.
    """

    verdict: Verdict
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    theta_f: Literal[0, 1, 2] | None
    load_level: float | None
    time_offset_s: float | None
    residual_rms_A: float | None
    evaluations: int
    compute_seconds: float
    quality: tuple[QualityFinding, ...]
    reasons: tuple[str, ...]
    model: str
    method: str
    load_level_ci95: tuple[float, float] | None = None
    speed_rpm: float | None = None
    detection_limit: float | None = None
    indicators: Indicators | None = None
    currents_only: bool = False

    @property
    def phase(self) -> Literal["a", "b", "c"] | None:
        phases: tuple[Literal["a", "b", "c"], ...] = ("a", "b", "c")
        return None if self.theta_f is None else phases[self.theta_f]

    def as_dict(self) -> dict[str, object]:
        """The document `mcc diagnose --json` prints; its keys are a contract."""
        return {
            "verdict": str(self.verdict),
            "mu_f": self.mu_f,
            "mu_f_ci95": None if self.mu_f_ci95 is None else list(self.mu_f_ci95),
            "theta_f": self.theta_f,
            "phase": self.phase,
            "load_level": self.load_level,
            "time_offset_s": self.time_offset_s,
            "residual_rms_A": self.residual_rms_A,
            "evaluations": self.evaluations,
            "compute_seconds": self.compute_seconds,
            "quality": [finding.as_dict() for finding in self.quality],
            "reasons": list(self.reasons),
            "model": self.model,
            "method": self.method,
            "load_level_ci95": None if self.load_level_ci95 is None else list(self.load_level_ci95),
            "speed_rpm": self.speed_rpm,
            "detection_limit": self.detection_limit,
            "indicators": None if self.indicators is None else self.indicators.as_dict(),
            "currents_only": self.currents_only,
        }
