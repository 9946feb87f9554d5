"""Documents of recordings and of requests for them. Fields that are null are not known (yet)."""

from pydantic import Field

from core.diagnosis.verdict import Verdict
from core.operation import Operation
from service.api.document import Document, Listed, RequestDocument
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.api.relays.schemas import RelayClock
from service.api.times import Time
from service.storage.states import (
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
)


class RecordingWanted(RequestDocument):
    """What is to be recorded. seconds: so much as a series of recordings; null for one."""

    seconds: float | None = Field(default=None, ge=1.0, le=30.0)


class EventReport(Document):
    """A recording request: somebody, or the motor's schedule, asked a relay for a recording.

    It has the time of each state it went through. seconds: so much was asked for, as a series of recordings
    that overlap; null for one recording. joined_recording_id: what the series was joined to, once all of it
    is diagnosed. joined_remark: why that is shorter than asked for, or why there is none.
    """

    id: str
    motor: str
    ied: str
    origin: RecordingRequestOrigin
    state: RecordingRequestState
    reason: str | None
    recording_id: str | None
    requested_time: Time = Field(validation_alias="requested_ns")
    triggered_time: Time | None = Field(validation_alias="triggered_ns")
    recorded_time: Time | None = Field(validation_alias="recorded_ns")
    fetched_time: Time | None = Field(validation_alias="fetched_ns")
    diagnosed_time: Time | None = Field(validation_alias="diagnosed_ns")
    failed_time: Time | None = Field(validation_alias="failed_ns")
    seconds: float | None
    joined_recording_id: str | None
    joined_remark: str | None


class Recording(RelayClock):
    """A recording. `recorded_time` is the trigger time written in the record, known once it was read.

    operation: what the motor does in it; null while nobody has looked, or it cannot be told.
    operation_remark: why the motor's parameters cannot be estimated from this start.
    duration_s: its length; pre_trigger_s: how much of it is before the trigger; null before it was read.
    parts: the recordings that it was joined from (source joined); null of others.
    copy_of: the recording of the same event, with values as fine or finer, that counts in its place.
    That time is the relay's; `clock_...` is the latest comparison of its clock when the recording was stored,
    null where that was not made within an hour of it.
    """

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    size_bytes: int
    state: RecordingState
    reason: str | None
    operation: Operation | None
    operation_remark: str | None
    duration_s: float | None
    pre_trigger_s: float | None
    parts: Listed[str] | None
    copy_of: str | None
    announced_time: Time = Field(validation_alias="announced_ns")
    fetched_time: Time | None = Field(validation_alias="fetched_ns")
    recorded_time: Time | None = Field(validation_alias="recorded_ns")


class ListedRecording(Recording):
    """A recording with the verdict of its latest diagnosis; null without one."""

    verdict: Verdict | None = None


class RecordingFile(Document):
    name: str
    size_bytes: int
    sha256: str


class RecordingDetails(Recording):
    """A recording with its files and its latest diagnosis.

    copies: recordings of the same event in whose place it counts.
    """

    copies: Listed[str]
    files: Listed[RecordingFile]
    diagnosis: Diagnosis | None
