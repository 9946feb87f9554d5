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
    """Symmetrical components of phase a, rms, in the unit of the quantity.

    Parameters
    ----------
    positive : complex
        Component that turns a, b, c as the terminals are labelled, whatever the supply does.
    negative : complex
        Component that turns a, c, b.
    """

    positive: complex
    negative: complex

    @property
    def sequence(self) -> PhaseSequence:
        """Phase order of the supply: that of the stronger component."""
        return PhaseSequence.ABC if abs(self.positive) >= abs(self.negative) else PhaseSequence.ACB

    @property
    def unbalance_factor(self) -> float:
        """Weaker over stronger component, |X2| / |X1| (thesis 6.26, inverted in print).

        It is NaN where there is neither: an unexcited supply has no unbalance.
        """
        stronger, weaker = sorted((abs(self.positive), abs(self.negative)), reverse=True)
        return weaker / stronger if stronger > 0 else float("nan")


def sequence_phasors(x_ab: NDArray[np.complex128]) -> SequencePhasors:
    """Split the phasors of the Clarke axes into symmetrical components of phase a.

    X1 = (X_alpha + j X_beta)/sqrt(6) and X2 = (X_alpha - j X_beta)/sqrt(6): Fortescue's (X_a + a X_b + a^2
    X_c)/3 and (X_a + a^2 X_b + a X_c)/3, written for the power-invariant axes.

    Parameters
    ----------
    x_ab : ndarray of complex, shape (2,)
        Phasors of both axes, rms.

    Returns
    -------
    SequencePhasors
        The components.
    """
    alpha, beta = complex(x_ab[0]), complex(x_ab[1])
    return SequencePhasors(positive=(alpha + 1j * beta) / sqrt(6), negative=(alpha - 1j * beta) / sqrt(6))
