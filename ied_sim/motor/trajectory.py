"""States that a running motor went through in its latest windows.

A window that begins within the one before it, or soon after, goes on from one of these. So windows that
overlap show the same waveforms: rotor angle, swing of the load and all.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ied_sim.motor.contactor import Closure

Array = NDArray[np.float64]

MOST_STATES: Final = 200
BETWEEN_STATES_S: Final = 0.05

Simulate = Callable[[float, int], tuple[Array, Array]]
"""Simulates so many samples from a time on; returns line currents, shape (3, samples), and speed."""


@dataclass(frozen=True, slots=True)
class Passed:
    """A state that the motor passed at `time_s`: fluxes, speed and angle as integration has them."""

    time_s: float
    state: Array


class Trajectory:
    """The latest states of one motor. One thread at a time uses it."""

    def __init__(self) -> None:
        self._passed: deque[Passed] = deque(maxlen=MOST_STATES)

    def passed(self, time_s: float, state: Array) -> None:
        """Remember a state."""
        self._passed.append(Passed(time_s, state.copy()))

    def latest(self, closure: Closure, *, from_s: float, to_s: float, size: int) -> Passed | None:
        """Return the latest state of `size` numbers between two times, None where there is none.

        Only states of this closure of the contactor count.
        """
        known = [
            one
            for one in self._passed
            if from_s <= one.time_s <= to_s
            and closure.closed_s < one.time_s < closure.opened_s
            and one.state.size == size
        ]
        return max(known, key=lambda one: one.time_s, default=None)

    def simulated(
        self, simulate: Simulate, state: Array, first_s: float, samples: int, sample_rate_hz: float
    ) -> tuple[Array, Array]:
        """Return what `simulate` gives, piece by piece; `state` is remembered after each piece."""
        currents, speed = np.empty((3, samples)), np.empty(samples)
        piece = max(1, round(BETWEEN_STATES_S * sample_rate_hz))
        for begin in range(0, max(1, samples - 1), piece):
            end = min(begin + piece, samples - 1)
            currents[:, begin : end + 1], speed[begin : end + 1] = simulate(
                first_s + begin / sample_rate_hz, end - begin + 1
            )
            self.passed(first_s + end / sample_rate_hz, state)
        return currents, speed
