"""Tables of the motors' conditions: what each record tells, what follows from all, and what is due."""

from collections.abc import Mapping

from sqlalchemy import Double, ForeignKey, Index, LargeBinary, String, false
from sqlalchemy.orm import Mapped, mapped_column

from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.condition.observation import VoltageChannels
from core.signals.sequence import PhaseSequence
from service.storage.models.base import Base


class Figures:
    """The columns of what is said of a motor at a time.

    candidates: what an unclear kind may be.  phase: "a", "b" or "c".  mu_f, change: levels.
    """

    candidates: Mapped[tuple[Kind, ...]] = mapped_column(nullable=True)
    phase: Mapped[str | None] = mapped_column(String(1))
    mu_f: Mapped[float | None] = mapped_column(Double)
    mu_f_ci95_low: Mapped[float | None] = mapped_column(Double)
    mu_f_ci95_high: Mapped[float | None] = mapped_column(Double)
    change: Mapped[float | None] = mapped_column(Double)
    change_ci95_low: Mapped[float | None] = mapped_column(Double)
    change_ci95_high: Mapped[float | None] = mapped_column(Double)


class ObservationRow(Figures, Base):
    """What one recording tells (core.condition.observation), and what is said of its motor from it on.

    It outlives a recording that a rule of retention deletes, because the motor's reference rests on it.
    Phasors are peak values in volts and amperes. state and the figures: null until it is folded.
    left_out: why it is not folded, because that failed; null where it is, or is to be.
    left_out_by: version of the program and its rules that left it out: another one tries again.
    ..._change, ..._margin: of the motor's parameters from it on (core.tracking); null before a reference.
    """

    __tablename__ = "observations"

    recording_id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    recorder: Mapped[str]
    sequence: Mapped[PhaseSequence]
    voltage_channels: Mapped[VoltageChannels]
    frequency_hz: Mapped[float] = mapped_column(Double)
    positive_voltage_re: Mapped[float] = mapped_column(Double)
    positive_voltage_im: Mapped[float] = mapped_column(Double)
    negative_voltage_re: Mapped[float] = mapped_column(Double)
    negative_voltage_im: Mapped[float] = mapped_column(Double)
    zero_voltage_re: Mapped[float | None] = mapped_column(Double)
    zero_voltage_im: Mapped[float | None] = mapped_column(Double)
    positive_current_re: Mapped[float] = mapped_column(Double)
    positive_current_im: Mapped[float] = mapped_column(Double)
    negative_current_re: Mapped[float] = mapped_column(Double)
    negative_current_im: Mapped[float] = mapped_column(Double)
    zero_current_re: Mapped[float] = mapped_column(Double)
    zero_current_im: Mapped[float] = mapped_column(Double)
    scatter: Mapped[float] = mapped_column(Double)
    cycles: Mapped[int]
    load_level: Mapped[float | None] = mapped_column(Double)
    left_out: Mapped[str | None]
    left_out_by: Mapped[str | None]
    state: Mapped[State | None]
    kind: Mapped[Kind | None]
    stator_resistance_change: Mapped[float | None] = mapped_column(Double)
    stator_resistance_margin: Mapped[float | None] = mapped_column(Double)
    rotor_resistance_change: Mapped[float | None] = mapped_column(Double)
    rotor_resistance_margin: Mapped[float | None] = mapped_column(Double)
    magnetising_inductance_change: Mapped[float | None] = mapped_column(Double)
    magnetising_inductance_margin: Mapped[float | None] = mapped_column(Double)
    leakage_inductance_change: Mapped[float | None] = mapped_column(Double)
    leakage_inductance_margin: Mapped[float | None] = mapped_column(Double)

    __table_args__ = (
        # All that a trend over years is drawn from: a row with its phasors lies on a page of its own.
        Index(
            "ix_observations_trend",
            "motor",
            "time_ns",
            "recording_id",
            "state",
            "mu_f",
            "mu_f_ci95_low",
            "mu_f_ci95_high",
        ),
    )


class ConditionRow(Figures, Base):
    """A motor's condition: one row for each motor.

    version: counts the folds; who folded from an older version writes nothing.  document: what
    `MotorCondition.as_dict()` gave, of which state, kind, phase and since_ns are; null before the first fold,
    as is as_of_ns.  stator: what `Condition.as_dict()` gave of the stator alone.  standing: its standing
    asymmetry, for the other motors of its bus.  problem: why what came since is not folded; null while it is.
    rules: version of the rules by which all of it was judged; null before the first fold.
    parameters: what `TrackedParameters.as_dict()` gave; null where no fold followed them yet.
    stood_ns: when the motor was last seen to stand still; null where it never was.
    """

    __tablename__ = "conditions"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    version: Mapped[int]
    state: Mapped[State]
    kind: Mapped[Kind]
    since_ns: Mapped[int | None]
    as_of_ns: Mapped[int | None]
    document: Mapped[Mapping[str, object] | None]
    stator: Mapped[Mapping[str, object] | None]
    standing: Mapped[Mapping[str, object] | None]
    problem: Mapped[str | None]
    rules: Mapped[str | None]
    parameters: Mapped[Mapping[str, object] | None]
    stood_ns: Mapped[int | None]


class ConditionDayRow(Base):
    """What was said of a motor on a day of UTC, which begins at day_ns: of all its records that were folded.

    mu_f_...: of those that have a level; null where none has.  A page shows months of hundreds of motors from
    these rows, and reads none of their records.
    """

    __tablename__ = "condition_days"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    day_ns: Mapped[int] = mapped_column(primary_key=True)
    records: Mapped[int]
    mu_f_least: Mapped[float | None] = mapped_column(Double)
    mu_f_mean: Mapped[float | None] = mapped_column(Double)
    mu_f_largest: Mapped[float | None] = mapped_column(Double)


class ConditionChangeRow(Figures, Base):
    """A time at which a motor's state, kind, phase or candidates changed, or an event happened.

    It has what is said then.

    id: that of the recording or the event that caused it.
    """

    __tablename__ = "condition_changes"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    recording_id: Mapped[str | None] = mapped_column(String(36))
    event_id: Mapped[str | None] = mapped_column(String(36))
    state: Mapped[State]
    kind: Mapped[Kind]

    __table_args__ = (Index("ix_condition_changes_motor_time_ns_id", "motor", "time_ns", "id"),)


class ConditionEventRow(Base):
    """What somebody told of a motor, or what its files tell (core.condition.events).

    account: that told it. by: whom somebody named, else the account.
    withdrawn_...: it was wrong, and counts no more; null while it counts.
    """

    __tablename__ = "condition_events"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    time_ns: Mapped[int]
    kind: Mapped[EventKind]
    reason: Mapped[str]
    account: Mapped[str]
    by: Mapped[str]
    made_ns: Mapped[int]
    withdrawn_ns: Mapped[int | None]
    withdrawn_account: Mapped[str | None]
    withdrawn_by: Mapped[str | None]
    withdrawn_reason: Mapped[str | None]

    __table_args__ = (Index("ix_condition_events_motor_time_ns_id", "motor", "time_ns", "id"),)


class ConditionCheckpointRow(Base):
    """What is known of a motor once all up to and with `time_ns` is folded, to go on from there.

    records: how many observations that are.  tracking: what follows its parameters (core.tracking.saving).
    """

    __tablename__ = "condition_checkpoints"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    time_ns: Mapped[int] = mapped_column(primary_key=True)
    records: Mapped[int]
    state: Mapped[bytes] = mapped_column(LargeBinary)
    tracking: Mapped[Mapping[str, object]]


class FoldMarkRow(Base):
    """From which time on a motor's observations or events have changed, and are to be folded again.

    A row for each change: who makes one waits for nobody, and a fold takes away those that it knew of.
    set_aside: the fold failed too often; it is tried again with the next change.
    """

    __tablename__ = "fold_marks"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"))
    from_ns: Mapped[int]
    set_aside: Mapped[bool] = mapped_column(server_default=false())

    __table_args__ = (Index("ix_fold_marks_motor_from_ns", "motor", "from_ns"),)


class MotorVersionRow(Base):
    """What the motors file said of a motor from a time on: nameplate, parameters, classes of its sensors."""

    __tablename__ = "motor_versions"

    motor: Mapped[str] = mapped_column(ForeignKey("motors.name"), primary_key=True)
    from_ns: Mapped[int] = mapped_column(primary_key=True)
    document: Mapped[Mapping[str, object]]
