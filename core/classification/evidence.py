"""Evidence for causes: independent blocks of measured figures, each with likelihoods of its own causes."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import exp, log
from typing import Final, NamedTuple

from core.classification.causes import NOTHING, Cause, Causes

MOST_TOGETHER: Final = 2
"""Causes that are weighed together; three at once are not looked for."""
MOST_NATS: Final = 100.0
"""Evidence that one block counts at most: no model is exact enough to be more certain than that. Stronger
evidence is scaled down as a whole, so that it still says which of two causes is likelier."""


@dataclass(frozen=True, slots=True)
class Block:
    """Figures that speak of some causes, and of no others.

    Parameters
    ----------
    causes : frozenset of Cause
        The causes that they speak of.
    log_likelihood : mapping of frozenset of Cause to float
        Log of the likelihood of the figures where these causes are there, over that where none is. It has
        every combination of up to MOST_TOGETHER of the causes but the empty one.
    figures : mapping of Cause to str
        What was measured of a cause, in words.
    """

    causes: Causes
    log_likelihood: Mapping[Causes, float]
    figures: Mapping[Cause, str] = field(default_factory=dict)

    def of(self, causes: Causes) -> float:
        """Return the evidence for causes, of which those that the block does not speak of change nothing.

        Parameters
        ----------
        causes : frozenset of Cause
            Causes that are there together.

        Returns
        -------
        float
            Log of the likelihood ratio to none of them, scaled to MOST_NATS [nats].
        """
        own = causes & self.causes
        if own == NOTHING:
            return 0.0
        most = max(self.log_likelihood.values())
        return self.log_likelihood[own] * min(1.0, MOST_NATS / max(most, MOST_NATS))


def only(cause: Cause, log_ratio: float, figure: str) -> Block:
    """Return the block of figures that speak of one cause alone.

    Parameters
    ----------
    cause : Cause
        The cause.
    log_ratio : float
        Log of their likelihood with the cause over that without it [nats].
    figure : str
        What was measured, in words.

    Returns
    -------
    Block
        The block.
    """
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
    """

    blocks: tuple[Block, ...]
    untold: Mapping[Cause, str] = field(default_factory=dict)
    verdicts: tuple[Verdict, ...] = ()


def log_sum(logs: Sequence[float]) -> float:
    """Return the log of the sum of what logs are given of.

    Parameters
    ----------
    logs : sequence of float
        Logs, one at least.

    Returns
    -------
    float
        Log of the sum.
    """
    highest = max(logs)
    return highest + log(sum(exp(one - highest) for one in logs))


def together(causes: Iterable[Cause]) -> list[Causes]:
    """Return all combinations of up to MOST_TOGETHER causes, the empty one first.

    Parameters
    ----------
    causes : iterable of Cause
        Causes.

    Returns
    -------
    list of frozenset of Cause
        Combinations.
    """
    known = sorted(causes)
    return [frozenset(some) for n in range(MOST_TOGETHER + 1) for some in combinations(known, n)]
