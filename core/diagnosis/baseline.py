"""A motor's own standing asymmetry, learnt from its healthy recordings and taken off later ones.

Sensors' ratios, joints and windings give every motor a backward-turning current of its own. Against the
voltage it keeps its size and direction, so it is averaged in that frame and subtracted before a diagnosis.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.hypotheses import Explanation

FEWEST_RECORDINGS = 3
REMAINING = 0.3
"""Share of what sensors and parameters feign that changes with load and temperature all the same."""


@dataclass(frozen=True, slots=True)
class Baseline:
    """Mean of the standing currents and their scatter (standard deviation) [A, peak], how many there were,
    and the share of the tolerances that remains."""

    current: complex
    scatter: float
    recordings: int
    remaining: float = REMAINING

    @property
    def error_A(self) -> float:
        """Standard deviation of the mean."""
        return self.scatter / sqrt(self.recordings)

    def taken_off(self, case: Case) -> Case:
        """The case with the standing asymmetry subtracted from its currents."""
        w = case.supply.angular_frequency
        t = np.arange(case.current_ab.shape[1]) / case.sample_rate_hz
        backward = self.current * _voltage_direction(case).conjugate() * np.exp(-1j * w * t)
        return replace(case, current_ab=case.current_ab - np.stack([backward.real, backward.imag]))


def standing_current(explanation: Explanation) -> complex:
    """Backward-turning winding current the healthy machine leaves, from the forward voltage [A, peak]."""
    voltage = explanation.record.voltage.forward
    return explanation.healthy.left * voltage / abs(voltage)


def baseline_of(standing: Iterable[complex]) -> Baseline:
    """Baseline from healthy recordings' standing currents; fewer than three say nothing of their scatter."""
    currents = np.array(list(standing))
    if currents.size < FEWEST_RECORDINGS:
        raise DiagnosisError(
            f"a baseline needs at least {FEWEST_RECORDINGS} healthy recordings, found {currents.size}"
        )
    return Baseline(
        current=complex(currents.mean()),
        scatter=float(np.std(currents, ddof=1)),
        recordings=int(currents.size),
    )


def _voltage_direction(case: Case) -> complex:
    alpha, beta = (complex(value) for value in case.supply.phasor)
    forward = alpha + 1j * beta
    return forward / abs(forward)
