"""The state of a motor and its fault level in all, from what its records tell."""

from dataclasses import replace
from math import exp, hypot
from typing import Final

from core.condition.assessment import Assessment, Change, Level
from core.condition.kinds import Kind, State

Interval = tuple[float, float]

TURNS_OR_JOINT: Final = frozenset((Kind.SHORTED_TURNS, Kind.CONNECTION))
MAY_BE_TURNS: Final = frozenset((Kind.SHORTED_TURNS, Kind.ASYMMETRY))
"""What has a level: an asymmetry of unknown cause may be shorted turns that no model describes."""
FEW: Final = 0.02
"""A kind with less probability than this is no candidate."""
STANDING_FAULTS: Final = 0.01
"""Share of motors that have shorted turns from the first record on."""
WATCHED_SCORE: Final = 3.2
"""Standard deviations from which on a standing asymmetry is watched: six sound motors in a thousand."""


def state_of(assessment: Assessment, limit: float) -> State:
    """Return the state of a motor.

    A change makes it a fault if the whole interval of its level lies above the limit. For a standing fault it
    is enough that the likeliest level lies above the limit: sensors certainly do not explain the asymmetry,
    and the interval is wide only because the path is not known. The state stays fault until the whole
    interval lies below the limit.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    State
        The state; never unknown.
    """
    if _is_fault(of_one_fault(assessment, limit), limit):
        return State.FAULT
    if assessment.change is not None or assessment.unconfirmed or stands_out(assessment, limit):
        return State.WATCH
    return State.HEALTHY


def _is_fault(assessment: Assessment, limit: float) -> bool:
    """Return whether the assessment of one winding is that of a fault."""
    change = assessment.change
    if level_in_all(assessment)[1][0] > limit or stays_a_fault(change, limit):
        return True
    if not assessment.standing_fault:
        return False
    if standing_stays_a_fault(assessment, limit):
        return True
    sure = assessment if is_shorted_turns(change) else replace(assessment, change=None)
    return level_in_all(sure)[0] > limit


def stays_a_fault(change: Change | None, limit: float) -> bool:
    """Return whether a change keeps the state at fault after its level lay above the limit once.

    Shorted turns do not heal. If the level is near the limit, the interval may reach below the limit again by
    chance. So the state changes back only once the whole interval lies below the limit.

    Parameters
    ----------
    change : Change or None
        The change that is seen.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    bool
        Whether it is.
    """
    if change is None or change.surely_above <= limit or not is_shorted_turns(change):
        return False
    return change.level.ci95[1] > limit


def standing_stays_a_fault(assessment: Assessment, limit: float) -> bool:
    """Return whether a standing fault keeps the state at fault; the same rule as `stays_a_fault`.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    bool
        Whether it is.
    """
    return assessment.called_above > limit and assessment.reference.standing.ci95[1] > limit


def of_one_fault(assessment: Assessment, limit: float) -> Assessment:
    """Return the assessment reduced to the worse of two faults, if they are in two windings.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    Assessment
        The assessment. If a standing fault and a change are in two windings, one of them is left out: that
        which is no fault by itself, or else the smaller one.
    """
    standing, level = assessment.reference.standing, level_of(assessment.change)
    if not assessment.standing_fault or level is None or level.winding == standing.winding:
        return assessment
    alone = replace(assessment, change=None, levels=())
    changed = replace(assessment, standing_fault=False)
    if (_is_fault(changed, limit), level.value) > (_is_fault(alone, limit), standing.value):
        return changed
    return alone


def stands_out(assessment: Assessment, limit: float) -> bool:
    """Return whether the standing asymmetry is so large that the motor is to be watched.

    Parameters
    ----------
    assessment : Assessment
        What the records tell.
    limit : float
        Limit of the motor, a fraction of the phase turns.

    Returns
    -------
    bool
        Whether sensors hardly explain it, or its level times the probability that it is shorted turns lies
        above the limit.
    """
    reference = assessment.reference
    if assessment.standing_fault or reference.accepted:
        return assessment.standing_fault
    score = max(reference.standing_score, assessment.held_score)
    likely = _probability_of_standing_fault(score) * reference.standing.value
    return score >= WATCHED_SCORE or likely > limit


def level_in_all(assessment: Assessment) -> tuple[float, Interval]:
    """Return the level in all, and its interval.

    It is the sum of the change and of the standing asymmetry. The latter comes mostly from sensors, so it
    counts with the probability that it is shorted turns; the upper end of the interval contains all of it.
    Neither part is below zero.

    Parameters
    ----------
    assessment : Assessment
        What the records tell, of one fault.

    Returns
    -------
    level : float
        Level, a fraction of the phase turns.
    interval : tuple of float
        Its 95 % interval. The lower end is above zero only if shorted turns are certain.
    """
    change, standing = assessment.change, assessment.reference.standing
    level = level_of(change)
    if level is not None and level.winding != standing.winding:
        # Turns of another winding do not add to the level of this one.
        standing = replace(standing, value=0.0, interval=None)
    share = (
        1.0
        if assessment.standing_fault
        else _probability_of_standing_fault(assessment.reference.standing_score)
    )
    if assessment.reference.accepted:
        # A person declared it healthy, so the level is without it. The interval still contains it.
        share = 0.0
    value = share * max(0.0, standing.value)
    low = standing.ci95[0] if assessment.standing_fault else 0.0
    high = standing.ci95[1]
    if level is not None:
        value += max(0.0, level.value)
        low += level.ci95[0] if is_shorted_turns(change) else 0.0
        above = hypot(standing.ci95[1] - standing.value, level.ci95[1] - level.value)
        high = standing.value + level.value + above
    return value, (min(low, value), max(high, value))


def level_of(change: Change | None) -> Level | None:
    """Return what a change adds to the fault level; None if it is gone or not shorted turns.

    Parameters
    ----------
    change : Change or None
        The change that is seen.

    Returns
    -------
    Level or None
        Its level if it may be shorted turns.
    """
    if change is None or change.until_ns is not None:
        return None
    if change.named:
        return change.level if MAY_BE_TURNS & set(change.named) else None
    return change.level if change.probabilities.get(Kind.SHORTED_TURNS, 0.0) >= FEW else None


def is_shorted_turns(change: Change | None) -> bool:
    """Return whether a change that lasts is named as shorted turns, or as these or a joint.

    Parameters
    ----------
    change : Change or None
        The change that is seen.

    Returns
    -------
    bool
        Whether it is.
    """
    return (
        change is not None
        and change.until_ns is None
        and Kind.SHORTED_TURNS in change.named
        and frozenset(change.named) <= TURNS_OR_JOINT
    )


def _probability_of_standing_fault(score: float) -> float:
    """Return the probability that a standing asymmetry with this score is shorted turns."""
    return 1.0 / (1.0 + (1.0 - STANDING_FAULTS) / STANDING_FAULTS * exp(-(score**2) / 2.0))
