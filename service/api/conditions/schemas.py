"""Documents of a motor's condition. Fields that are null are not known (yet)."""

from pydantic import Field

from core.condition.assessment import Phase, Phases
from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.motor_condition.condition import Urgency
from core.motor_condition.parts import Part
from service.api.document import Document, Listed, Reason, RequestDocument, RequestForSomebody
from service.api.times import Time, TimeParameter
from service.storage.records import StopOf

Interval = tuple[float, float]


class Forecast(Document):
    """Days from the latest record until the level reaches `limit`: likely not before, middle, likely by then.

    One chance in ten each that it is earlier than the first or later than the last. `days` is null where the
    records show no trend towards the limit. chances: probability that the level has reached the limit 0,
    0.25, 0.5, 1, 2, 3, 5, 7, 10, 14, 21, 30, 45, 60, 90, 120, 180, 270, 365, 545, 730, 1095, 1825 and 3650
    days after that record; null where too few records tell.
    """

    limit: float | None
    days: tuple[float, float, float] | None
    chances: Listed[float] | None = None


class ConditionReference(Document):
    """What the motor was like before any change, as learnt from `records` records.

    complete: whether changes are looked for. standing: level that the asymmetry from the first record on
    would mean if it were shorted turns (..._ci95: 95 % interval, ..._deviation: standard deviation,
    ..._phase_probabilities: of the phases a, b and c, ..._axis_deg: axis of the coils, as below,
    ..._score: standard deviations beyond what the sensors leave). detectable: step of the level that would be
    seen within ten records in nine of ten cases. from_bus: whether other motors of the bus took part in
    judging it.
    accepted: whether a person said that the motor is healthy as it is; accepted_level: level of the shorted
    turns that the records showed until then, in accepted_phase, or null.
    """

    records: int
    complete: bool
    standing: float | None
    standing_ci95: tuple[float, float] | None
    standing_deviation: float | None
    standing_phase: Phase | None
    standing_phase_probabilities: Phases | None = None
    standing_axis_deg: float | None = None
    standing_score: float | None
    detectable: float | None
    since: Time | None
    from_bus: bool
    accepted: bool
    accepted_level: float | None = None
    accepted_level_ci95: Interval | None = None
    accepted_phase: Phase | None = None


class PartOfMotor(Document):
    """What is said of one part of a motor, or of what surrounds it.

    explained_by: the part whose finding explains this one, which does not count again.
    """

    part: Part
    state: State
    finding: str
    since: Time | None
    advice: str
    reasons: Listed[str]
    explained_by: Part | None


class LikelyCause(Document):
    """Causes that together explain all that is measured, "healthy" for none, and their probability."""

    causes: Listed[str]
    words: str
    probability: float


class Condition(Document):
    """The condition of a motor over time, judged from all its records: what a plant acts on.

    state: of its worst part. kind: what that part has; `finding`: the same in words. causes: explanations of
    all that is measured, the likeliest first. parts: each of them. `candidates`: what an unclear kind may be.
    phase: null where it is less than 95 % sure. phase_probabilities: of a, b and c, if it is shorted turns.
    axis_deg: electrical degrees of their coils' axis from the phase's, where the motor's winding is known.
    mu_f: fault level in all, change: since the reference, as fractions of the phase turns, each with its 95 %
    interval from noise, sensors and parameters. size: of the change in its own measure, for example the
    relative error of a channel, with its 95 % interval. since: first record that shows the change.
    as_of: latest record that counts; stale: whether that is too old.
    """

    motor: str
    state: State
    kind: Kind
    candidates: Listed[Kind]
    phase: Phase | None
    phase_probabilities: Phases | None = None
    axis_deg: float | None = None
    mu_f: float | None
    mu_f_ci95: Interval | None
    change: float | None
    change_ci95: Interval | None
    size: float | None
    size_ci95: Interval | None = None
    since: Time | None
    growth_per_day: float | None
    forecast: Forecast
    reference: ConditionReference
    as_of: Time | None
    stale: bool
    advice: str
    reasons: Listed[str]
    finding: str = ""
    urgency: Urgency = Urgency.NONE
    causes: Listed[LikelyCause] = Field(default_factory=list)
    parts: Listed[PartOfMotor] = Field(default_factory=list)


class PartUntilStop(Document):
    """What is known of a part until the planned stop. probability: null where it is not known.

    is_beyond: it is beyond its limit already.
    """

    part: Part
    probability: float | None
    reason: str
    is_beyond: bool


class UntilStop(Document):
    """Whether a motor holds until its planned stop, from what is seen of it today.

    of: whether the stop is the motor's own or its site's. probability: that no part passes its limit before;
    0 where one is beyond it already, null where nothing can be said: `reasons` say why. likely_until: until
    then the probability is 90 % and more; null where it is not known, or beyond ten years.
    """

    stop: Time
    of: StopOf
    probability: float | None
    likely_until: Time | None
    parts: Listed[PartUntilStop]
    reasons: Listed[str]


class PlannedStop(Document):
    """When a motor stops next, and whether the motor or its site was planned so; null without a plan."""

    time: Time | None = Field(validation_alias="time_ns")
    of: StopOf | None


class StopRequest(RequestDocument):
    """When something stops."""

    time: TimeParameter


class _Figures(Document):
    state: State
    kind: Kind
    candidates: Listed[Kind]
    phase: Phase | None
    mu_f: float | None
    mu_f_ci95: Interval | None
    change: float | None
    change_ci95: Interval | None


class ConditionPoint(_Figures):
    """What was said of the motor from one of its records on; `record` is the id of the recording.

    candidates: what an unclear kind may be, likeliest first; empty of records before they were kept.
    """

    record: str = Field(validation_alias="recording_id")
    time: Time = Field(validation_alias="time_ns")


class ConditionDetails(Condition):
    """A condition with what was said from each of the latest records on, oldest first.

    until_stop: whether the motor holds until its planned stop; null where none is planned.
    """

    until_stop: UntilStop | None
    history: Listed[ConditionPoint]


class ConditionChange(_Figures):
    """A time at which the motor's state, kind, phase or candidates changed, or a note was taken into account.

    candidates: what an unclear kind may be, likeliest first; empty of records before they were kept.
    recording_id, note_id: what caused it; one of them is null.
    """

    id: str
    time: Time = Field(validation_alias="time_ns")
    recording_id: str | None
    note_id: str | None = Field(validation_alias="event_id")


class NoteRequest(RequestForSomebody):
    """What a person tells of a motor. `time`: when it happened, by default now."""

    kind: EventKind = EventKind.NOTE
    text: Reason
    time: TimeParameter | None = None


class RestartRequest(RequestForSomebody):
    """Why the motor counts as healthy as it is. `time`: from when on, by default now."""

    reason: Reason
    time: TimeParameter | None = None


class Withdrawal(RequestForSomebody):
    """Why a note was wrong."""

    reason: Reason


class Note(Document):
    """What somebody told of a motor, or what its files tell.

    It happened at `time`; the account `by` told it at `made_time`, perhaps for somebody whom it named. The
    condition follows from all but those of kind `note` and those that were withdrawn.
    """

    id: str
    motor: str
    kind: EventKind
    text: str = Field(validation_alias="reason")
    by: str = Field(validation_alias="account")
    on_behalf_of: str | None
    time: Time = Field(validation_alias="time_ns")
    made_time: Time = Field(validation_alias="made_ns")
    withdrawn_time: Time | None = Field(validation_alias="withdrawn_ns")
    withdrawn_by: str | None = Field(validation_alias="withdrawn_account")
    withdrawn_on_behalf_of: str | None
    withdrawn_reason: str | None
