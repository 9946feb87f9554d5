"""What the repository hands out: plain values, free of the database session they were read in."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

from core.diagnosis.verdict import Verdict
from service.storage.states import EventReportState, JobState, LinkState, RecordingSource, RecordingState

T = TypeVar("T")

Cursor = tuple[str | int, ...]
"""Sort key of the last item of a page."""

Quantity = Literal["mu_f", "theta_f", "load_level"]


@dataclass(frozen=True, slots=True)
class Page(Generic[T]):
    """Some items of a list; `next` is where the next page starts, None at the end."""

    items: tuple[T, ...]
    next: Cursor | None


@dataclass(frozen=True, slots=True)
class SiteEntry:
    name: str
    description: str


@dataclass(frozen=True, slots=True)
class IedEntry:
    """A relay and the state of its link; `last_success_ns` is the last request it answered."""

    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    link_state: LinkState
    link_reason: str | None
    link_changed_ns: int | None
    last_success_ns: int | None


@dataclass(frozen=True, slots=True)
class MotorEntry:
    name: str
    description: str
    site: str
    ied: str


@dataclass(frozen=True, slots=True)
class EventReport:
    """An event report somebody asked for. One time for each state it went through."""

    id: str
    motor: str
    ied: str
    state: EventReportState
    reason: str | None
    recording_id: str | None
    requested_ns: int
    triggered_ns: int | None
    recorded_ns: int | None
    fetched_ns: int | None
    diagnosed_ns: int | None
    failed_ns: int | None


@dataclass(frozen=True, slots=True)
class RemoteRecord:
    """A record as a relay lists it: name without suffix, sum of its file sizes, their latest modification."""

    name: str
    size_bytes: int
    modified_ns: int


@dataclass(frozen=True, slots=True)
class RecordingEntry:
    """A recording; `digest` is its place in the recording store, None until it is fetched.

    recorded_ns: the trigger time written in the record, known once it was read.
    """

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    digest: str | None
    size_bytes: int
    remote_modified_ns: int | None
    state: RecordingState
    reason: str | None
    attempts: int
    announced_ns: int
    fetched_ns: int | None
    recorded_ns: int | None


@dataclass(frozen=True, slots=True)
class RecordingFile:
    name: str
    size_bytes: int
    sha256: str


@dataclass(frozen=True, slots=True)
class Job:
    """A diagnosis to be made, under way, or made."""

    id: str
    recording_id: str
    method: str
    model: str
    state: JobState
    attempts: int
    not_before_ns: int
    created_ns: int
    started_ns: int | None
    finished_ns: int | None
    error: str | None


@dataclass(frozen=True, slots=True)
class ClaimedJob:
    """A job with what the worker needs: the motor's name, the digest of the recording's files, and those of
    the motor's baseline."""

    job: Job
    motor: str
    digest: str
    baseline: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class DiagnosisEntry:
    """The result of a job; `document` is `Diagnosis.as_dict()`."""

    id: str
    job_id: str
    recording_id: str
    motor: str
    current: bool
    created_ns: int
    recorded_ns: int
    verdict: Verdict
    document: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class TrendPoint:
    """One recording's figure. `ci95` only for mu_f; `value` is None where the recording does not tell it."""

    recorded_ns: int
    value: float | None
    ci95: tuple[float, float] | None
    verdict: Verdict
    recording_id: str


@dataclass(frozen=True, slots=True)
class MotorHealth:
    """What is known of a motor now: the latest recording's diagnosis, its relay, its latest recording."""

    motor: MotorEntry
    ied: IedEntry
    diagnosis: DiagnosisEntry | None
    last_recording: RecordingEntry | None


@dataclass(frozen=True, slots=True)
class Counts:
    """How many of each there are, by state; for the metrics."""

    links: Mapping[LinkState, int]
    event_reports: Mapping[EventReportState, int]
    recordings: Mapping[RecordingState, int]
    jobs: Mapping[JobState, int]
