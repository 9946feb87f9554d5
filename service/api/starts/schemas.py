"""Documents of starts. Fields that are null are not known (yet)."""

from typing import Literal

from core.rotor.finding import RotorState
from core.starts.compared import ChangeState, StartCause
from service.api.document import Document, Listed
from service.api.times import Time
from service.storage.states import StartSource

Interval = tuple[float, float]


class StartChange(Document):
    """One figure beside the reference: its value, that of the reference, and the change with its interval.

    change: a share of the reference; of the load, of the rated torque.
    """

    value: float
    reference: float
    change: float
    ci95: Interval


class StartComparison(Document):
    """How starts differ from the reference, and why.

    causes: those that are told. possible: those that are not told apart. voltage_effect, load_effect: shares
    by which voltage or load alone makes the run-up longer, ends of the 95 % interval.
    """

    state: ChangeState
    causes: Listed[StartCause]
    possible: Listed[StartCause]
    changes: dict[Literal["acceleration", "voltage", "load", "rotor", "warmth"], StartChange]
    voltage_effect: Interval | None
    load_effect: Interval | None
    reasons: Listed[str]


class StartSummary(Document):
    """A start. Its figures are defined in docs/reference/operations.md.

    source: what tells of it. recording_id: null for a start that the relay's report alone tells. from_report:
    figures that the recording does not show, and the relay's report of the same start tells.
    mean_current_A: root of the mean square over the acceleration time.
    share_of_hot_limit: I2t over what the rotor withstands from running temperature. starts_within_hour: in
    the hour that ends with this start; starts_allowed: what the motor file allows.
    comparison: null for the starts of the reference, and for reported ones beside a recorded reference.
    """

    id: str
    source: StartSource
    recording_id: str | None
    time: Time
    is_from_rest: bool
    is_reference: bool
    acceleration_s: float | None
    peak_current_A: float
    mean_current_A: float | None
    crest_current_A: float
    running_current_A: float | None
    lowest_voltage_V: float | None
    i2t_A2s: float
    i2t_over_s: float
    from_report: Listed[str]
    share_of_hot_limit: float | None
    starts_within_hour: int
    starts_allowed: int | None
    mean_torque_Nm: float | None
    load_torque_Nm: float | None
    load_torque_Nm_ci95: Interval | None
    rotor_state: RotorState | None
    comparison: StartComparison | None


class StartCurve(Document):
    """Rms current and line voltage over one cycle or several, from the switching on."""

    first_s: float
    step_s: float
    current_A: Listed[float]
    voltage_V: Listed[float] | None


class StartTorqueDetails(Document):
    """Torque of the air gap and speed over the synchronous one, from the switching on, and the load."""

    first_s: float
    step_s: float
    torque_Nm: Listed[float]
    speed: Listed[float | None]
    rated_torque_Nm: float
    impulse_Nms: float
    mean_torque_Nm: float
    torque_at_rated_voltage_Nm: float
    momentum_Nms: float | None
    momentum_tolerance: float
    load_torque_Nm: float | None
    load_torque_Nm_ci95: Interval | None
    running_torque_Nm: float | None


class StartParametersDetails(Document):
    """Parameters by this start; those without an interval were held at the motor's."""

    values: dict[str, float]
    ci95: dict[str, Interval]
    load_level: float
    load_level_ci95: Interval | None
    load_law: str
    residual_share: float
    warnings: Listed[str]


class StartSidebandDetails(Document):
    """The rotor's asymmetry by the lower sideband's path through the start."""

    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: tuple[float | None, float] | None
    detection_limit_dB: float | None
    stretches: int
    reasons: Listed[str]


class StartStressDetails(Document):
    """Heating of the start against what the rotor withstands, hot and cold."""

    hot_limit_A2s: float | None
    cold_limit_A2s: float | None
    share_of_hot: float | None
    share_of_cold: float | None
    source: str
    starts_per_hour: int | None


class StartDetails(StartSummary):
    """A start with its curves and all that the motor's model tells of it."""

    curve: StartCurve
    torque: StartTorqueDetails | None
    parameters: StartParametersDetails | None
    sideband: StartSidebandDetails | None
    stress: StartStressDetails | None
    remark: str | None
