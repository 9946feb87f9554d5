"""The one condition of a motor: its worst part, the causes by their evidence, and what to do first."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from core.classification.classification import FEW, Classification
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.document import time_text
from core.diagnosis.causes import words
from core.motor_condition.judging import classified_parts, merged, stator_parts
from core.motor_condition.parts import Part, PartCondition, counting


class Urgency(StrEnum):
    """How soon somebody has to act."""

    TODAY = "today"
    DAYS = "within-days"
    WEEKS = "within-weeks"
    NEXT_STOP = "next-stop"
    NONE = "none"


KIND_OF_PART: Final[Mapping[Part, Kind]] = MappingProxyType(
    {
        Part.ROTOR: Kind.ROTOR,
        Part.SUPPLY: Kind.SUPPLY,
        Part.STARTS: Kind.STARTS,
        Part.THERMAL: Kind.THERMAL,
        Part.AIR_GAP: Kind.AIR_GAP,
        Part.PARAMETERS: Kind.PARAMETERS,
    }
)
"""Kinds of what a part has; of the stator and the measurement the condition of the stator names it."""
_URGENT: Final = MappingProxyType(
    {
        (Part.STATOR, State.FAULT): Urgency.DAYS,
        (Part.SUPPLY, State.FAULT): Urgency.TODAY,
        (Part.ROTOR, State.FAULT): Urgency.WEEKS,
    }
)


@dataclass(frozen=True, slots=True)
class LikelyCause:
    """Causes that together explain all that is measured, and their probability.

    Parameters
    ----------
    causes : tuple of str
        Names of the causes, "healthy" for none.
    words : str
        The causes in words.
    probability : float
        Probability after all evidence.
    """

    causes: tuple[str, ...]
    words: str
    probability: float

    def as_dict(self) -> dict[str, object]:
        """Return the causes as JSON takes them.

        Returns
        -------
        dict of str to object
            The fields by name.
        """
        return {"causes": list(self.causes), "words": self.words, "probability": self.probability}


@dataclass(frozen=True, slots=True)
class MotorCondition:
    """What is the matter with a motor.

    Parameters
    ----------
    state : State
        State of its worst part; unknown where nothing is known of its stator and no other part is worse.
    kind : Kind
        What the worst part has.
    finding : str
        The same in words.
    since_ns : int or None
        Time of the first record that shows it, UTC [ns].
    urgency : Urgency
        How soon somebody has to act.
    advice : str
        What to do first, then what besides.
    reasons : tuple of str
        Why, in words.
    causes : tuple of LikelyCause
        Explanations of all that is measured, the likeliest first; empty where nothing is known.
    parts : tuple of PartCondition
        What is said of each part.
    stator : Condition
        The condition of the stator, whose figures the document has.
    """

    state: State
    kind: Kind
    finding: str
    since_ns: int | None
    urgency: Urgency
    advice: str
    reasons: tuple[str, ...]
    causes: tuple[LikelyCause, ...]
    parts: tuple[PartCondition, ...]
    stator: Condition

    def of(self, part: Part) -> PartCondition | None:
        """Return what is said of a part.

        Parameters
        ----------
        part : Part
            The part.

        Returns
        -------
        PartCondition or None
            What is said; None where it was not judged.
        """
        return next((one for one in self.parts if one.part is part), None)

    @property
    def is_of_stator(self) -> bool:
        """Whether the condition of the stator tells the kind, and with it the phase."""
        return self.kind not in KIND_OF_PART.values() or self.kind is self.stator.kind

    def as_dict(self) -> dict[str, object]:
        """Return the document that all surfaces show.

        Its keys are a contract: those of the stator's condition, what is said of the whole motor in place of
        what is said of the stator, and the parts.

        Returns
        -------
        dict of str to object
            The document.
        """
        stator = self.stator.as_dict()
        if not self.is_of_stator:
            stator |= {"candidates": [], "phase": None}
        return {
            **stator,
            "state": str(self.state),
            "kind": str(self.kind),
            "finding": self.finding,
            "since": time_text(self.since_ns),
            "urgency": str(self.urgency),
            "advice": self.advice,
            "reasons": list(self.reasons),
            "causes": [one.as_dict() for one in self.causes],
            "parts": [one.as_dict() for one in self.parts],
        }


def motor_condition(
    stator: Condition, beside: Sequence[PartCondition], classification: Classification | None = None
) -> MotorCondition:
    """Return what is the matter with a motor.

    Parameters
    ----------
    stator : Condition
        The condition of its stator.
    beside : sequence of PartCondition
        What was judged of other parts.
    classification : Classification or None, optional
        The causes of all that is measured; None where they were not weighed.

    Returns
    -------
    MotorCondition
        The condition.
    """
    told = () if classification is None else classified_parts(classification)
    parts = merged((*stator_parts(stator), *beside, *told))
    found = counting(parts)
    return MotorCondition(
        state=found[0].state_of_motor if found else _quiet(stator.state),
        kind=_kind(found, stator),
        finding=_headline(found, parts),
        since_ns=found[0].since_ns if found else None,
        urgency=_urgency(found),
        advice=_advice(found, stator),
        reasons=_reasons(found, stator),
        causes=() if classification is None else _likely(classification),
        parts=parts,
        stator=stator,
    )


def _quiet(stator: State) -> State:
    """Return the state of a motor without a part that counts; of an unknown stator it is unknown."""
    return State.UNKNOWN if stator is State.UNKNOWN else State.HEALTHY


def _kind(found: Sequence[PartCondition], stator: Condition) -> Kind:
    if not found:
        return Kind.NONE
    # A ratio that drifts is of the measurement, and parameters tell it: no change of the stator's condition.
    named = Kind.PARAMETERS if stator.state is State.HEALTHY else stator.kind
    return KIND_OF_PART.get(found[0].part, named)


def _headline(found: Sequence[PartCondition], parts: Sequence[PartCondition]) -> str:
    if found:
        return "; ".join(one.finding for one in found)
    return next((one.finding for one in parts if one.part is Part.STATOR), "")


def _urgency(found: Sequence[PartCondition]) -> Urgency:
    order = tuple(Urgency)
    urgencies = [_URGENT.get((one.part, one.state), Urgency.NEXT_STOP) for one in found]
    return min(urgencies, key=order.index, default=Urgency.NONE)


def _advice(found: Sequence[PartCondition], stator: Condition) -> str:
    if not found:
        return stator.advice
    first, *others = found
    also = [f"Beside that, {one.part.words}: {one.advice}" for one in others if one.advice]
    return " ".join((first.advice, *also))


def _reasons(found: Sequence[PartCondition], stator: Condition) -> tuple[str, ...]:
    """Return why: of parts beside the stator under their names; of a stator that is healthy, too."""
    reasons: list[str] = []
    for one in found:
        is_of_stator = one.reasons == stator.reasons
        reasons += one.reasons if is_of_stator else [f"{one.part.words}: {each}" for each in one.reasons]
    reasons += [each for each in stator.reasons if each not in reasons]
    return tuple(reasons)


def _likely(classification: Classification) -> tuple[LikelyCause, ...]:
    if not classification.is_assessed:
        return ()
    return tuple(
        LikelyCause(tuple(one.names), words(one.causes), one.probability)
        for one in classification.explanations
        if one.probability >= FEW
    )
