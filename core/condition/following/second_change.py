"""A second change beside an open one: it is seen by a filter that has taken the first one in.

All causes that are weighed are of one change. Where two have happened, none of them fits, and what is named
of the first would swallow the second. So the records are followed twice while a change is open that is not
named as shorted turns: by the errors before it, which goes on naming it, and with it in the errors, which
sees what comes after it.
"""

from typing import Final, Protocol

from core.condition.changes.alarm import Alarm
from core.condition.changes.taking_in import take_in
from core.condition.following.direction_state import DirectionState
from core.condition.following.expectations import Expectations
from core.condition.following.explanation import Explanation
from core.condition.following.folding import fold_record
from core.condition.following.standing_errors import SUSPECTED
from core.condition.measuring.measurement import Measurement
from core.machines.parameters import Motor

TAKEN_IN: Final = frozenset((2, 4, 8, 16, 32, 64))
"""Records after the alarm at which the first change is taken in anew, unless a second one is suspected: what
it is, and whether it drifts, is known better by then."""


class FollowUp(Protocol):
    """What becomes of an open alarm with a record: `open_alarm.follow_up`."""

    def __call__(
        self, alarm: Alarm, state: DirectionState, explanation: Explanation, expectations: Expectations,
        motor: Motor, record: Measurement, *, is_second: bool,
    ) -> None:  # fmt: skip
        """See what a record makes of an open alarm."""


def follow_second(
    state: DirectionState, expectations: Expectations, motor: Motor, record: Measurement, follow_up: FollowUp
) -> None:
    """Look for a second change with a record.

    Parameters
    ----------
    state : DirectionState
        The state after the record, with an open alarm; its `later` changes.
    expectations : Expectations
        What changes of the motor look like.
    motor : Motor
        The motor as it is.
    record : Measurement
        The record.
    follow_up : callable
        What becomes of the second change's own alarm.
    """
    first, time_ns = state.header.alarm, state.header.as_of_ns
    later = state.later
    if later is None or (first is not None and first.records in TAKEN_IN and not is_suspected(state)):
        state.later = _taken_in(state)
        return
    header, alarm = later.header, later.header.alarm
    header.as_of_ns = time_ns
    fold_record(
        later.filters, later.bank, later.sides, later.circles, later.recent, expectations.hypotheses,
        expectations.jumps, record, time_ns, alarm is not None,
    )  # fmt: skip
    if alarm is None and later.figures["statistic"] >= later.figures["threshold"]:
        alarm = header.alarm = Alarm(time_ns)
    if alarm is not None:
        follow_up(alarm, later, Explanation(later, expectations), expectations, motor, record, is_second=True)


def is_suspected(state: DirectionState) -> bool:
    """Return whether a second change is seen, or likely enough to leave the first as it was named.

    Parameters
    ----------
    state : DirectionState
        The state.

    Returns
    -------
    bool
        Whether it is.
    """
    later = state.later
    return later is not None and (
        later.header.alarm is not None or bool(later.figures["statistic"] > SUSPECTED)
    )


def take_over(state: DirectionState, first: Alarm) -> None:
    """Go on with the first change in what stands; it stays told until a second one is seen.

    Parameters
    ----------
    state : DirectionState
        The state, whose `later` takes its place.
    first : Alarm
        The first change.
    """
    later, header = state.later, state.header
    if later is None:
        raise ValueError("no filter has taken the change in: follow_second has to run first")
    if first.alone is not None:
        header.kept, header.kept_errors = first.alone, first.errors
    header.alarm = later.header.alarm
    state.later = None
    if header.alarm is None:
        # What is kept counts until now: another change begins after it.
        later.figures["candidates"] = 0.0
    state.take(later)


def _taken_in(state: DirectionState) -> DirectionState:
    """Return the same state with the likeliest change in its standing errors."""
    state.later = None
    later = state.copy()
    take_in(later.filters, later.bank, later.sides, later.circles)
    later.bank[:], later.recent[:] = 0, 0
    later.header.alarm = later.header.gone = None
    later.parameter_fits[:] = 0
    return later
