"""Slow random wander as a function of time alone: any moment can be asked for, again and again."""

from dataclasses import dataclass
from functools import lru_cache
from math import sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_STEPS = 20
"""Steps in a time constant."""
_MEMORY = 10 * _STEPS
"""Steps after which the wander has forgotten."""
_BLOCK = 1024
_ORIGIN = 2**40
"""Puts the numbers of steps before time zero above zero, as the random generator needs them."""


@dataclass(frozen=True, slots=True)
class Wander:
    """Gaussian wander of standard deviation one that forgets exponentially, joined by lines.

    It is an autoregressive process of first order: each step keeps exp(-1/20) of the value before and adds
    white noise, `_STEPS` steps a time constant. `stream` tells wanders of one seed apart.
    """

    seed: int
    stream: int
    time_constant_s: float

    def at(self, time_s: Array) -> Array:
        """Return the wander at the times [s], shape (n,)."""
        step_s = self.time_constant_s / _STEPS
        before = np.unique(np.floor(time_s / step_s))
        nodes = np.union1d(before, before + 1)
        values = np.array([_node(self.seed, self.stream, int(node)) for node in nodes])
        wandered: Array = np.interp(time_s, nodes * step_s, values)
        return wandered


@lru_cache(maxsize=4096)
def _node(seed: int, stream: int, node: int) -> float:
    keeps = np.exp(-1 / _STEPS)
    noise = _white(seed, stream, node - _MEMORY + 1, _MEMORY)
    weights = keeps ** np.arange(_MEMORY - 1, -1, -1)
    return float(weights @ noise) * sqrt(1 - keeps**2)


def _white(seed: int, stream: int, first: int, count: int) -> Array:
    """Return white noise of the steps from `first` on."""
    blocks = range(first // _BLOCK, (first + count - 1) // _BLOCK + 1)
    noise = np.concatenate([_block(seed, stream, block) for block in blocks])
    begin = first - blocks[0] * _BLOCK
    return noise[begin : begin + count]


@lru_cache(maxsize=256)
def _block(seed: int, stream: int, block: int) -> Array:
    return np.random.default_rng([seed, stream, block + _ORIGIN]).standard_normal(_BLOCK)
