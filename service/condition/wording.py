"""A motor's condition in words, the same on every page and in every report."""

from collections.abc import Callable, Mapping, Sequence
from typing import Final, Protocol

from core.condition.kinds import Kind, State
from core.condition.verdict.phase_words import kinds_in_words
from core.motor_condition.parts import Part, PartCondition, findings_beside_stator
from core.time_words import time_ahead
from core.units import NANOSECONDS_PER_DAY
from service.condition.staleness import Missing

Days = Sequence[float]

KINDS: Final[Mapping[Kind, str]] = {
    Kind.SHORTED_TURNS: "shorted turns",
    Kind.VOLTAGE_CHANNEL: "an error of a voltage channel",
    Kind.CURRENT_CHANNEL: "an error of a current channel",
    Kind.CONNECTION: "more resistance in a joint",
    Kind.SUPPLY: "another supply",
    Kind.PARAMETERS: "another impedance of the motor",
    Kind.ROTOR: "another rotor",
    Kind.ASYMMETRY: "an asymmetry of unknown cause",
    Kind.OTHER_LOAD: "a capacitor or another load behind the relay",
}
"""What has changed, in words for a sentence."""


class SaidOfPart(Protocol):
    """What is said of a part, as the database keeps it or as the API tells it."""

    @property
    def part(self) -> Part: ...
    @property
    def state(self) -> State: ...
    @property
    def finding(self) -> str: ...
    @property
    def explained_by(self) -> Part | None: ...


class Judged(Protocol):
    """What is said of a motor, as the database keeps it or as the API tells it."""

    @property
    def state(self) -> State: ...
    @property
    def kind(self) -> Kind: ...
    @property
    def candidates(self) -> Sequence[Kind]: ...
    @property
    def phase(self) -> str | None: ...
    @property
    def phase_probabilities(self) -> Sequence[float] | None: ...
    @property
    def change(self) -> float | None: ...
    @property
    def parts(self) -> Sequence[SaidOfPart]: ...


def cause(judged: Judged) -> str:
    """Return what has changed, with its phase; of what is open, what it may be; empty where nothing has.

    Where the phase of shorted turns is not sure, they have the likely ones.
    """
    beside = beside_stator(judged)
    if beside or judged.kind is Kind.NONE:
        return beside
    if judged.kind is not Kind.UNCLEAR:
        words = _of_kinds(judged, judged.kind)
    elif judged.candidates:
        words = f"may be {_of_kinds(judged, *judged.candidates)}"
    else:
        words = "a change that another record has to confirm"
    return words if judged.phase is None else f"{words}, phase {judged.phase}"


def finding(judged: Judged, missing: Missing | None, *, complete: bool) -> str:
    """Return what was found, as the beginning of a sentence.

    missing: why there is no recent record.  complete: whether the motor's reference is.
    """
    found = _found(judged, complete)
    if missing is None or judged.state is State.UNKNOWN:
        return found
    return f"Last known: {found[0].lower()}{found[1:]}"


def beside_stator(judged: Judged) -> str:
    """Return all that is the matter with a motor, where that is not of its stator and channels alone."""
    return findings_beside_stator(
        PartCondition(one.part, one.state, one.finding, explained_by=one.explained_by) for one in judged.parts
    )


def _found(judged: Judged, complete: bool) -> str:
    beside = beside_stator(judged)
    if beside:
        return f"{beside[0].upper()}{beside[1:]}"
    where = "" if judged.phase is None else f" in phase {judged.phase}"
    match judged.state:
        case State.UNKNOWN:
            return "Nothing is known of its windings yet"
        case State.HEALTHY if not complete:
            return "No fault is seen, but a small one could not be seen yet: its reference is being learnt"
        case State.HEALTHY:
            return "No change is seen"
    if judged.kind is Kind.NONE:
        return f"Its asymmetry from the first record on is larger than its sensors explain{where}"
    if judged.kind is Kind.UNCLEAR:
        if not judged.candidates:
            return "The latest record differs from all before; another one has to confirm it"
        return f"A change{where} that may be {_of_kinds(judged, *judged.candidates)}"
    words = _of_kinds(judged, judged.kind)
    if judged.kind is Kind.SHORTED_TURNS and judged.state is State.WATCH and judged.change == 0.0:
        return f"{words[0].upper()}{words[1:]}{where} were seen, and are gone"
    return f"{words[0].upper()}{words[1:]}{where}"


def advice_now(advice: str, state: State, missing: Missing | None) -> str:
    """Return what to do now: without a recent record the advice of a harmless one is no advice any more.

    advice: that of the latest record.  state: what that record told.
    """
    if missing is None or state in (State.FAULT, State.WATCH):
        return advice
    known = "No valid record yet." if state is State.UNKNOWN else f"Last known: {state}."
    if missing is Missing.NOT_RUNNING:
        return f"{known} Have it recorded when it runs again."
    return f"{known} Have the motor recorded, and look whether its relay answers."


def since(when: str, *, is_from_first_record: bool) -> str:
    """Return since when a change is there; of one that the first record shows already that is not known."""
    if is_from_first_record:
        return f"there since the first record, of {when}; since when is not known"
    return f"since {when}"


def level_ahead(ahead: float, limit: float | None, words: Callable[[float], str]) -> str:
    """Return the level that a forecast is about, told from the motor's limit. words: for a level."""
    if limit is None:
        return words(ahead)
    if ahead == limit:
        return f"the motor's limit of {words(limit)}"
    return f"{words(ahead)} (the next level; the motor's limit is {words(limit)})"


def expected(
    level: str, as_of_ns: int, days: Days, now_ns: int, day_of: Callable[[int], str], *, short: bool = False
) -> str:
    """Return in a sentence when a level is reached.

    level: in words.  days: from the latest record on, likely not before, middle, and likely by then.
    day_of: the day of a time, in words.  short: without the earliest and the latest.
    """
    low_ns, middle_ns, high_ns = (as_of_ns + round(one * NANOSECONDS_PER_DAY) for one in days)
    between = f" ({day_of(low_ns)} to {day_of(high_ns)})" if not short else ""
    if middle_ns <= now_ns:
        by = f"{day_of(middle_ns)}{between}"
        return f"It was expected to reach {level} by {by}, counted from the latest record."
    ahead = time_ahead((middle_ns - now_ns) / NANOSECONDS_PER_DAY)
    return f"It likely reaches {level} in about {ahead}, on {day_of(middle_ns)}{between}."


def _of_kinds(judged: Judged, *kinds: Kind) -> str:
    return kinds_in_words(kinds, judged.phase, judged.phase_probabilities, lambda kind: KINDS[Kind(kind)])
