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
from core.diagnosis.record_errors import HEALTHY
from core.diagnosis.record_figures import RecordFigures
from core.diagnosis.stator_evidence import StatorEvidence
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
        Mean of the negative-sequence voltages they were recorded at, seen from V1 [V, peak].
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

    def taken_off_figures(self, figures: RecordFigures) -> RecordFigures:
        """Subtract the standing asymmetry from the figures of a record.

        Parameters
        ----------
        figures : RecordFigures
            The record's figures.

        Returns
        -------
        RecordFigures
            The figures without it.
        """
        own_S = self.current.conjugate() / figures.positive_voltage_V
        return replace(figures, negative_current_S=figures.negative_current_S - own_S)

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


def standing(evidence: StatorEvidence) -> tuple[complex, complex]:
    """Return the standing current and the backward-turning voltage of a healthy record.

    Both are seen from the forward-turning voltage.
    """
    figures, point = evidence.errors.figures, evidence.point
    left = evidence.errors.residual(HEALTHY, point.slip, point.offset_s)
    current_S = complex(left[2], -left[3]) / evidence.errors.negative_scale
    volts = figures.positive_voltage_V
    return current_S * volts, figures.negative_voltage * volts


def baseline_of(seen: Iterable[tuple[complex, complex]]) -> Baseline:
    """Average what `standing` tells of healthy recordings."""
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
