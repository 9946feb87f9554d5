"""A motor followed over its simulated records, and what is said of it after each."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.condition.circuit import Array
from core.condition.bus import StandingEstimate
from core.condition.condition import Condition, condition_of
from core.condition.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.machines.parameters import Motor


@dataclass(frozen=True, slots=True)
class Said:
    """What is said after one record: condition, whether a change is open, and the detector's statistic."""

    condition: Condition
    changed: bool
    statistic: float

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The kind, or the kinds among which it is unclear."""
        return self.condition.candidates or (self.condition.kind,)


def follow(motor: Motor, observations: Iterable[Observation]) -> Iterator[Said]:
    """Fold records one by one and say each time what the motor's condition is."""
    follower = Follower(motor)
    for observation in observations:
        follower.fold(observation)
        yield said_of(follower, motor)


def said_of(follower: Follower, motor: Motor, bus: Sequence[StandingEstimate] = ()) -> Said:
    """What is said of a motor now, beside the standing asymmetries of its bus."""
    assessment = follower.assessment(bus)
    if assessment is None:
        raise ValueError("nothing is said of a motor without a record")
    condition = condition_of(motor, assessment, assessment.as_of_ns)
    return Said(condition, assessment.change is not None, assessment.statistic)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of an event at a record: delays in records from it on, None where it never was.

    seen: a change was found.  called_fault: the state was fault.  phase: the one that was named with the
    fault.  final: the kinds that were named last, empty where no change was open.
    alarmed_before: whether a change was found before the event.
    """

    seen: int | None
    called_fault: int | None
    phase: str | None
    final: tuple[Kind, ...]
    final_state: State
    alarmed_before: bool


def outcome(said: Sequence[Said], first: int) -> Outcome:
    """Read the outcome of an event at record `first` (from 0)."""
    seen = called = None
    phase = None
    for k, one in enumerate(said[first:]):
        if seen is None and (one.changed or one.condition.state is State.FAULT):
            seen = k
        if one.condition.state is State.FAULT:
            called, phase = k, one.condition.phase
            break
    last = said[-1]
    return Outcome(
        seen, called, phase,
        last.kinds if last.changed or last.condition.state is State.FAULT else (),
        last.condition.state,
        any(one.changed for one in said[:first]),
    )  # fmt: skip


def quantile_text(delays: Array, share: float = 0.5) -> str:
    """A quantile of delays, in records counted from 1 for the first that could show it."""
    return f"{np.quantile(delays, share) + 1:.0f}" if delays.size else "-"
