"""What the repository hands out: plain values, free of the database session they were read in."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, Literal, TypeVar

from core.diagnosis.verdict import Verdict
from service.storage.states import (
    AlarmKind,
    ClockQuality,
    JobState,
    LinkState,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)

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
class ClockReading:
    """A relay's clock less ours, and what the relay says of its clock."""

    offset_ns: int
    uncertainty_ns: int
    quality: ClockQuality
    measured_ns: int


@dataclass(frozen=True, slots=True)
class IedEntry:
    """A relay and the state of its link; `last_success_ns` is the last request it answered.

    clock_...: the latest ClockReading, None before the first.
    """

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
    clock_offset_ns: int | None
    clock_uncertainty_ns: int | None
    clock_quality: ClockQuality | None
    clock_measured_ns: int | None


@dataclass(frozen=True, slots=True)
class Quarantine:
    """A relay set aside from `since_ns` until `until_ns`, and not trusted yet afterwards.

    times: how often in a row; 0 where it is one of several that are suspected.
    """

    ied: str
    reason: str
    times: int
    since_ns: int
    until_ns: int

    def holds(self, now_ns: int) -> bool:
        """Whether the relay is to be left alone at `now_ns`, by a clock that may have been set since.

        Only within the pause's own length of its beginning, on either side: a clock that was a day ahead
        keeps no relay away for a day, and one of another host, a second behind, ends no pause early.
        """
        return abs(now_ns - self.since_ns) < self.until_ns - self.since_ns


@dataclass(frozen=True, slots=True)
class GatewayEntry:
    """A process that visits relays, and how many it holds leases of."""

    id: str
    host: str
    process_id: int
    started_ns: int
    relays: int


@dataclass(frozen=True, slots=True)
class LinkChange:
    """A link's new state, since when and why."""

    changed_ns: int
    state: LinkState
    reason: str | None


@dataclass(frozen=True, slots=True)
class LinkTraffic:
    """What went over a link since it was last told."""

    connections: int = 0
    received_bytes: int = 0
    reports: int = 0
    report_gaps: int = 0


@dataclass(frozen=True, slots=True)
class LinkNote:
    """A relay answered at `now_ns`, and what went over its link since the last note.

    day_bytes: counted against the limit of the UTC day `day` (days since 1970), until now.
    """

    ied: str
    now_ns: int
    traffic: LinkTraffic
    round_trip_s: float | None
    day: int
    day_bytes: int


@dataclass(frozen=True, slots=True)
class LinkFigures:
    """What went over a relay's link in all, and how long its latest answer took [s].

    report_gaps: how often reports were lost.  day_bytes: counted against the limit of the UTC day `day`
    (days since 1970).
    """

    ied: str
    round_trip_s: float | None = None
    connections: int = 0
    received_bytes: int = 0
    reports: int = 0
    report_gaps: int = 0
    day: int = 0
    day_bytes: int = 0


@dataclass(frozen=True, slots=True)
class Alarm:
    """What somebody has to look after at a relay; standing until `cleared_ns` is set."""

    id: str
    ied: str
    kind: AlarmKind
    subject: str
    reason: str
    raised_ns: int
    cleared_ns: int | None


@dataclass(frozen=True, slots=True)
class RelayFindings:
    """What was found at a relay when it was last visited, as JSON documents.

    acquisition: what is used of it.  differences: from its SCL.  ignored_files: those of its events directory
    that are not taken, with the reason; `ignored_in_all` may be more.
    """

    ied: str
    found_ns: int
    acquisition: Mapping[str, object]
    differences: Sequence[Mapping[str, object]] = ()
    ignored_files: Sequence[Mapping[str, object]] = ()
    ignored_in_all: int = 0


@dataclass(frozen=True, slots=True)
class MotorEntry:
    """A motor; `schedule` is a cron expression in UTC."""

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None


@dataclass(frozen=True, slots=True)
class RecordingRequest:
    """An event report somebody asked for. One time for each state it went through."""

    id: str
    motor: str
    ied: str
    origin: RecordingRequestOrigin
    state: RecordingRequestState
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

    recorded_ns: the trigger time written in the record, known once it was read, by the relay's clock.
    clock_...: the latest ClockReading of that relay when the recording was stored, None without one of
    about that time.
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
    clock_offset_ns: int | None
    clock_uncertainty_ns: int | None
    clock_quality: ClockQuality | None
    clock_measured_ns: int | None


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
class Sample:
    """What a relay measured at a time: values by the names of Measurement's fields, those it has."""

    motor: str
    time_ns: int
    values: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Measurement:
    """Measured values, or means of `samples` of them from `time_ns` on; None where the relay has none.

    average_..., maximum_..., minimum_...: the relay's own statistics; of several, the largest maximum and the
    smallest minimum.
    """

    time_ns: int
    samples: int
    ia_A: float | None
    ib_A: float | None
    ic_A: float | None
    vab_V: float | None
    vbc_V: float | None
    vca_V: float | None
    va_V: float | None
    vb_V: float | None
    vc_V: float | None
    power_W: float | None
    reactive_power_var: float | None
    power_factor: float | None
    frequency_Hz: float | None
    average_current_A: float | None
    maximum_current_A: float | None
    minimum_current_A: float | None
    average_voltage_V: float | None
    maximum_voltage_V: float | None
    minimum_voltage_V: float | None
    average_power_W: float | None
    maximum_power_W: float | None
    minimum_power_W: float | None
    maximum_ia_A: float | None
    maximum_ib_A: float | None
    maximum_ic_A: float | None
    minimum_ia_A: float | None
    minimum_ib_A: float | None
    minimum_ic_A: float | None
    maximum_vab_V: float | None
    maximum_vbc_V: float | None
    maximum_vca_V: float | None
    minimum_vab_V: float | None
    minimum_vbc_V: float | None
    minimum_vca_V: float | None


@dataclass(frozen=True, slots=True)
class MotorHealth:
    """What is known of a motor now: the latest recording's diagnosis, its relay, its latest recording."""

    motor: MotorEntry
    ied: IedEntry
    diagnosis: DiagnosisEntry | None
    last_recording: RecordingEntry | None


@dataclass(frozen=True, slots=True)
class Counts:
    """How many of each there are, by state; of alarms, those that stand, by kind. For the metrics."""

    links: Mapping[LinkState, int]
    alarms: Mapping[AlarmKind, int]
    recording_requests: Mapping[RecordingRequestState, int]
    recordings: Mapping[RecordingState, int]
    jobs: Mapping[JobState, int]
