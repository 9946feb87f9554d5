"""The state of a motor by part, in a line each, and where more is said of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.condition.kinds import State
from core.motor_condition.parts import RANKS, Part
from service.api.conditions.schemas import PartOfMotor
from service.storage.states import LinkState
from service.web.fleet.states import FleetState

HEALTHY: Final = "No fault detected"
NOT_ASSESSED: Final = "Not assessed: no recording tells of it"


@dataclass(frozen=True, slots=True)
class StripPart:
    """A line of the strip. parts: those of the condition that it tells.  tab: where more is said."""

    name: str
    parts: tuple[Part, ...]
    tab: str


STRIP: Final = (
    StripPart("Stator", (Part.STATOR,), "stator"),
    StripPart("Rotor", (Part.ROTOR, Part.AIR_GAP), "rotor"),
    StripPart("Supply", (Part.SUPPLY,), "supply"),
    StripPart("Load", (Part.LOAD, Part.THERMAL, Part.STARTS, Part.EFFICIENCY), "load"),
    StripPart("Measurement", (Part.MEASUREMENT, Part.PARAMETERS), "nameplate"),
)
DATA: Final = "Data"
OF_DATA: Final = "recordings"


@dataclass(frozen=True, slots=True)
class StripLine:
    """What is said of a part. state: as icons have it.  explained_by: a part that explains it; or empty."""

    name: str
    state: str
    finding: str
    tab: str
    explained_by: str = ""


def strip(
    parts: Sequence[PartOfMotor], states: Sequence[FleetState], link: LinkState, age: str | None
) -> list[StripLine]:
    """Return the lines. states: of the motor.  age: of its latest valid record; None without one."""
    return [*(_line(one, parts) for one in STRIP), _data(states, link, age)]


def _line(line: StripPart, parts: Sequence[PartOfMotor]) -> StripLine:
    first, *beside = line.parts
    # Of what stands beside the first part only that counts which is known.
    found = [
        one for one in parts if one.part is first or (one.part in beside and one.state is not State.UNKNOWN)
    ]
    if not found:
        return StripLine(line.name, State.UNKNOWN, NOT_ASSESSED, line.tab)
    worst = min(found, key=lambda one: (RANKS[one.state], line.parts.index(one.part)))
    by = "" if worst.explained_by is None else worst.explained_by.words
    as_bad = [one for one in found if one.state is worst.state]
    told = [worst] if worst.state is State.HEALTHY else as_bad
    return StripLine(line.name, worst.state, "; ".join(_finding(one, first) for one in told), line.tab, by)


def _finding(one: PartOfMotor, first: Part) -> str:
    finding = one.finding or (HEALTHY if one.state is State.HEALTHY else NOT_ASSESSED)
    return finding if one.part is first else f"{one.part.words}: {finding}"


def _data(states: Sequence[FleetState], link: LinkState, age: str | None) -> StripLine:
    words = "No valid record yet" if age is None else f"Latest valid record {age}"
    absent = next((one for one in states if one in (FleetState.STALE, FleetState.NOT_RUNNING)), None)
    state: str = absent or (State.UNKNOWN if age is None else State.HEALTHY)
    if link in (LinkState.DOWN, LinkState.QUARANTINED):
        return StripLine(DATA, FleetState.STALE, f"{words}; link of the relay: {link.value}", OF_DATA)
    return StripLine(DATA, state, words, OF_DATA)
