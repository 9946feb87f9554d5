"""Documents of what a recording shows beside the stator: rotor and supply.

Fields that are null are not known (yet).
"""

from core.rotor.finding import RotorState
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from service.api.document import Document, Found, Listed
from service.api.times import Time

Interval = tuple[float, float]


class RotorTrendPoint(Document):
    """What one recording of a motor shows of its rotor's cage. It never says how many bars are broken.

    lower_sideband_dB, upper_sideband_dB: currents at (1 - 2s) f and (1 + 2s) f as measured, over the
    fundamental. severity_dB: asymmetry of the rotor, without what load and inertia do to the sidebands
    (..._ci95: 95 % interval). detection_limit_dB: severity that nine of ten such recordings show. load_bin:
    tenth of 1.2 times the rated load, 0 to 11. duration_s: what was examined. load_oscillation_dB: torque of
    the load that swings at 2 s f, over the rated one.
    """

    time: Time
    recording_id: str
    state: RotorState
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    severity_dB: float | None
    severity_dB_ci95: Interval | None
    detection_limit_dB: float | None
    slip: float | None
    load_level: float | None
    load_bin: int | None
    duration_s: float
    load_oscillation_dB: float | None
    reasons: Listed[str]


class SwingTrendPoint(Document):
    """What one recording of a motor shows of its air gap, and of a load that swings."""

    time: Time
    recording_id: str
    eccentricity: Found[EccentricityFinding]
    pulsation: Found[PulsationFinding]


class RotorLoadBin(Document):
    """The records of one tenth of the rated load, 0 to 11, with the median severity of its first ones."""

    bin: int
    records: int
    baseline_dB: float | None


class RotorOfStart(Document):
    """What the latest start that can tell shows of the cage, beside the latest running record that can.

    agrees: whether both say the same; null where one cannot see what the other shows. words: the comparison.
    """

    recording_id: str
    time: Time
    state: RotorState
    severity_dB: float | None
    agrees: bool | None
    words: str


class RotorCondition(Document):
    """The rotor of a motor, from all its recordings that could tell.

    severity_dB: median of the latest ones. change_dB: against the baseline of the same load. since: first
    recording that shows this state. start: null without a start that can tell. advice: what is to be done.
    """

    motor: str
    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: Interval | None
    change_dB: float | None
    since: Time | None
    bins: Listed[RotorLoadBin]
    start: RotorOfStart | None
    advice: str
    reasons: Listed[str]


class SupplyTrendPoint(Document):
    """What one recording of a motor shows of its supply, and of what the motor draws from it.

    voltage_unbalance_iec: negative over positive sequence. voltage_unbalance_nema: largest deviation of a
    line voltage from their mean, over the mean. derating: share of the rated power that the unbalance leaves
    (NEMA MG-1); null above 5 %, where NEMA gives none. voltage_deviation: mean over rated, minus 1.
    harmonic_voltage_factor: HVF of NEMA MG-1. ..._harmonics: orders 1, 2, 3 ... over the fundamental, of the
    line that is distorted most. What is of the currents is null, or empty, where none flows.
    """

    time: Time
    recording_id: str
    frequency_hz: float
    line_voltages_V: tuple[float, float, float]
    voltage_unbalance_iec: float
    voltage_unbalance_nema: float
    derating: float | None
    voltage_deviation: float
    thd_voltage: float
    harmonic_voltage_factor: float
    voltage_harmonics: Listed[float]
    line_currents_A: tuple[float, float, float] | None
    current_unbalance: float | None
    thd_current: float | None
    current_harmonics: Listed[float]
    active_power_W: float | None
    power_factor: float | None
    duration_s: float
    reasons: Listed[str]
