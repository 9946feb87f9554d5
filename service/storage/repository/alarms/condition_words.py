"""What an alarm says of a motor's condition: cause, level, forecast and advice, from the kept document."""

from collections.abc import Collection, Mapping, Sequence

from core.condition.kinds import Kind
from core.condition.verdict.phase_words import kinds_in_words
from core.terms import phrase
from core.time_words import time_ahead
from service.alarms.growth import LevelSeen, magnitude
from service.storage.records import ConditionEntry

UNNAMED = frozenset((Kind.NONE, Kind.UNCLEAR))
"""These name nothing: an asymmetry that stands out, or that may be several things."""


class ConditionWords:
    """The words and figures of one condition."""

    def __init__(self, condition: ConditionEntry) -> None:
        self._condition = condition
        self._document = condition.document or {}

    @property
    def causes(self) -> tuple[Kind, ...]:
        """Return the kinds of asymmetry that it may be; empty where none is named."""
        named = self._condition.candidates or (self._condition.kind,)
        return tuple(kind for kind in named if kind not in UNNAMED)

    @property
    def subject(self) -> str:
        """Return what has changed, and in which phase; of what is unclear, what it may be.

        Likely phases are without their probabilities: those change with each record, the cause does not.
        """
        kinds = _texts(self._document.get("candidates")) or [str(self._condition.kind)]
        phase, probabilities = self._condition.phase, self._condition.phase_probabilities
        words = kinds_in_words(kinds, phase, probabilities, phrase, with_shares=False)
        return words if phase is None else f"{words} in phase {phase}"

    @property
    def reason(self) -> str:
        """Return why it is taken for that."""
        return "; ".join(_texts(self._document.get("reasons")))

    @property
    def advice(self) -> str:
        """Return what to do."""
        return str(self._document.get("advice", ""))

    def level(self, causes: Collection[Kind]) -> LevelSeen | None:
        """Return how bad it is: the fault level, or the size of what is surely no shorted turns.

        causes: what it is taken for.
        """
        if not is_fault_level(causes):
            size = _number(self._document.get("size"))
            low, high = _interval(self._document.get("size_ci95"))
            return None if size is None else magnitude(LevelSeen(size, low, high))
        one = self._condition
        return None if one.mu_f is None else LevelSeen(one.mu_f, one.mu_f_ci95_low, one.mu_f_ci95_high)

    @property
    def limit(self) -> float | None:
        """Return the limit that the level has yet to reach."""
        return _number(self._forecast.get("limit"))

    @property
    def days_to_limit(self) -> float | None:
        """Return in how many days the limit will likely be reached; None without a trend."""
        days = self._days
        return None if days is None else days[1]

    @property
    def grows(self) -> bool:
        """Tell whether the level grows at present."""
        growth = _number(self._document.get("growth_per_day"))
        return growth is not None and growth > 0.0

    @property
    def forecast_reason(self) -> str:
        """Return when the limit will be reached, in words."""
        days = self._days
        if days is None or self.limit is None:
            return ""
        low, mid, high = days
        return (
            f"the fault level will likely reach {100 * self.limit:.2f} % in {time_ahead(mid)} "
            f"({time_ahead(low)} to {time_ahead(high)}), counted from the latest record"
        )

    @property
    def _forecast(self) -> Mapping[str, object]:
        found = self._document.get("forecast")
        return found if isinstance(found, Mapping) else {}

    @property
    def _days(self) -> tuple[float, float, float] | None:
        days = self._forecast.get("days")
        if not isinstance(days, list) or len(days) != 3:
            return None
        low, mid, high = (_number(one) for one in days)
        return None if low is None or mid is None or high is None else (low, mid, high)


def is_fault_level(causes: Collection[Kind]) -> bool:
    """Tell whether it is the fault level that says how bad it is: it may be shorted turns."""
    return not causes or Kind.SHORTED_TURNS in causes


def _texts(found: object) -> Sequence[str]:
    return [str(one) for one in found] if isinstance(found, list) else []


def _number(found: object) -> float | None:
    return float(found) if isinstance(found, int | float) else None


def _interval(found: object) -> tuple[float | None, float | None]:
    if not isinstance(found, list) or len(found) != 2:
        return None, None
    return _number(found[0]), _number(found[1])
