"""Whether a motor may run until its planned stop: how likely no part of it passes its limit before.

What is forecast is what is seen: a part that moves towards its limit. A fault that begins later is not in it.
Parts are taken as independent of each other.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Final

from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast
from core.condition.kinds import State
from core.condition.verdict.document import time_text
from core.motor_condition.parts import Part, PartCondition
from core.units import NANOSECONDS_PER_DAY

FORECAST_PARTS: Final = (Part.STATOR, Part.ROTOR)
"""Parts whose way to a limit can be forecast."""
NO_HEALTH: Final = (Part.EFFICIENCY, Part.LOAD)
"""Parts that have no limit to pass."""
LIKELY: Final = 0.9
"""Probability up to which a motor is asked to hold."""
STEPS: Final = 40
"""Halvings of the forecast's ten years: to less than a minute."""

STALE: Final = "the latest record is too old"
NOT_ASSESSED: Final = "not assessed"
STEADY: Final = "no change towards a limit is seen"
UNKNOWN_GROWTH: Final = "it is on watch, and how fast it grows is not known"
NO_FORECAST: Final = "no limit is forecast"
NOTHING_MOVES: Final = "no part is seen to move towards its limit"
BEGINS_LATER: Final = "a fault that begins later cannot be forecast, and is not in it"
NO_LOAD: Final = (
    "which load would make it 90 % is not known: the voltage of shorted turns drives their current, and no "
    "documented relation says how their growth, or that of a broken cage, depends on the load"
)


@dataclass(frozen=True, slots=True)
class PartUntilStop:
    """What is known of one part until the stop.

    Parameters
    ----------
    part : Part
        The part.
    probability : float or None
        Probability that it does not pass its limit before the stop; None where that is not known.
    reason : str
        Why, in words.
    is_beyond : bool, default False
        Whether it is beyond its limit already.
    """

    part: Part
    probability: float | None
    reason: str
    is_beyond: bool = False

    def as_dict(self) -> dict[str, object]:
        """Return the part as JSON takes it.

        Returns
        -------
        dict of str to object
            Its fields by name.
        """
        return {
            "part": str(self.part),
            "probability": self.probability,
            "reason": self.reason,
            "is_beyond": self.is_beyond,
        }


@dataclass(frozen=True, slots=True)
class UntilStop:
    """Whether a motor holds until its planned stop.

    Parameters
    ----------
    stop_ns : int
        The planned stop, UTC [ns].
    probability : float or None
        Probability that no part passes its limit before; None where nothing can be said.
    likely_until_ns : int or None
        Time until which that probability is LIKELY, UTC [ns]; None where it is not known, and beyond the
        forecast.
    parts : tuple of PartUntilStop
        What is known of each part.
    reasons : tuple of str
        Why there is no probability, and what it does not hold, in words.
    """

    stop_ns: int
    probability: float | None
    likely_until_ns: int | None
    parts: tuple[PartUntilStop, ...]
    reasons: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the document that all surfaces show.

        Returns
        -------
        dict of str to object
            The fields by name; times as RFC 3339.
        """
        return {
            "stop": time_text(self.stop_ns),
            "probability": self.probability,
            "likely_until": time_text(self.likely_until_ns),
            "parts": [one.as_dict() for one in self.parts],
            "reasons": list(self.reasons),
        }


def until_stop(
    stop_ns: int,
    parts: Sequence[PartCondition],
    forecasts: Mapping[Part, Forecast],
    *,
    as_of_ns: Mapping[Part, int],
    stale: bool,
    fault_level: float | None = None,
) -> UntilStop:
    """Return whether a motor holds until its planned stop.

    Parameters
    ----------
    stop_ns : int
        The planned stop, UTC [ns].
    parts : sequence of PartCondition
        What is said of each part of the motor.
    forecasts : mapping of Part to Forecast
        Forecasts of the stator and of the rotor.
    as_of_ns : mapping of Part to int
        Times of the records from which each forecast counts, UTC [ns].
    stale : bool
        Whether the motor's latest record is too old.
    fault_level : float or None, optional
        The motor's limit, a fraction of the phase turns; None where it is not known.

    Returns
    -------
    UntilStop
        The answer.
    """
    said = {one.part: one for one in parts}
    known = {part: forecasts[part] for part in FORECAST_PARTS if part in forecasts and _moves(said.get(part))}
    passed = fault_level is not None and Part.STATOR in known and known[Part.STATOR].limit > fault_level
    found: list[PartUntilStop] = []
    for part in Part:
        if part in FORECAST_PARTS:
            ahead = known.get(part)
            days = 0.0 if ahead is None else (stop_ns - as_of_ns[part]) / NANOSECONDS_PER_DAY
            found.append(
                _of_part(part, said.get(part), ahead, days, is_beyond=passed and part is Part.STATOR)
            )
        elif part in said and said[part].counts and part not in NO_HEALTH:
            found.append(_of_other(said[part]))
    answer = UntilStop(stop_ns, None, None, tuple(found), ())
    beyond = [one.part.words for one in found if one.is_beyond]
    if beyond:
        words = f"beyond the limit already: {', '.join(beyond)}"
        return replace(answer, probability=0.0, reasons=(words,))
    if stale:
        aged = tuple(replace(one, probability=None) for one in found)
        return replace(answer, parts=aged, reasons=(STALE,))
    return _together(answer, said, known, as_of_ns)


def _moves(part: PartCondition | None) -> bool:
    return part is not None and part.state in (State.WATCH, State.FAULT)


def _of_part(
    part: Part, said: PartCondition | None, ahead: Forecast | None, days: float, *, is_beyond: bool
) -> PartUntilStop:
    if said is None or said.state is State.UNKNOWN:
        return PartUntilStop(part, None, NOT_ASSESSED)
    reached = None if ahead is None else ahead.reached_within(max(days, 0.0))
    if said.state is State.FAULT or is_beyond:
        words = "beyond its limit already"
        if part is Part.STATOR and ahead is not None and reached is not None:
            words += (
                f"; {100 * (1.0 - reached):.0f} % likely that its level stays below {100 * ahead.limit:.2f} %"
            )
        return PartUntilStop(part, 0.0, words, is_beyond=True)
    if said.state is State.HEALTHY:
        return PartUntilStop(part, None, STEADY)
    if reached is None:
        beyond = ahead is not None and ahead.chances is not None
        words = (
            f"the stop is more than {HORIZONS_DAYS[-1] / 365:.0f} years ahead" if beyond else UNKNOWN_GROWTH
        )
        return PartUntilStop(part, None, words)
    return PartUntilStop(part, round(1.0 - reached, 3), "from the growth that its records show")


def _of_other(said: PartCondition) -> PartUntilStop:
    if said.state is State.FAULT:
        return PartUntilStop(said.part, 0.0, "beyond its limit already", is_beyond=True)
    return PartUntilStop(said.part, None, NO_FORECAST)


def _together(
    answer: UntilStop,
    said: Mapping[Part, PartCondition],
    known: Mapping[Part, Forecast],
    as_of_ns: Mapping[Part, int],
) -> UntilStop:
    """Put the parts together."""
    by_part = {one.part: one for one in answer.parts}
    probabilities = {one.part: one.probability for one in answer.parts if one.probability is not None}
    if by_part[Part.STATOR].reason == NOT_ASSESSED:
        return replace(answer, reasons=("the stator is not assessed",))
    open_ones = [part for part in FORECAST_PARTS if _moves(said.get(part)) and part not in probabilities]
    if open_ones:
        return replace(answer, reasons=tuple(f"{part.words}: {by_part[part].reason}" for part in open_ones))
    left_out = tuple(
        f"without the {one.part.words}: {one.reason}"
        for one in answer.parts
        if one.probability is None and one.reason in (NOT_ASSESSED, NO_FORECAST)
    )
    if not probabilities:
        return replace(answer, reasons=(NOTHING_MOVES, BEGINS_LATER, *left_out))
    chance = round(prod(probabilities.values()), 3)
    counted = {part: (known[part], as_of_ns[part]) for part in probabilities}
    load = () if chance >= LIKELY else (NO_LOAD,)
    return replace(
        answer,
        probability=chance,
        likely_until_ns=_likely_until(counted),
        reasons=(*left_out, BEGINS_LATER, *load),
    )


def _likely_until(forecasts: Mapping[Part, tuple[Forecast, int]]) -> int | None:
    """Return the time until which no limit is passed with LIKELY; None where it is beyond the forecasts."""

    def holds(at_ns: int) -> bool:
        reached = (
            ahead.reached_within(max((at_ns - from_ns) / NANOSECONDS_PER_DAY, 0.0)) or 0.0
            for ahead, from_ns in forecasts.values()
        )
        return prod(1.0 - one for one in reached) >= LIKELY

    begin_ns = min(from_ns for _, from_ns in forecasts.values())
    low_ns, high_ns = begin_ns, begin_ns + round(HORIZONS_DAYS[-1] * NANOSECONDS_PER_DAY)
    if holds(high_ns):
        return None
    for _ in range(STEPS):
        middle_ns = (low_ns + high_ns) // 2
        if holds(middle_ns):
            low_ns = middle_ns
        else:
            high_ns = middle_ns
    return low_ns
