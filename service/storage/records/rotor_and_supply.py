"""What recordings show beside their diagnosis, as the repository hands it out."""

from dataclasses import dataclass
from enum import StrEnum

from core.losses.figures import LossFigures
from core.rotor.finding import RotorFinding
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.supply.figures import SupplyFigures


@dataclass(frozen=True, slots=True)
class RotorEntry:
    """What a recording shows of its motor's rotor."""

    recording_id: str
    motor: str
    time_ns: int
    finding: RotorFinding


@dataclass(frozen=True, slots=True)
class SupplyEntry:
    """What a recording shows of its motor's supply."""

    recording_id: str
    motor: str
    time_ns: int
    figures: SupplyFigures


@dataclass(frozen=True, slots=True)
class LossEntry:
    """What a recording tells of its motor's losses."""

    recording_id: str
    motor: str
    time_ns: int
    figures: LossFigures


@dataclass(frozen=True, slots=True)
class UnbalanceEntry:
    """Unbalance of voltage and current in a motor's latest recording that tells it (V2 / V1, I2 / I1)."""

    motor: str
    time_ns: int
    voltage_unbalance_iec: float
    current_unbalance: float | None


@dataclass(frozen=True, slots=True)
class SwingEntry:
    """What a recording shows of its motor's air gap, and of a load that swings."""

    recording_id: str
    motor: str
    time_ns: int
    eccentricity: EccentricityFinding
    pulsation: PulsationFinding


class SupplyQuantity(StrEnum):
    """A figure of the supply that records are counted by. The words are the names of its columns."""

    THD_VOLTAGE = "thd_voltage"
    HARMONIC_VOLTAGE_FACTOR = "harmonic_voltage_factor"


@dataclass(frozen=True, slots=True)
class RecordsBeyond:
    """Records that tell a figure, and those above a limit. worst: the largest value; None without records."""

    records: int
    beyond: int
    worst: float | None
