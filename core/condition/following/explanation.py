"""What explains a change after the latest record: its weights, its level, and what people are told of it."""

from functools import cached_property

import numpy as np

from core.condition.assessment import Change
from core.condition.changes.alarm import Alarm, Weighing, is_doubtful, weigh
from core.condition.changes.before_change import before_change
from core.condition.changes.change import change_of, continued, drifted
from core.condition.changes.turns_level import TurnsLevel, turns_level
from core.condition.following.direction_state import DirectionState
from core.condition.following.expectations import Expectations
from core.machines.parameters import Motor


class Explanation:
    """Explanation of a change after one record. Weights and level are computed once, when they are needed.

    Parameters
    ----------
    state : DirectionState
        The state. After it has changed, an explanation is to be made anew.
    expectations : Expectations
        What changes of the motor look like.
    """

    def __init__(self, state: DirectionState, expectations: Expectations) -> None:
        self._state = state
        self._expectations = expectations
        self._level: TurnsLevel | None = None

    @cached_property
    def weighing(self) -> Weighing:
        """Weights of all causes."""
        state, expectations = self._state, self._expectations
        return weigh(
            state.filters, state.bank, expectations.hypotheses, expectations.coarse.shares, expectations.jumps
        )

    def level(self, alarm: Alarm) -> TurnsLevel:
        """Return the change of the fault level, should it be shorted turns.

        Parameters
        ----------
        alarm : Alarm
            The alarm.

        Returns
        -------
        TurnsLevel
            The level.
        """
        if self._level is None:
            state = self._state
            self._level = turns_level(
                state.filters, state.bank, state.recent, self._expectations.hypotheses,
                self._expectations.fine, self.weighing, final=alarm.is_final,
                before=None if alarm.vanishing is None else alarm.vanishing.reference,
            )  # fmt: skip
        return self._level

    def change(self, alarm: Alarm, motor: Motor) -> Change:
        """Return the change as the records show it.

        Parameters
        ----------
        alarm : Alarm
            The alarm.
        motor : Motor
            The motor as it is.

        Returns
        -------
        Change
            The change, with what an earlier one of the same channel had changed.
        """
        state = self._state
        change = change_of(
            alarm, self.weighing, self.level(alarm), self._expectations.hypotheses, state.filters, state.bank,
            motor, state.sequence, state.header.voltage_channels,
        )  # fmt: skip
        return continued(change, self.kept(motor))

    def kept(self, motor: Motor) -> Change | None:
        """Return an earlier change that is in the standing errors, as large as it is now.

        Parameters
        ----------
        motor : Motor
            The motor as it is.

        Returns
        -------
        Change or None
            The change.
        """
        state, header = self._state, self._state.header
        if header.kept is None or not header.kept_errors:
            return header.kept
        x, P = state.filter.x, state.filter.P
        if header.alarm is not None:
            x, P = before_change(state.filter, state.bank)
        return drifted(
            header.kept, x[:4] - np.array(header.kept_errors), np.diag(P)[:4], self._expectations.hypotheses,
            motor, state.sequence, header.voltage_channels,
        )  # fmt: skip

    def told(self, alarm: Alarm, motor: Motor) -> tuple[Change, tuple[tuple[int, float], ...]]:
        """Return what people are told: shorted turns are told until they have vanished for certain.

        Parameters
        ----------
        alarm : Alarm
            The alarm.
        motor : Motor
            The motor as it is.

        Returns
        -------
        change : Change
            The change.
        levels : tuple of (int, float)
            Time and level of the latest records.
        """
        if alarm.alone is not None and is_doubtful(alarm, self.weighing):
            return alarm.alone, ()  # a second change: one explains no two
        vanishing, levels = alarm.vanishing, self.level(alarm).levels
        if vanishing is None or not vanishing.is_open:
            return self.change(alarm, motor), levels
        return vanishing.change, tuple(one for one in levels if one[0] <= vanishing.last_ns)
