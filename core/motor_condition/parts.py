"""The parts of a motor and of what surrounds it, and what is said of each."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Final

from core.condition.kinds import State
from core.condition.verdict.document import time_ns_of, time_text


class Part(StrEnum):
    """What a condition is said of. Of equal states, the first one is what the motor's headline tells."""

    STATOR = "stator"
    ROTOR = "rotor"
    SUPPLY = "supply"
    MEASUREMENT = "measurement"
    """Transformers and channels: a finding of them is not one of the motor, but it may hide one."""
    STARTS = "starts"
    THERMAL = "thermal"
    AIR_GAP = "air-gap"
    PARAMETERS = "parameters"
    LOAD = "load"
    EFFICIENCY = "efficiency"
    """What running costs: it has an alarm, and says nothing of the motor's health."""

    @property
    def words(self) -> str:
        """The part in words."""
        return self.value.replace("-", " ")


OF_ASYMMETRY: Final = (Part.STATOR, Part.MEASUREMENT)
"""Parts whose findings the condition of the stator names, with their phase."""

AROUND: Final = (Part.SUPPLY, Part.MEASUREMENT, Part.LOAD)
"""What surrounds the motor: whatever it is in, the motor itself has no fault."""

RANKS: Final[Mapping[State, int]] = MappingProxyType(
    {State.FAULT: 0, State.WATCH: 1, State.UNKNOWN: 2, State.HEALTHY: 3}
)
"""Order in which states need attention."""


@dataclass(frozen=True, slots=True)
class PartCondition:
    """What is said of one part.

    Parameters
    ----------
    part : Part
        The part.
    state : State
        Its state; unknown where no record tells.
    finding : str
        What is the matter, or that nothing is, in a few words.
    since_ns : int or None, optional
        Time of the first record that shows it, UTC [ns].
    advice : str, optional
        What to do; empty where nothing needs to be done.
    reasons : tuple of str, optional
        Why, in words.
    explained_by : Part or None, optional
        The part whose finding explains this one, which then does not count again.
    """

    part: Part
    state: State
    finding: str
    since_ns: int | None = None
    advice: str = ""
    reasons: tuple[str, ...] = ()
    explained_by: Part | None = None

    @property
    def counts(self) -> bool:
        """Whether somebody has to look after it, and not after another part alone."""
        return self.state in (State.FAULT, State.WATCH) and self.explained_by is None

    def as_dict(self) -> dict[str, object]:
        """Return the part as JSON takes it.

        Returns
        -------
        dict of str to object
            Its fields by name; the time as RFC 3339.
        """
        return {
            "part": str(self.part),
            "state": str(self.state),
            "finding": self.finding,
            "since": time_text(self.since_ns),
            "advice": self.advice,
            "reasons": list(self.reasons),
            "explained_by": None if self.explained_by is None else str(self.explained_by),
        }

    @property
    def state_of_motor(self) -> State:
        """What the part makes of the motor's state: one around it puts it on watch at most."""
        return State.WATCH if self.part in AROUND and self.state is State.FAULT else self.state

    @property
    def has_own_words(self) -> bool:
        """Whether its finding is none that the stator's condition has words for."""
        return self.part not in OF_ASYMMETRY

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> "PartCondition":
        """Return the part that a document tells.

        Parameters
        ----------
        document : mapping of str to object
            What `as_dict` returned.

        Returns
        -------
        PartCondition
            The part.
        """
        by = document["explained_by"]
        return cls(
            part=Part(document["part"]),
            state=State(document["state"]),
            finding=document["finding"],
            since_ns=time_ns_of(document["since"]),
            advice=document["advice"],
            reasons=tuple(document["reasons"]),
            explained_by=None if by is None else Part(by),
        )


def counting(parts: Iterable[PartCondition]) -> list[PartCondition]:
    """Return the parts of a motor's health that somebody has to look after, the worst first.

    Parameters
    ----------
    parts : iterable of PartCondition
        Parts of a motor.

    Returns
    -------
    list of PartCondition
        Those that count.
    """
    found = (one for one in parts if one.counts and one.part is not Part.EFFICIENCY)
    return sorted(found, key=lambda one: RANKS[one.state_of_motor])


def findings_beside_stator(parts: Iterable[PartCondition]) -> str:
    """Return what is the matter with a motor where that is not of its stator and its channels alone.

    Parameters
    ----------
    parts : iterable of PartCondition
        Parts of a motor.

    Returns
    -------
    str
        All findings that count, the worst first; empty where the condition of the stator has better words.
    """
    found = counting(parts)
    return "; ".join(one.finding for one in found) if any(one.has_own_words for one in found) else ""


def parts_of(document: Mapping[str, Any] | None) -> tuple[PartCondition, ...]:
    """Return the parts that a document of a motor's condition has.

    Parameters
    ----------
    document : mapping of str to object or None
        What `MotorCondition.as_dict` returned; None before the first one.

    Returns
    -------
    tuple of PartCondition
        The parts; none of a document that has none.
    """
    return tuple(PartCondition.from_dict(one) for one in (document or {}).get("parts", ()))
