"""Recorded starts as the repository hands them out."""

from dataclasses import dataclass

from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart


@dataclass(frozen=True, slots=True)
class StartEntry:
    """A recorded start of a motor, and what it shows."""

    recording_id: str
    motor: str
    time_ns: int
    examined: ExaminedStart

    @property
    def start(self) -> MotorStart:
        """The figures."""
        return self.examined.figures
