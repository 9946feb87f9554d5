"""A motor followed over its simulated records, and what is said of it after each."""

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.condition.circuit import Array
from core.condition.bus.neighbours import StandingEstimate, neighbour_of
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Motor

CLOSELY = 30
"""Records after an event that are judged one by one."""


@dataclass(frozen=True, slots=True)
class Said:
    """What is said after one record, by its number from 0: condition, whether a change is open, and the
    detector's statistic."""

    record: int
    condition: Condition
    changed: bool
    statistic: float

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The kind, or the kinds among which it is unclear."""
        return self.condition.candidates or (self.condition.kind,)


def follow(
    motor: Motor, observations: Iterable[Observation], judged: Container[int] | None = None
) -> Iterator[Said]:
    """Fold records one by one and say what the motor's condition is after each, or after the judged ones."""
    follower = Follower(motor)
    for record, observation in enumerate(observations):
        follower.fold(observation)
        if judged is None or record in judged:
            yield said_of(follower, motor, record)


def judged_around(first: int, records: int) -> frozenset[int]:
    """Which records are judged around an event: all of the first 30 after it, every fifth of the others."""
    return frozenset(
        [
            *range(first % 5 + 4, first, 5),
            *range(first, first + CLOSELY),
            *range(first, records, 5),
            records - 1,
        ]
    )


def follow_together(
    motors: Sequence[Motor],
    every: Sequence[Sequence[Observation | None]],
    judged: Container[int],
    *,
    compared: bool,
) -> tuple[list[Said], list[Said]]:
    """Fold the records of a bus, one of each motor at a time; return what is said of the first motor after
    the judged ones, and of the others after the last.

    None is a record that was refused.  compared: with each other, as the service does it unless it is told of
    a common transformer.
    """
    followers = [Follower(one) for one in motors]
    said = []
    for number, records in enumerate(zip(*every, strict=True)):
        seen = {k: neighbour_of(motors[k], record) for k, record in enumerate(records) if record is not None}
        for k, record in enumerate(records):
            if record is not None:
                others = [one for j, one in seen.items() if j != k] if compared else []
                followers[k].fold(record, others)
        if number in judged:
            said.append(_said_beside(followers, 0, number, compared=compared))
    last = len(every[0]) - 1
    return said, [_said_beside(followers, k, last, compared=compared) for k in range(1, len(motors))]


def _said_beside(followers: Sequence[Follower], k: int, record: int, *, compared: bool) -> Said:
    """What is said of one motor of a bus."""
    others = [one for j, one in enumerate(followers) if j != k] if compared else []
    estimates = [one.standing_estimate() for one in others]
    known = [one for one in estimates if one is not None]
    return said_of(followers[k], followers[k].motor, record, known)


def said_of(follower: Follower, motor: Motor, record: int, bus: Sequence[StandingEstimate] = ()) -> Said:
    """What is said of a motor now, beside the standing asymmetries of its bus."""
    assessment = follower.assessment(bus)
    if assessment is None:
        raise ValueError("nothing is said of a motor without a record")
    condition = condition_of(motor, assessment, assessment.as_of_ns)
    return Said(record, condition, assessment.change is not None, assessment.statistic)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of an event at a record: delays in records from it on, None where it never was.

    seen: a change was found, and none before the event.  called_fault: the state was fault.  phase: the one
    that was named with the fault.  final: the kinds that were named last, empty where no change was open.
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
    alarmed_before = any(one.changed for one in said if one.record < first)
    for one in (one for one in said if one.record >= first):
        k = one.record - first
        if seen is None and not alarmed_before and (one.changed or one.condition.state is State.FAULT):
            seen = k
        if one.condition.state is State.FAULT:
            called, phase = k, one.condition.phase
            break
    last = said[-1]
    return Outcome(
        seen, called, phase,
        last.kinds if last.changed or last.condition.state is State.FAULT else (),
        last.condition.state,
        alarmed_before,
    )  # fmt: skip


def quantile_text(delays: Array, share: float = 0.5) -> str:
    """A quantile of delays, in records counted from 1 for the first that could show it."""
    return f"{np.quantile(delays, share) + 1:.0f}" if delays.size else "-"
