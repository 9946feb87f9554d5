"""States of what is stored. The words are part of the REST contract."""

from enum import IntEnum, StrEnum

from service.alarms.kinds import AlarmKind as AlarmKind
from service.alarms.kinds import AlarmPriority as AlarmPriority


class LinkState(StrEnum):
    """Whether a relay answers."""

    UNKNOWN = "unknown"
    UP = "up"
    DOWN = "down"
    QUARANTINED = "quarantined"


class AlarmState(StrEnum):
    """What people, and the plant's design, have made of an alarm, after ISA-18.2 and IEC 62682.

    Whether its cause stands is another thing: an alarm may be shelved while the cause comes and goes.
    """

    NORMAL = "normal"
    UNACKNOWLEDGED = "unacknowledged"
    ACKNOWLEDGED = "acknowledged"
    RETURNED_UNACKNOWLEDGED = "returned-unacknowledged"
    SHELVED = "shelved"
    SUPPRESSED = "suppressed"
    OUT_OF_SERVICE = "out-of-service"


class AlarmEvent(StrEnum):
    """What happens to an alarm; `alarm_transitions` says what follows from it."""

    RAISED = "raised"
    CLEARED = "cleared"
    SUPERSEDED = "superseded"
    REOPENED = "reopened"
    ACKNOWLEDGED = "acknowledged"
    ACKNOWLEDGEMENT_UNDONE = "acknowledgement-undone"
    SHELVED = "shelved"
    UNSHELVED = "unshelved"
    SHELVING_ENDED = "shelving-ended"
    SUPPRESSED = "suppressed"
    UNSUPPRESSED = "unsuppressed"
    TAKEN_OUT_OF_SERVICE = "taken-out-of-service"
    PUT_BACK_IN_SERVICE = "put-back-in-service"


class BackupState(StrEnum):
    """How far a back-up has come."""

    RUNNING = "running"
    VERIFIED = "verified"
    FAILED = "failed"


class ClockQuality(StrEnum):
    """What a relay says of its own clock."""

    SYNCHRONISED = "synchronised"
    NOT_SYNCHRONISED = "not-synchronised"
    FAILED = "failed"


class RecordingRequestOrigin(StrEnum):
    """Who requested a recording."""

    REQUEST = "request"
    SCHEDULE = "schedule"


class RecordingRequestState(StrEnum):
    """How far a requested recording has come."""

    REQUESTED = "requested"
    TRIGGERED = "triggered"
    RECORDED = "recorded"
    FETCHED = "fetched"
    DIAGNOSED = "diagnosed"
    FAILED = "failed"
    SKIPPED = "skipped"
    """A schedule that asks for running motors only came due while the motor stood: no relay was asked."""


IN_THE_RELAY = (RecordingRequestState.TRIGGERED, RecordingRequestState.RECORDED)
"""In these states the relay was triggered, and its record is not yet in the store."""


class RecordingState(StrEnum):
    """announced by the relay -> fetched (stored) -> diagnosed; rejected and failed carry a reason."""

    ANNOUNCED = "announced"
    FETCHED = "fetched"
    DIAGNOSED = "diagnosed"
    REJECTED = "rejected"
    FAILED = "failed"


class StartSource(StrEnum):
    """What tells of a start: its recording, or the relay's motor start report alone."""

    RECORDING = "recording"
    REPORT = "report"


class MeasurementSource(StrEnum):
    """Where a measured value comes from: polled by the service, or from the relay's load profile.

    A mean of both is `polled`, which is the later one in the order of the words.
    """

    LOAD_PROFILE = "load-profile"
    POLLED = "polled"


class RelayEventKind(StrEnum):
    """What a relay's sequence of events tells of its motor."""

    START = "start"
    STOP = "stop"
    TRIP = "trip"


class RecordingSource(StrEnum):
    """Where a recording came from."""

    RELAY = "relay"
    UPLOAD = "upload"
    JOINED = "joined"
    """Made by the service of several that a relay recorded one after the other."""


class DeletedBy(StrEnum):
    """Who deleted a recording."""

    PERSON = "person"
    RETENTION = "retention"


class StayReason(StrEnum):
    """Why no rule of retention deletes a recording; the first that holds is told."""

    RUNNING = "running-diagnosis"
    BASELINE = "baseline"
    ALARM = "open-alarm"
    NOTE = "note"
    CHECKPOINT = "condition-checkpoint"
    NEWEST = "newest"
    STARTS = "start"
    FIRST = "first-days"
    CHANGE = "change"
    OPERATION = "operation"
    ONE_IN = "one-in-days"


class JobState(StrEnum):
    """A diagnosis to be made."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"


class JobPriority(IntEnum):
    """Which diagnoses are made first: the lower, the sooner."""

    RELAY_RECORD = 0
    UPLOAD = 1
    REPETITION = 2


class NotificationKind(StrEnum):
    """What a message is about."""

    ALARMS = "alarms"
    ESCALATION = "escalation"
    DIGEST = "digest"
    REPORT = "report"
    TEST = "test"


class NotificationState(StrEnum):
    """queued -> sending -> sent; queued again after a failure, dead after the last attempt.

    withdrawn: there was nothing left to tell when its time came.
    """

    QUEUED = "queued"
    SENDING = "sending"
    SENT = "sent"
    DEAD = "dead"
    WITHDRAWN = "withdrawn"


class NotifiedEvent(StrEnum):
    """What people may want to be told of an alarm."""

    RAISED = "raised"
    REOPENED = "reopened"
    CLEARED = "cleared"
    ACKNOWLEDGED = "acknowledged"


class InspectionOutcome(StrEnum):
    """What an inspection of a motor found, beside what the service had said. The words are those of REST."""

    CONFIRMED = "confirmed"
    """What was said is what it was."""
    OTHER_CAUSE = "other-cause"
    """Something else was the matter; where nothing was said, something was missed."""
    NOTHING_FOUND = "nothing-found"
