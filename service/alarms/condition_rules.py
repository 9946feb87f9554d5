"""Which alarm a motor's condition makes, from what was said of it with its latest records."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.condition.kinds import State
from service.alarms.confirmation import Confirmation, DeadBand, Decision
from service.alarms.kinds import AlarmKind

WORSE_THAN_HEALTHY: Final = frozenset((State.WATCH, State.FAULT))

HORIZON_BAND: Final = 1.5
"""A forecast is taken back when the limit lies beyond so many horizons."""


@dataclass(frozen=True, slots=True)
class ConditionRules:
    """When records confirm a state, and from when on growth and a forecast are told.

    growth_share: a level grows by this share at least before people are called again.  horizon_days: a limit
    that is reached within this time is told [days]; 0 for never.
    """

    watch: Confirmation
    fault: Confirmation
    growth_share: float = 0.1
    horizon_days: float = 30.0

    @property
    def looks(self) -> int:
        """Return how many of the latest records matter."""
        return max(self.watch.looks, self.fault.looks)

    def kind_of(self, states: Sequence[State], stands: AlarmKind | None) -> AlarmKind | None:
        """Return which alarm stands after these records, oldest first; None where there is none.

        stands: the alarm so far.
        """
        is_fault = _stands(
            self.fault, [state is State.FAULT for state in states], so_far=stands is AlarmKind.CONDITION_FAULT
        )
        if is_fault:
            return AlarmKind.CONDITION_FAULT
        worse = [state in WORSE_THAN_HEALTHY for state in states]
        return AlarmKind.CONDITION_WATCH if _stands(self.watch, worse, so_far=stands is not None) else None

    def forecast(self, days: float, *, stands: bool) -> Decision:
        """Decide whether a limit that will likely be reached in so many days is told."""
        if self.horizon_days == 0.0:
            return Decision.CLEAR if stands else Decision.KEEP
        return DeadBand(self.horizon_days, HORIZON_BAND * self.horizon_days).decide(days, stands=stands)


AT_ONCE: Final = ConditionRules(Confirmation(1, 1, 1), Confirmation(1, 1, 1), horizon_days=0.0)
"""Each record counts at once, and no forecast is told."""


def _stands(rule: Confirmation, bad: Sequence[bool], *, so_far: bool) -> bool:
    decision = rule.decide(bad, stands=so_far)
    return so_far if decision is Decision.KEEP else decision is Decision.RAISE
