"""All that is known of a motor now."""

from dataclasses import dataclass

from service.storage.records.conditions import ConditionEntry
from service.storage.records.diagnoses import LatestDiagnosis
from service.storage.records.plant import IedEntry, MotorEntry
from service.storage.records.recordings import RecordingEntry


@dataclass(frozen=True, slots=True)
class MotorHealth:
    """What is known of a motor now: its condition, its latest recording with the diagnosis, its relay."""

    motor: MotorEntry
    ied: IedEntry
    condition: ConditionEntry
    diagnosis: LatestDiagnosis | None
    last_recording: RecordingEntry | None
