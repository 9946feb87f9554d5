"""Conditions of motors: what is said of them, since when, and what it follows from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from core.condition.assessment import Phase, Phases
from core.condition.events import Event, EventKind
from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.condition.verdict.document import phases_of_document
from core.motor_condition.parts import Part, PartCondition, parts_of
from service.audit.acting import in_words
from service.storage.records.diagnoses import interval_of


@dataclass(frozen=True, slots=True, kw_only=True)
class ConditionFigures:
    """What is said of a motor at a time.

    candidates: what an unclear kind may be, likeliest first.
    phase: "a", "b" or "c".  mu_f: total level.  change: level since the reference; each with its 95 %
    interval from all causes, and None where it is not known.
    """

    state: State
    kind: Kind
    candidates: tuple[Kind, ...] = ()
    phase: Phase | None = None
    mu_f: float | None = None
    mu_f_ci95_low: float | None = None
    mu_f_ci95_high: float | None = None
    change: float | None = None
    change_ci95_low: float | None = None
    change_ci95_high: float | None = None

    @property
    def mu_f_ci95(self) -> tuple[float, float] | None:
        """Return the 95 % interval of the total level."""
        return interval_of(self.mu_f_ci95_low, self.mu_f_ci95_high)

    @property
    def change_ci95(self) -> tuple[float, float] | None:
        """Return the 95 % interval of the change."""
        return interval_of(self.change_ci95_low, self.change_ci95_high)

    @property
    def phase_probabilities(self) -> Phases | None:
        """Return the probability of each phase, if it is shorted turns; only the condition now has them."""
        return None

    @property
    def parts(self) -> tuple[PartCondition, ...]:
        """Return what was said of each part; only the condition now has them."""
        return ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ConditionEntry(ConditionFigures):
    """A motor's condition now.

    version: how often it was folded; 0 where it never was.  document: `MotorCondition.as_dict()`, with what
    was stale when it was made; None before the first fold.  as_of_ns: time of the latest record in it.
    problem: why what came since is not folded; None while it is.  stood_ns: when the motor was last seen to
    stand still; None where it never was.
    """

    motor: str
    version: int
    since_ns: int | None
    as_of_ns: int | None
    document: Mapping[str, object] | None
    problem: str | None = None
    stood_ns: int | None = None

    @property
    def phase_probabilities(self) -> Phases | None:
        """Return the probability of each phase, should it be shorted turns; None where none is known."""
        found = (self.document or {}).get("phase_probabilities")
        return phases_of_document(cast("list[float] | None", found))

    @property
    def parts(self) -> tuple[PartCondition, ...]:
        """Return what is said of each part of the motor; nothing before the first fold."""
        return parts_of(self.document)

    def state_of(self, part: Part) -> State:
        """Return the state of a part; unknown where it was not judged."""
        return next((one.state for one in self.parts if one.part is part), State.UNKNOWN)


@dataclass(frozen=True, slots=True, kw_only=True)
class ConditionPoint(ConditionFigures):
    """What is said of a motor from one of its records on."""

    recording_id: str
    time_ns: int


@dataclass(frozen=True, slots=True)
class ConditionDay:
    """What was said of a motor on a day of UTC, which begins at `day_ns`, by so many of its records.

    mu_f_...: of the records that have a level; None where none has.
    """

    day_ns: int
    records: int
    mu_f_least: float | None
    mu_f_mean: float | None
    mu_f_largest: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ConditionChange(ConditionFigures):
    """A time at which a motor's state, kind, phase or candidates changed, or an event happened.

    recording_id, event_id: what caused it; one of them is None.
    """

    motor: str
    time_ns: int
    recording_id: str | None
    event_id: str | None

    @property
    def id(self) -> str:
        """Return the id of what caused the change, which is the change's own too."""
        cause = self.recording_id or self.event_id
        assert cause is not None  # noqa: S101 - every change has a cause
        return cause


@dataclass(frozen=True, slots=True)
class ConditionEvent:
    """An event of a motor, by whom and when it was told.

    account: that told it. by: whom somebody named, or what noticed it, else the account. withdrawn_...: None
    while it counts.
    """

    id: str
    motor: str
    time_ns: int
    kind: EventKind
    reason: str
    account: str
    by: str
    made_ns: int
    withdrawn_ns: int | None = None
    withdrawn_account: str | None = None
    withdrawn_by: str | None = None
    withdrawn_reason: str | None = None

    @property
    def event(self) -> Event:
        """Return the event as the core knows it."""
        return Event(self.time_ns, self.kind, self.reason)

    @property
    def on_behalf_of(self) -> str | None:
        """Return whom somebody named as who tells it; None for nobody but the account."""
        return None if self.by == self.account else self.by

    @property
    def withdrawn_on_behalf_of(self) -> str | None:
        """Return whom somebody named as who withdraws it; None for nobody but the account."""
        return None if self.withdrawn_by == self.withdrawn_account else self.withdrawn_by

    @property
    def who(self) -> str:
        """Return who told it, in words."""
        return in_words(self.account, self.on_behalf_of)

    @property
    def who_withdrew(self) -> str | None:
        """Return who withdrew it, in words; None while it counts."""
        if self.withdrawn_account is None:
            return None
        return in_words(self.withdrawn_account, self.withdrawn_on_behalf_of)


@dataclass(frozen=True, slots=True)
class RecordObservation:
    """The observation of a recording, and the motor it is of."""

    recording_id: str
    motor: str
    observation: Observation


@dataclass(frozen=True, slots=True)
class FollowedStart:
    """What a start tells of the rotor: R_r over R_s, and its relative standard deviation."""

    time_ns: int
    rotor_over_stator: float
    deviation: float


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackedPoint:
    """Changes of a motor's parameters after one of its records, with half their 95 % intervals.

    All are fractions; None before there is a reference.
    """

    recording_id: str
    time_ns: int
    stator_resistance_change: float | None = None
    stator_resistance_margin: float | None = None
    rotor_resistance_change: float | None = None
    rotor_resistance_margin: float | None = None
    magnetising_inductance_change: float | None = None
    magnetising_inductance_margin: float | None = None
    leakage_inductance_change: float | None = None
    leakage_inductance_margin: float | None = None


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """What is known once all up to and with `time_ns` is folded; `records` observations.

    tracking: what follows the parameters.
    """

    time_ns: int
    records: int
    state: bytes
    tracking: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class MotorVersion:
    """What the motors file said of a motor from a time on."""

    from_ns: int
    document: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class BusMotor:
    """Another motor of a motor's bus: what the motors file says of it, and its standing asymmetry."""

    motor: str
    document: Mapping[str, object] | None
    standing: Mapping[str, object] | None


@dataclass(frozen=True, slots=True)
class FoldInput:
    """All that a fold of a motor needs, as it is in the database when it begins.

    version, marks: to tell afterwards whether another was quicker, and which changes are folded.
    checkpoint: where to go on; None at the beginning.  earlier: numbers of records of that checkpoint and
    those before it, by their times.
    observations: the next ones, in their order.  next_ns: time of the first one beyond them; None at the end.
    events: those up to next_ns, in their order.
    bus: the other motors of its bus.  neighbours: their observations at about the same times.
    latest_change: the last change before; None where there is none.
    starts: what those up to next_ns tell of the rotor, in their order.
    """

    motor: str
    version: int
    marks: tuple[str, ...]
    checkpoint: Checkpoint | None
    earlier: Mapping[int, int]
    observations: tuple[RecordObservation, ...]
    next_ns: int | None
    events: tuple[ConditionEvent, ...]
    bus: tuple[BusMotor, ...]
    neighbours: tuple[RecordObservation, ...]
    motor_versions: tuple[MotorVersion, ...]
    latest_change: ConditionChange | None
    starts: tuple[FollowedStart, ...] = ()


@dataclass(frozen=True, slots=True)
class FoldResult:
    """What a fold found: what is said from each record on, the changes, and the motor's condition at the end.

    checkpoints: new ones.  kept_checkpoints: times of the earlier ones that are kept; the others go.
    condition, standing: what is said of the motor, and its standing asymmetry; None where more is to be
    folded.  rules: version of the rules by which it was judged.
    tracked: changes of the parameters after each record.  parameters: what is said of them at the end, where
    a condition is.
    """

    points: Sequence[ConditionPoint]
    changes: Sequence[ConditionChange]
    checkpoints: Sequence[Checkpoint]
    kept_checkpoints: Sequence[int]
    condition: ConditionEntry | None
    standing: Mapping[str, object] | None = None
    rules: str | None = None
    tracked: Sequence[TrackedPoint] = ()
    parameters: Mapping[str, object] | None = None


@dataclass(frozen=True, slots=True)
class Backlog:
    """How much the conditions are behind: motors with changes.

    motors_set_aside: those whose changes are not folded, because that failed.
    """

    motors_to_fold: int
    motors_set_aside: int = 0
