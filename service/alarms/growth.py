"""Whether a level has grown since somebody was told of it, beyond what its interval leaves open."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LevelSeen:
    """A level with its 95 % interval; the interval is None where it is not known."""

    value: float
    low: float | None
    high: float | None


def magnitude(seen: LevelSeen) -> LevelSeen:
    """Return how large a quantity with a sign is, such as the error of a channel that reads too little."""
    value, low, high = abs(seen.value), seen.low, seen.high
    if low is None or high is None:
        return LevelSeen(value, None, None)
    nearest = 0.0 if low <= 0.0 <= high else min(abs(low), abs(high))
    return LevelSeen(value, nearest, max(abs(low), abs(high)))


def has_grown(told: float, seen: LevelSeen, least_ratio: float) -> bool:
    """Tell whether a level is surely above the one that people were told.

    The dead band is what the interval leaves open: its lower end has to lie above the level that was told. A
    narrow interval alone is not enough: the level has to have grown by the share `least_ratio` at least.
    """
    if seen.low is None:
        return False
    return seen.low > told and seen.value >= told * (1.0 + least_ratio)


def is_another_kind(told: frozenset[str], seen: frozenset[str]) -> bool:
    """Tell whether what a motor shows is something else than what people were told.

    told, seen: the kinds that it may be; empty where it is not named. To name one of those that were told, or
    to be less sure again, is nothing new.
    """
    return bool(seen) and told.isdisjoint(seen)
