"""Evidence for causes: independent blocks of measured figures, each with likelihoods of its own causes."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import exp, log
from typing import Final, NamedTuple

from core.diagnosis.causes import NOTHING, Cause, Causes

MOST_TOGETHER: Final = 2
"""Causes that are weighed together; three at once are not looked for."""
MOST_NATS: Final = 100.0
"""Evidence that one block counts at most: no model is exact enough to be more certain than that. What goes
beyond is taken off all causes alike, so that it still says how much likelier one is than another."""


@dataclass(frozen=True, slots=True)
class Block:
    """Figures that speak of some causes, and of no others.

    Parameters
    ----------
    causes : frozenset of Cause
        The causes that they speak of.
    log_likelihood : mapping of frozenset of Cause to float
        Log of the likelihood of the figures where these causes are there, over that where none is. It has
        every combination of up to MOST_TOGETHER of the causes that can be there together but the empty one.
    figures : mapping of Cause to str
        What was measured of a cause, in words.
    """

    causes: Causes
    log_likelihood: Mapping[Causes, float]
    figures: Mapping[Cause, str] = field(default_factory=dict)

    def of(self, causes: Causes) -> float:
        """Return the evidence for causes, of which those that the block does not speak of change nothing."""
        own = causes & self.causes
        if own == NOTHING:
            return 0.0
        beyond = max(max(self.log_likelihood.values()) - MOST_NATS, 0.0)
        found = self.log_likelihood[own]
        return max(found - beyond, min(found, 0.0))


def only(cause: Cause, log_ratio: float, figure: str) -> Block:
    """Return the block of figures that speak of one cause alone."""
    causes = frozenset({cause})
    return Block(causes, {causes: log_ratio}, {cause: figure})


class Verdict(NamedTuple):
    """What another part says of one cause, by which it raises alarms.

    Parameters
    ----------
    cause : Cause
        The cause.
    is_there : bool
        Whether it is said to be there.
    words : str
        The verdict in words.
    """

    cause: Cause
    is_there: bool
    words: str


@dataclass(frozen=True, slots=True)
class Evidence:
    """All that is measured of a record, or of a motor.

    Parameters
    ----------
    blocks : tuple of Block
        Independent blocks of figures.
    untold : mapping of Cause to str
        Causes of which nothing is known, and why.
    verdicts : tuple of Verdict, optional
        What is said of single causes elsewhere; only those that are sure of it.
    exclusive : frozenset of Cause, optional
        Causes of which there is one at most.
    """

    blocks: tuple[Block, ...]
    untold: Mapping[Cause, str] = field(default_factory=dict)
    verdicts: tuple[Verdict, ...] = ()
    exclusive: Causes = NOTHING


def log_sum(logs: Sequence[float]) -> float:
    """Return the log of the sum of what logs are given of."""
    highest = max(logs)
    return highest + log(sum(exp(one - highest) for one in logs))


def together(causes: Iterable[Cause], exclusive: Causes = NOTHING) -> list[Causes]:
    """Return all combinations of up to MOST_TOGETHER causes, no two of the exclusive, the empty one first."""
    known = sorted(causes)
    every = (frozenset(some) for n in range(MOST_TOGETHER + 1) for some in combinations(known, n))
    return [some for some in every if len(some & exclusive) < 2]
