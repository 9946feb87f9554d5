"""A motor's standing asymmetry, learnt from its healthy recordings and subtracted from later ones.

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
from core.diagnosis.verdict import RELATIVE

FEWEST_RECORDINGS = 3
REMAINING = 0.3
"""Share of the sensors' asymmetry that changes with load and temperature and remains after subtraction."""


@dataclass(frozen=True, slots=True)
class Baseline:
    """The motor's own standing asymmetry, as its healthy recordings show it.

    Parameters
    ----------
    current : complex
        Mean of the standing currents [A, peak].
    scatter : float
        Standard deviation of the standing currents [A, peak].
    unbalance_V : complex
        Mean of the backward-turning voltages they were recorded at [V, peak].
    recordings : int
        Number of recordings.
    remaining : float, optional
        Share of the sensors' apparent asymmetry that is left after subtraction.
    """

    current: complex
    scatter: float
    unbalance_V: complex
    recordings: int
    remaining: float = REMAINING

    @property
    def reason(self) -> str:
        """Reason in a diagnosis that was made relative to it."""
        return f"{RELATIVE} {self.recordings} healthy recordings"

    @property
    def error_A(self) -> float:
        """Standard deviation of the mean current [A, peak]."""
        return self.scatter / sqrt(self.recordings)

    def taken_off(self, case: Case) -> Case:
        """Subtract the standing asymmetry from the currents of a record.

        Parameters
        ----------
        case : Case
            The record in the winding frame.

        Returns
        -------
        Case
            The record without it.
        """
        w = case.supply.angular_frequency
        t = np.arange(case.current_ab.shape[1]) / case.sample_rate_hz
        backward = self.current * _voltage_direction(case).conjugate() * np.exp(-1j * w * t)
        return replace(case, current_ab=case.current_ab - np.stack([backward.real, backward.imag]))


def standing(explanation: Explanation) -> tuple[complex, complex]:
    """Return the standing current and the backward-turning voltage of a healthy record.

    Both are seen from the forward-turning voltage.

    Parameters
    ----------
    explanation : Explanation
        The hypothesis that explains the currents best.

    Returns
    -------
    current : complex
        Backward-turning winding current that the healthy machine leaves [A, peak].
    voltage : complex
        Backward-turning voltage [V, peak].
    """
    voltage = explanation.record.voltage
    direction = voltage.forward / abs(voltage.forward)
    return explanation.healthy.left * direction, backward_voltage(voltage.forward, voltage.backward)


def baseline_of(seen: Iterable[tuple[complex, complex]]) -> Baseline:
    """Average what `standing` tells of healthy recordings.

    Parameters
    ----------
    seen : iterable of tuple of complex
        Current and voltage of each recording.

    Returns
    -------
    Baseline
        The baseline.

    Raises
    ------
    DiagnosisError
        If there are fewer than three, which tell nothing of scatter.
    """
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
