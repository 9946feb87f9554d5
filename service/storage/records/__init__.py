"""What the repository hands out: plain values, free of the database session they were read in."""

from service.storage.records.deletions import Amount, DeletedRows, Deletion
from service.storage.records.diagnoses import (
    ClaimedJob,
    Counts,
    DiagnosisEntry,
    Job,
    JobResult,
    LatestDiagnosis,
    MotorHealth,
    Quantity,
    TrendPoint,
    interval_of,
)
from service.storage.records.measurements import Measurement, Sample
from service.storage.records.pages import Cursor, Page
from service.storage.records.plant import IedEntry, MotorEntry, SiteEntry
from service.storage.records.recordings import RecordingEntry, RecordingFile, RecordingRequest, RemoteRecord
from service.storage.records.relays import (
    Alarm,
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
    "Alarm",
    "Amount",
    "ClaimedJob",
    "ClockReading",
    "Counts",
    "Cursor",
    "DeletedRows",
    "Deletion",
    "DiagnosisEntry",
    "GatewayEntry",
    "IedEntry",
    "Job",
    "JobResult",
    "LatestDiagnosis",
    "LinkChange",
    "LinkFigures",
    "LinkNote",
    "LinkTraffic",
    "Measurement",
    "MotorEntry",
    "MotorHealth",
    "Page",
    "Quantity",
    "Quarantine",
    "RecordingEntry",
    "RecordingFile",
    "RecordingRequest",
    "RelayFindings",
    "RemoteRecord",
    "Sample",
    "SiteEntry",
    "TrendPoint",
    "interval_of",
]
