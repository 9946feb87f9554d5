"""What becomes of an open alarm: it is named, lived with, taken back or closed."""

from collections.abc import Sequence
from dataclasses import replace

from core.condition.assessment import Change
from core.condition.changes.alarm import Alarm, confirm
from core.condition.changes.before_change import before_change
from core.condition.changes.vanishing import Vanishing
from core.condition.filter.prior import Prior
from core.condition.following.direction_state import DirectionState
from core.condition.following.expectations import Expectations
from core.condition.following.explanation import Explanation
from core.condition.following.reference import restart_reference
from core.condition.following.second_change import follow_second, is_suspected, take_over
from core.condition.kinds import Kind
from core.condition.measuring.measurement import Measurement
from core.condition.severity import is_shorted_turns
from core.machines.parameters import Motor

CLEARED = 3.0
"""Log of the detector's statistic below which a change has gone again."""


def follow_up(
    alarm: Alarm, state: DirectionState, explanation: Explanation, expectations: Expectations,
    motor: Motor, record: Measurement, *, is_second: bool = False,
) -> None:  # fmt: skip
    """See what a record makes of an open alarm.

    Parameters
    ----------
    alarm : Alarm
        The alarm; it changes.
    state : DirectionState
        The state after the record; it changes.
    explanation : Explanation
        What explains the change after the record.
    expectations : Expectations
        What changes of the motor look like.
    motor : Motor
        The motor as it is.
    record : Measurement
        The record.
    is_second : bool, default False
        Whether the alarm is that of a second change: a third one is looked for when that is in what stands.
    """
    alarm.records += 1
    vanishing = alarm.vanishing
    if vanishing is not None:
        vanishing.look(state.filter, record.y, record.j1, state.header.as_of_ns)
        if vanishing.is_certain:
            # Shorted turns do not heal. Unless somebody told of works, a contact may come and go.
            if not alarm.worked_on:
                state.header.gone = replace(vanishing.change, until_ns=vanishing.last_ns)
            _take_back(state, vanishing.reference)
            return
    if alarm.may_hide_another and not is_second:
        follow_second(state, expectations, motor, record, follow_up)
    if alarm.is_to_be_weighed:
        _give_name(alarm, state, explanation, motor)
    if alarm.may_be_called:
        change = explanation.change(alarm, motor)
        if is_shorted_turns(change):
            alarm.surely_above = max(alarm.surely_above, change.level.ci95[0])
        _keep_what_is_shown(alarm, change, explanation, state.header.as_of_ns)
    if state.figures["statistic"] < CLEARED:
        _close(state)
    elif state.later is not None and (alarm.is_to_be_lived_with or _is_turns(state.later)):
        take_over(state, alarm)


def _give_name(alarm: Alarm, state: DirectionState, explanation: Explanation, motor: Motor) -> None:
    """Name the change, and keep it as it is while it is alone."""
    is_alone = not is_suspected(state)
    confirm(alarm, explanation.weighing, is_alone=is_alone)
    if not alarm.may_hide_another:
        state.later = None
    if not alarm.is_named_beside_turns:
        alarm.alone = None
    elif is_alone or alarm.alone is None:
        alarm.alone = explanation.change(alarm, motor)
        alarm.errors = [] if state.later is None else state.later.filter.x[:4].tolist()


def _is_turns(later: DirectionState) -> bool:
    """Return whether a second change is named as shorted turns, or as these or a joint."""
    alarm = later.header.alarm
    return alarm is not None and not alarm.may_hide_another


def maintain(state: DirectionState, prior: Prior) -> None:
    """Close a change, but not one that may be shorted turns: few works mend a winding.

    Shorted turns that are told stay told until the records show that they have vanished. What may be
    something else, too, is looked for again against the reference of before it, which takes a few records.
    Any other change may have been mended where it was learnt, so that the channels are learnt anew.

    Parameters
    ----------
    state : DirectionState
        The state; it changes.
    prior : Prior
        Spread of the standing errors before the first record.
    """
    alarm = state.header.alarm
    if alarm is None or Kind.SHORTED_TURNS not in alarm.named:
        restart_reference(state, prior, keep_impedance=True)
    elif alarm.vanishing is None:
        _take_back(state)
    else:
        alarm.worked_on = True


def _keep_what_is_shown(alarm: Alarm, change: Change, explanation: Explanation, time_ns: int) -> None:
    """Keep what shorted turns show, so that it is seen when they show it no more."""
    if alarm.vanishing is not None and alarm.vanishing.is_open:
        return
    shown = is_shorted_turns(change) and change.level.ci95[0] > 0.0
    level = explanation.level(alarm)
    alarm.vanishing = Vanishing.of(change, level.shown, level.reference, time_ns) if shown else None


def _take_back(state: DirectionState, reference: Sequence[float] | None = None) -> None:
    """Go back to the reference as it was before the change; it is given where the change is gone by now."""
    kalman = state.filter
    kalman.x[:], kalman.P[:] = before_change(kalman, state.bank)
    if reference is not None:
        kalman.x[:] = reference
    kalman.recent, kalman.block = 0.0, 1.0
    _close(state)


def _close(state: DirectionState) -> None:
    """Close the alarm: changes of the same reference are looked for again."""
    header = state.header
    header.alarm = None
    header.standing = None if header.kept is None else header.standing
    state.filter.candidates = 0.0
    state.later = None
