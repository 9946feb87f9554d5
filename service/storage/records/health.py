"""All that is known of a motor now."""

from dataclasses import dataclass

from service.storage.records.conditions import ConditionEntry
from service.storage.records.diagnoses import LatestDiagnosis
from service.storage.records.plant import IedEntry, MotorEntry
from service.storage.records.recordings import RecordingEntry


@dataclass(frozen=True, slots=True)
class RecordedStarts:
    """The starts from which a motor's parameters can be estimated: how many, and the latest one's time."""

    number: int
    latest_ns: int


@dataclass(frozen=True, slots=True)
class MotorHealth:
    """What is known of a motor now: its condition, its latest recording with the diagnosis, its relay.

    diagnosis: of the latest recording that says anything of the winding.  starts: None without one.
    """

    motor: MotorEntry
    ied: IedEntry
    condition: ConditionEntry
    diagnosis: LatestDiagnosis | None
    last_recording: RecordingEntry | None
    starts: RecordedStarts | None
