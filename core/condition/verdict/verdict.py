"""What is said of a motor in figures: its state, what has changed, and by how much."""

from dataclasses import dataclass
from typing import Final

from core.condition.assessment import PHASES, Assessment, Change, Level, Phase, Reference
from core.condition.kinds import Kind, State
from core.condition.severity import FEW, Interval, level_in_all, level_of, of_one_fault, stands_out, state_of
from core.machines.parameters import Motor

MOST_CANDIDATES: Final = 3


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is said of a motor in figures, from each record on; see `Condition`.

    Parameters
    ----------
    state : State
        State of the motor.
    kind : Kind
        What has changed, or stands out from the first record on.
    candidates : tuple of Kind
        What an unclear kind may be, likeliest first; empty otherwise.
    phase : {"a", "b", "c"} or None
        Phase of the fault, the channel or the joint, at the terminals.
    mu_f : float or None
        Fault level in all, a fraction of the phase turns; None before the first record.
    mu_f_ci95 : tuple of float or None
        Its 95 % interval.
    change : float or None
        Change of the fault level since the reference.
    change_ci95 : tuple of float or None
        Its 95 % interval.
    """

    state: State
    kind: Kind
    candidates: tuple[Kind, ...]
    phase: Phase | None
    mu_f: float | None
    mu_f_ci95: Interval | None
    change: float | None
    change_ci95: Interval | None


OF_TYPICAL: Final = {
    State.UNKNOWN: State.UNKNOWN,
    State.HEALTHY: State.UNKNOWN,
    State.WATCH: State.WATCH,
    State.FAULT: State.WATCH,
}
"""What is said where nothing but the nameplate is known of the motor."""
UNKNOWN: Final = Verdict(State.UNKNOWN, Kind.NONE, (), None, None, None, None, None)
"""What is said before the first record."""


def verdict_of(assessment: Assessment | None, motor: Motor) -> Verdict:
    """Judge a motor from what its records tell, without a forecast and without words.

    Parameters
    ----------
    assessment : Assessment or None
        What the records tell; None before the first valid one.
    motor : Motor
        The motor, with its limits. With typical parameters of its rating it is on watch at most, and what
        would be healthy is unknown.

    Returns
    -------
    Verdict
        What `condition_of` says too.
    """
    if assessment is None:
        return UNKNOWN
    limit = motor.limits.fault_level
    fault = of_one_fault(assessment, limit)
    kind, candidates = _kind(fault, limit)
    level = level_of(fault.change)
    mu_f, mu_f_ci95 = level_in_all(fault)
    state = state_of(assessment, limit)
    return Verdict(
        state=OF_TYPICAL[state] if motor.is_typical else state,
        kind=kind,
        candidates=candidates,
        phase=_phase(fault),
        mu_f=mu_f,
        mu_f_ci95=mu_f_ci95,
        change=_change(assessment.reference, level),
        change_ci95=None if level is None else level.ci95,
    )


def _kind(assessment: Assessment, limit: float) -> tuple[Kind, tuple[Kind, ...]]:
    """Return the kind, and the candidates of an unclear one. What makes the state a fault goes first."""
    change = assessment.change
    if assessment.standing_fault:
        return Kind.SHORTED_TURNS, ()
    if change is not None and len(change.named) == 1:
        return change.named[0], ()
    if change is not None:
        return Kind.UNCLEAR, change.named or _likeliest(change)
    if stands_out(assessment, limit):
        return Kind.UNCLEAR, (Kind.SHORTED_TURNS, Kind.VOLTAGE_CHANNEL)
    return (Kind.UNCLEAR if assessment.unconfirmed else Kind.NONE), ()


def _likeliest(change: Change) -> tuple[Kind, ...]:
    possible = [kind for kind, probability in change.probabilities.items() if probability >= FEW]
    possible.sort(key=lambda kind: -change.probabilities[kind])
    return tuple(possible[:MOST_CANDIDATES])


def _phase(assessment: Assessment) -> Phase | None:
    """Return the phase of what is named; nothing has a phase while all is open."""
    change = assessment.change
    if assessment.standing_fault:
        return assessment.reference.standing.phase
    if change is None or not change.named:
        return None
    if Kind.SHORTED_TURNS in change.named:
        return change.level.phase
    return None if change.channel is None else PHASES[change.channel]


def _change(reference: Reference, level: Level | None) -> float | None:
    if level is not None:
        return max(0.0, level.value)
    return 0.0 if reference.complete else None
