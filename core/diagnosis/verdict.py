"""What the diagnosis says of one recording; the shape of `mcc diagnose --json`."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from typing import Literal

from core.diagnosis.causes import Cause
from core.operation import Operation
from core.quality.finding import QualityFinding

RELATIVE = "relative to a baseline of"
"""So begins the reason that tells of a baseline."""


class Verdict(StrEnum):
    """What the diagnosis makes of one recording."""

    HEALTHY = "healthy"
    WATCH = "watch"
    FAULT = "fault"
    UNDIAGNOSABLE = "undiagnosable"


@dataclass(frozen=True, slots=True)
class Indicators:
    """Model-free figures of the line quantities, in the supply's own sequence.

    Parameters
    ----------
    current_unbalance : float
        |I2| / |I1|.
    voltage_unbalance : float
        |V2| / |V1|.
    negative_sequence_current_A : float
        |I2|, rms [A].
    negative_sequence_impedance_ohm : float
        |V2| / |I2| [ohm].
    park_axis_ratio : float
        Minor over major axis of the current's ellipse on the Clarke axes; 1 is a circle.
    park_axis_angle_deg : float
        Angle of the major axis against phase a, -90 to 90 [deg].
    """

    current_unbalance: float
    voltage_unbalance: float
    negative_sequence_current_A: float
    negative_sequence_impedance_ohm: float
    park_axis_ratio: float
    park_axis_angle_deg: float

    def as_dict(self) -> dict[str, float]:
        """Return the figures as JSON takes them."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


@dataclass(frozen=True, slots=True)
class FittedParameters:
    """The hypothesis that explains the currents best, with which `core.diagnosis.replay` draws them again.

    It is not the verdict: its level may lie within chance, and load and time offset may be those of another
    hypothesis than the diagnosis reports.

    Parameters
    ----------
    mu_f : float
        Equivalent fault level, a fraction of the phase turns; it may come out below zero.
    theta_f : {0, 1, 2}
        Winding on terminals a, b, c.
    load_level : float
        Load torque over rated torque.
    time_offset_s : float
        Delay of the currents against the voltages [s].
    leakage : float
        Leakage psi of the shorted turns: 1 where they have it to themselves and nothing but their own
        resistance in their way.
    axis_rad : float
        Angle from the phase's axis to that of the coil, positive as the field turns: in the frame of the
        windings, which mirrors an a-c-b supply [rad].
    linkage : float
        Field that a turn of the coil links, over that of the phase's mean turn.
    """

    mu_f: float
    theta_f: Literal[0, 1, 2]
    load_level: float
    time_offset_s: float
    leakage: float
    axis_rad: float
    linkage: float

    def as_dict(self) -> dict[str, float]:
        """Return the parameters as JSON takes them.

        Returns
        -------
        dict of str to float
            The parameters by name.
        """
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """One cause that was weighed.

    Parameters
    ----------
    cause : Cause
        The cause; those of a record exclude one another.
    probability : float
        Its probability after the evidence.
    log_likelihood_ratio : float
        Log of the likelihood of the record's figures with it to that of a healthy motor [nats].
    figure : str
        What was measured of it, in words.
    """

    cause: Cause
    probability: float
    log_likelihood_ratio: float
    figure: str

    def as_dict(self) -> dict[str, object]:
        """Return the hypothesis as JSON takes it."""
        return {
            "cause": str(self.cause),
            "probability": self.probability,
            "log_likelihood_ratio": self.log_likelihood_ratio,
            "figure": self.figure,
        }


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """The result for one recording; figures are None where the quality gate refused it.

    Parameters
    ----------
    verdict : Verdict
        The verdict.
    mu_f : float or None
        Equivalent fault level, a fraction of the phase turns.
    mu_f_ci95 : tuple of float or None
        Its 95 % interval from all causes: noise, sensors, parameters, and the axis and leakage of the turns.
    theta_f : {0, 1, 2} or None
        Winding with the fault: 0, 1, 2 for the one on terminals a, b, c; None unless shorted turns are found
        and their phase has a probability of at least 0.95.
    load_level : float or None
        Load torque over rated torque.
    time_offset_s : float or None
        Delay of the currents against the voltages [s].
    residual_rms_A : float or None
        Measured minus modelled current, rms over both Clarke axes [A].
    evaluations : int
        Number of simulated candidates or evaluated points.
    compute_seconds : float
        Time of the diagnosis [s].
    quality : tuple of QualityFinding
        Findings of the quality gate.
    reasons : tuple of str
        Reasons of the verdict in words.
    model : str
        Fault model that was used.
    method : str
        Method that was used.
    mu_f_scatter95 : tuple of float or None, optional
        95 % interval of the level from the record's own scatter alone: how well it repeats.
    load_level_ci95 : tuple of float or None, optional
        95 % interval of the load level from all causes.
    load_level_scatter95 : tuple of float or None, optional
        95 % interval of the load level from the record's own scatter alone.
    speed_rpm : float or None, optional
        Speed of the shaft, from the fit [rpm].
    detection_limit : float or None, optional
        Level of which nine of ten such recordings show a fault.
    indicators : Indicators or None, optional
        Model-free figures beside the fit.
    currents_only : bool, default False
        Whether the voltages are assumed and none were used.
    operation : Operation or None, optional
        What the motor does in the recording; None where that cannot be told.
    fit : FittedParameters or None, optional
        The hypothesis behind `residual_rms_A`.
    phase_probabilities : tuple of float or None, optional
        Probability that shorted turns, if there are any, lie in the winding on terminal a, b, c; None of a
        motor with slip rings, whose records do not tell.
    hypotheses : tuple of Hypothesis, optional
        All causes that were weighed, the likeliest first.
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
    mu_f_scatter95: tuple[float, float] | None = None
    load_level_ci95: tuple[float, float] | None = None
    load_level_scatter95: tuple[float, float] | None = None
    speed_rpm: float | None = None
    detection_limit: float | None = None
    indicators: Indicators | None = None
    currents_only: bool = False
    operation: Operation | None = None
    fit: FittedParameters | None = None
    phase_probabilities: tuple[float, float, float] | None = None
    hypotheses: tuple[Hypothesis, ...] = ()

    @property
    def phase(self) -> Literal["a", "b", "c"] | None:
        """Phase with the fault: "a", "b", "c"; None where it is not named."""
        phases: tuple[Literal["a", "b", "c"], ...] = ("a", "b", "c")
        return None if self.theta_f is None else phases[self.theta_f]

    def as_dict(self) -> dict[str, object]:
        """Return the document that `mcc diagnose --json` prints; its keys are a contract.

        Returns
        -------
        dict of str to object
            The document.
        """
        return {
            "verdict": str(self.verdict),
            "mu_f": self.mu_f,
            "mu_f_ci95": _listed(self.mu_f_ci95),
            "mu_f_scatter95": _listed(self.mu_f_scatter95),
            "detection_limit": self.detection_limit,
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
            "load_level_ci95": _listed(self.load_level_ci95),
            "load_level_scatter95": _listed(self.load_level_scatter95),
            "speed_rpm": self.speed_rpm,
            "indicators": None if self.indicators is None else self.indicators.as_dict(),
            "currents_only": self.currents_only,
            "operation": None if self.operation is None else str(self.operation),
            "fit": None if self.fit is None else self.fit.as_dict(),
            "phase_probabilities": _listed(self.phase_probabilities),
            "hypotheses": [one.as_dict() for one in self.hypotheses],
        }


def is_relative(reasons: Iterable[str]) -> bool:
    """Tell whether a diagnosis was made relative to a baseline.

    Parameters
    ----------
    reasons : iterable of str
        The reasons of the diagnosis.

    Returns
    -------
    bool
        Whether one of them says so.
    """
    return any(reason.startswith(RELATIVE) for reason in reasons)


def not_finite(document: object) -> str | None:
    """Return the way to the first number of a document that is infinite, no number, or too large for a float.

    Parameters
    ----------
    document : object
        Mappings, lists, numbers and texts, as JSON takes them.

    Returns
    -------
    str or None
        Keys and indices with dots between, such as "indicators.current_unbalance"; None where all numbers are
        finite.
    """
    left: list[tuple[str, object]] = [("", document)]
    while left:
        way, value = left.pop()
        if isinstance(value, Mapping):
            left += [(f"{way}.{key}", one) for key, one in reversed([*value.items()])]
        elif isinstance(value, list | tuple):
            left += [(f"{way}.{number}", value[number]) for number in reversed(range(len(value)))]
        elif isinstance(value, int | float) and not _is_finite(value):
            return way.removeprefix(".") or "the document"
    return None


def _is_finite(value: float) -> bool:
    try:
        return isfinite(value)
    except OverflowError:  # an integer without a float
        return False


def _listed(values: tuple[float, ...] | None) -> list[float] | None:
    return None if values is None else list(values)
