"""What the repository hands out: plain values, free of the database session they were read in."""

from service.storage.records.actors import SERVICE, Actor, Role
from service.storage.records.alarms import Alarm, AlarmChange, AlarmPlace, AlarmSpec
from service.storage.records.backups import BackupEntry
from service.storage.records.baselines import BaselineDoubt, BaselineEntry
from service.storage.records.conditions import (
    Backlog,
    BusMotor,
    Checkpoint,
    ConditionChange,
    ConditionEntry,
    ConditionEvent,
    ConditionFigures,
    ConditionPoint,
    FoldInput,
    FoldResult,
    MotorVersion,
    RecordObservation,
    ToObserve,
)
from service.storage.records.deletions import Amount, DeletedRows, Deletion
from service.storage.records.diagnoses import (
    ClaimedJob,
    Counts,
    DiagnosisEntry,
    Job,
    JobResult,
    LatestDiagnosis,
    LatestFigures,
    Quantity,
    TrendPoint,
    interval_of,
)
from service.storage.records.health import MotorHealth, RecordedStarts
from service.storage.records.measurements import Measurement, Sample
from service.storage.records.pages import Cursor, Page
from service.storage.records.plant import IedEntry, MotorEntry, SiteEntry
from service.storage.records.recordings import RecordingEntry, RecordingFile, RecordingRequest, RemoteRecord
from service.storage.records.relays import (
    ClockReading,
    GatewayEntry,
    LinkChange,
    LinkFigures,
    LinkNote,
    LinkTraffic,
    Quarantine,
    RelayFindings,
)

__all__ = [
    "SERVICE",
    "Actor",
    "Alarm",
    "AlarmChange",
    "AlarmPlace",
    "AlarmSpec",
    "Amount",
    "Backlog",
    "BackupEntry",
    "BaselineDoubt",
    "BaselineEntry",
    "BusMotor",
    "Checkpoint",
    "ClaimedJob",
    "ClockReading",
    "ConditionChange",
    "ConditionEntry",
    "ConditionEvent",
    "ConditionFigures",
    "ConditionPoint",
    "Counts",
    "Cursor",
    "DeletedRows",
    "Deletion",
    "DiagnosisEntry",
    "FoldInput",
    "FoldResult",
    "GatewayEntry",
    "IedEntry",
    "Job",
    "JobResult",
    "LatestDiagnosis",
    "LatestFigures",
    "LinkChange",
    "LinkFigures",
    "LinkNote",
    "LinkTraffic",
    "Measurement",
    "MotorEntry",
    "MotorHealth",
    "MotorVersion",
    "Page",
    "Quantity",
    "Quarantine",
    "RecordObservation",
    "RecordedStarts",
    "RecordingEntry",
    "RecordingFile",
    "RecordingRequest",
    "RelayFindings",
    "RemoteRecord",
    "Role",
    "Sample",
    "SiteEntry",
    "ToObserve",
    "TrendPoint",
    "interval_of",
]
