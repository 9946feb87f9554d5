"""What recordings show beside their diagnosis, as the repository hands it out."""

from dataclasses import dataclass

from core.rotor.finding import RotorFinding
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
