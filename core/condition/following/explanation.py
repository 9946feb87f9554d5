"""What explains a change after the latest record: its weights, its level, and what people are told of it."""

from functools import cached_property

from core.condition.assessment import Change
from core.condition.changes.alarm import Alarm, Weighing, weigh
from core.condition.changes.change import change_of, continued
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
        return weigh(state.filters, state.bank, expectations.hypotheses, expectations.recorder)

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
                state.filters, state.bank, state.recent, self._expectations.hypotheses, self.weighing,
                final=alarm.is_final,
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
            motor.nameplate.connection, state.sequence, state.header.voltage_channels,
        )  # fmt: skip
        return continued(change, state.header.kept)

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
        vanishing, levels = alarm.vanishing, self.level(alarm).levels
        if vanishing is None or not vanishing.is_open:
            return self.change(alarm, motor), levels
        return vanishing.change, tuple(one for one in levels if one[0] <= vanishing.last_ns)
