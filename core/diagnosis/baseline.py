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
from core.diagnosis.tolerance import backward_voltage

FEWEST_RECORDINGS = 3
REMAINING = 0.3
"""Share of what sensors feign that changes with load and temperature all the same."""


@dataclass(frozen=True, slots=True)
class Baseline:
    """What healthy recordings show standing.

    current, scatter: mean of the standing currents, their standard deviation [A, peak].
    unbalance_V: mean of the backward-turning voltages they were recorded at [V, peak].
    remaining: share of what sensors feign that is left.
    """

    current: complex
    scatter: float
    unbalance_V: complex
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


def standing(explanation: Explanation) -> tuple[complex, complex]:
    """Backward-turning winding current the healthy machine leaves [A, peak] and the backward-turning voltage
    [V, peak], both seen from the forward voltage."""
    voltage = explanation.record.voltage
    direction = voltage.forward / abs(voltage.forward)
    return explanation.healthy.left * direction, backward_voltage(voltage.forward, voltage.backward)


def baseline_of(seen: Iterable[tuple[complex, complex]]) -> Baseline:
    """Baseline from what `standing` tells of healthy recordings; fewer than three tell nothing of scatter."""
    currents, voltages = np.array(list(seen)).reshape(-1, 2).T
    if currents.size < FEWEST_RECORDINGS:
        raise DiagnosisError(
            f"a baseline needs at least {FEWEST_RECORDINGS} healthy recordings, found {currents.size}"
        )
    return Baseline(
        current=complex(currents.mean()),
        scatter=float(np.std(currents, ddof=1)),
        unbalance_V=complex(voltages.mean()),
        recordings=int(currents.size),
    )


def _voltage_direction(case: Case) -> complex:
    alpha, beta = (complex(value) for value in case.supply.phasor)
    forward = alpha + 1j * beta
    return forward / abs(forward)
