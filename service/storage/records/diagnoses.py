"""Jobs, their results, and what these say of a motor."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from core.diagnosis.verdict import Verdict
from service.storage.states import AlarmKind, JobState, LinkState, RecordingRequestState, RecordingState


@dataclass(frozen=True, slots=True)
class JobRunnerPlace:
    """Where a job runner is: its host and process, and how many diagnoses it makes at once."""

    host: str
    process_id: int
    workers: int


@dataclass(frozen=True, slots=True)
class JobRunnerEntry:
    """A job runner, and how many jobs it has under way."""

    id: str
    host: str
    process_id: int
    workers: int
    started_ns: int
    jobs: int


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
    the motor's baseline.

    ied: the relay that made the recording; None of an upload.
    triggered_ns: when that relay was triggered for it; None where the service did not ask for it.
    announced_ns: when the recording was first seen.
    is_repetition: whether somebody asked for another diagnosis of a recording.
    is_joined: whether the recording was joined from others, which tell the motor's condition already.
    """

    job: Job
    motor: str
    digest: str
    baseline: tuple[str, ...] = ()
    ied: str | None = None
    triggered_ns: int | None = None
    announced_ns: int = 0
    is_repetition: bool = False
    is_joined: bool = False


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
class JobResult:
    """A job, and its diagnosis once that is made."""

    job: Job
    diagnosis: DiagnosisEntry | None


def interval_of(low: float | None, high: float | None) -> tuple[float, float] | None:
    """Return an interval from its columns; None where the recording does not tell it."""
    return None if low is None or high is None else (low, high)


@dataclass(frozen=True, slots=True)
class LatestDiagnosis:
    """What the diagnosis of a motor's latest recording says, without the findings behind it."""

    motor: str
    recording_id: str
    recorded_ns: int
    verdict: Verdict
    mu_f: float | None
    mu_f_ci95_low: float | None
    mu_f_ci95_high: float | None
    mu_f_scatter95_low: float | None
    mu_f_scatter95_high: float | None
    detection_limit: float | None
    theta_f: int | None
    load_level: float | None
    load_level_ci95_low: float | None
    load_level_ci95_high: float | None
    reasons: Sequence[str]

    @property
    def mu_f_ci95(self) -> tuple[float, float] | None:
        """Return the 95 % interval of mu_f from all causes; None where the recording does not tell it."""
        return interval_of(self.mu_f_ci95_low, self.mu_f_ci95_high)

    @property
    def mu_f_scatter95(self) -> tuple[float, float] | None:
        """Return the 95 % interval of mu_f from the record's own scatter."""
        return interval_of(self.mu_f_scatter95_low, self.mu_f_scatter95_high)

    @property
    def load_level_ci95(self) -> tuple[float, float] | None:
        """Return the 95 % interval of the load from all causes."""
        return interval_of(self.load_level_ci95_low, self.load_level_ci95_high)

    @property
    def phase(self) -> Literal["a", "b", "c"] | None:
        """Return the phase with the fault; None unless shorted turns are found."""
        phases: tuple[Literal["a", "b", "c"], ...] = ("a", "b", "c")
        return None if self.theta_f is None else phases[self.theta_f]


@dataclass(frozen=True, slots=True)
class LatestFigures:
    """The figures of a motor's latest recording that has any."""

    motor: str
    recorded_ns: int
    detection_limit: float | None
    load_level: float | None
    verdict: Verdict


@dataclass(frozen=True, slots=True)
class Counts:
    """How many of each there are, by state; of alarms, those that stand, by kind. For the metrics."""

    links: Mapping[LinkState, int]
    alarms: Mapping[AlarmKind, int]
    recording_requests: Mapping[RecordingRequestState, int]
    recordings: Mapping[RecordingState, int]
    jobs: Mapping[JobState, int]
