"""How a motor is judged by what its records tell."""

from dataclasses import replace

from core.condition.assessment import (
    STALE_AFTER_NS,
    Assessment,
    Level,
    ParameterError,
)
from core.condition.events import Event
from core.condition.forecast.forecast import forecast, limit_ahead
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind, State
from core.condition.severity import Interval, level_of, of_one_fault, stands_out
from core.condition.verdict.advice import advice
from core.condition.verdict.condition import Condition, is_stale, unknown_condition
from core.condition.verdict.reasons import of_slip_rings, reason_of_unknown, reasons_of
from core.condition.verdict.verdict import Verdict, verdict_of
from core.machines.parameters import Motor
from core.machines.typical import TYPICAL_REASON


def condition_of(
    motor: Motor,
    assessment: Assessment | None,
    now_ns: int,
    stale_after_ns: int = STALE_AFTER_NS,
    *,
    ended_by: Event | None = None,
) -> Condition:
    """Judge a motor from what its records tell.

    Parameters
    ----------
    motor : Motor
        The motor, with its limits.
    assessment : Assessment or None
        What the records tell; None before the first valid one.
    now_ns : int
        Time at which the condition is looked at, UTC [ns].
    stale_after_ns : int, optional
        Longest age of the latest record [ns].
    ended_by : Event or None, optional
        The event that ended the reference, where there is no record since.

    Returns
    -------
    Condition
        The condition.
    """
    limit = motor.limits.fault_level
    verdict = verdict_of(assessment, motor)
    if assessment is None or verdict.mu_f is None:
        return _unknown(motor, ended_by)
    fault = of_one_fault(assessment, limit)
    state, kind = verdict.state, verdict.kind
    size, size_ci95 = _size(fault, verdict)
    is_gone = state is State.WATCH and fault.change is not None and fault.change.until_ns is not None
    ahead = _forecast(fault, level_of(fault.change), verdict.mu_f, limit)
    misfits = _misfits(assessment, verdict)
    turns = turns_of(fault, limit)
    return Condition(
        motor=motor.name,
        state=state,
        kind=kind,
        candidates=verdict.candidates,
        phase=verdict.phase,
        phase_probabilities=None if turns is None else turns.phases,
        axis_deg=None if turns is None else turns.axis_deg,
        mu_f=verdict.mu_f,
        mu_f_ci95=verdict.mu_f_ci95,
        change=verdict.change,
        change_ci95=verdict.change_ci95,
        size=size,
        size_ci95=size_ci95,
        since_ns=_since(fault, limit),
        forecast=ahead,
        reference=assessment.reference,
        as_of_ns=assessment.as_of_ns,
        stale=is_stale(assessment.as_of_ns, now_ns, stale_after_ns),
        advice=advice(
            state,
            kind,
            phase=verdict.phase,
            candidates=verdict.candidates,
            is_gone=is_gone,
            is_typical=motor.is_typical,
            misfits=[one.name for one in misfits],
        ),
        reasons=(
            *_of_parameters(motor, misfits),
            *reasons_of(assessment, limit, ahead),
            *(of_slip_rings(assessment) if motor.wound_rotor is not None else ()),
        ),
    )


def _unknown(motor: Motor, ended_by: Event | None) -> Condition:
    return replace(
        unknown_condition(motor.name, motor.limits.fault_level),
        advice=advice(State.UNKNOWN, Kind.NONE, is_typical=motor.is_typical),
        reasons=(*_of_parameters(motor), reason_of_unknown(ended_by)),
    )


def _misfits(assessment: Assessment, verdict: Verdict) -> tuple[ParameterError, ...]:
    """Return the parameters to be told of: shorted turns draw a current of their own, which looks alike."""
    are_seen = verdict.mu_f_ci95 is not None and verdict.mu_f_ci95[0] > 0.0
    return () if are_seen or Kind.SHORTED_TURNS in verdict.candidates else assessment.parameter_errors


def _of_parameters(motor: Motor, errors: tuple[ParameterError, ...] = ()) -> tuple[str, ...]:
    if motor.is_typical:
        return (TYPICAL_REASON,)
    if not errors:
        return ()
    names = ", ".join(one.name for one in errors)
    figures = "; ".join(str(one) for one in errors)
    return (
        f"the parameters in the motor's file do not fit its records ({names}): commission this motor. Of the "
        f"file's, the motor has {figures}",
    )


def turns_of(assessment: Assessment, limit: float) -> Level | None:
    """Return the shorted turns that are seen, or that an open change may be.

    Parameters
    ----------
    assessment : Assessment
        What the records tell, of one fault.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    Level or None
        Their level; None where none are suspected.
    """
    if assessment.standing_fault:
        return assessment.reference.standing
    if assessment.change is None and stands_out(assessment, limit):
        return assessment.reference.standing
    return level_of(assessment.change)


def _since(assessment: Assessment, limit: float) -> int | None:
    """Return when it began. A standing fault was there from the first record on, whatever it grew by."""
    if assessment.change is not None and not assessment.standing_fault:
        return assessment.change.since_ns
    return assessment.reference.since_ns if stands_out(assessment, limit) else None


def _size(assessment: Assessment, verdict: Verdict) -> tuple[float | None, Interval | None]:
    """Return the size of what is seen, and its interval. A standing fault has only its level in all."""
    if assessment.standing_fault:
        return verdict.mu_f, verdict.mu_f_ci95
    change = assessment.change
    return (None, None) if change is None or change.until_ns is not None else (change.size, change.size_ci95)


def _forecast(assessment: Assessment, level: Level | None, mu_f: float, limit: float) -> Forecast:
    limit = limit_ahead(mu_f, limit)
    if level is None:
        return Forecast(limit)
    standing = mu_f - max(0.0, level.value)
    return forecast(assessment.levels, limit, today=level, standing=standing)
