"""Recordings: those asked for, those a relay lists, and those in the store."""

from dataclasses import dataclass

from core.operation import Operation
from service.storage.states import (
    ClockQuality,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)


@dataclass(frozen=True, slots=True)
class RecordingRequest:
    """A recording that somebody requested of a relay, with one time for each state it went through.

    seconds: so much is to be recorded, as a series that is joined; None for one record.
    triggers: how often the relay is triggered for the series.
    joined_recording_id: what the series was joined to.  joined_remark: why that is shorter, or is not there.
    """

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
    seconds: float | None = None
    triggers: int | None = None
    joined_recording_id: str | None = None
    joined_remark: str | None = None


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
    operation: what the motor does in it; None while nobody has looked, or it cannot be told.
    operation_remark: why the parameters of a motor cannot be estimated from this start; None where they can.
    duration_s, pre_trigger_s: its length, and how much of it is before the trigger; None before it was read.
    parts: the recordings that it was joined from; None of others.
    copy_of: the recording of the same event that counts in its place; None where it counts itself.
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
    operation: Operation | None
    operation_remark: str | None
    duration_s: float | None = None
    pre_trigger_s: float | None = None
    parts: tuple[str, ...] | None = None
    copy_of: str | None = None


@dataclass(frozen=True, slots=True)
class SeriesEnd:
    """What ended a series: the name of a recording, its time [ns UTC], and what the motor does in it."""

    name: str
    recorded_ns: int
    operation: Operation


@dataclass(frozen=True, slots=True)
class Series:
    """The recordings of a series that somebody asked for, by their times, as long as the motor runs.

    digests: their places in the recording store.  ended_by: the first one that shows the motor do something
    else than run; neither it nor a later one is among them.  is_complete: whether no more are to come (all
    are there that the relay was triggered for, or the motor runs no longer) and it is known what it does in
    each.
    """

    request_id: str
    motor: str
    recording_ids: tuple[str, ...]
    digests: tuple[str, ...]
    recorded_ns: tuple[int, ...]
    ended_by: SeriesEnd | None
    is_complete: bool


@dataclass(frozen=True, slots=True)
class SeriesHistory:
    """When series of a motor were asked for [ns UTC]; None where none was.

    tried_ns: the latest.  joined_ns: the latest that was joined.  failed: how many came after that one.
    """

    tried_ns: int | None
    joined_ns: int | None
    failed: int


@dataclass(frozen=True, slots=True)
class RecordingFile:
    name: str
    size_bytes: int
    sha256: str
