"""Symmetrical components from phasors in Clarke axes; unbalance and phase order of a supply."""

from dataclasses import dataclass
from enum import StrEnum
from math import sqrt

import numpy as np
from numpy.typing import NDArray


class PhaseSequence(StrEnum):
    """Order in which the phases reach their maxima."""

    ABC = "abc"
    ACB = "acb"


@dataclass(frozen=True, slots=True)
class SequencePhasors:
    """Phasors of phase a, rms, in its unit.

    `positive` turns a, b, c as the terminals are labelled, `negative` a, c, b, whatever the supply does.
    """

    positive: complex
    negative: complex

    @property
    def sequence(self) -> PhaseSequence:
        """Phase order of the supply: that of the stronger component."""
        return PhaseSequence.ABC if abs(self.positive) >= abs(self.negative) else PhaseSequence.ACB

    @property
    def unbalance_factor(self) -> float:
        """|X2| / |X1|, fraction; 1 is the supply's own sequence (thesis 6.26, inverted in print).

        NaN where there is neither: an unexcited supply has no unbalance.
        """
        stronger, weaker = sorted((abs(self.positive), abs(self.negative)), reverse=True)
        return weaker / stronger if stronger > 0 else float("nan")


def sequence_phasors(x_ab: NDArray[np.complex128]) -> SequencePhasors:
    """Symmetrical components of phase a from the rms phasors of the Clarke axes, shape (2,).

    X1 = (X_alpha + j X_beta)/sqrt(6) and X2 = (X_alpha - j X_beta)/sqrt(6): Fortescue's
    (X_a + a X_b + a^2 X_c)/3 and (X_a + a^2 X_b + a X_c)/3, written for the power-invariant axes.
    """
    alpha, beta = complex(x_ab[0]), complex(x_ab[1])
    return SequencePhasors(positive=(alpha + 1j * beta) / sqrt(6), negative=(alpha - 1j * beta) / sqrt(6))
