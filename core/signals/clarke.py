"""Power-invariant Clarke transform between phases a, b, c and the stationary axes alpha, beta.

`x_abc` has rows a, b, c; `x_ab` has rows alpha, beta (the suffix _ab always means alpha-beta, as in the
thesis). The zero sequence is dropped: motors are connected with three wires. "Power invariant" means
v_ab . i_ab = v_abc . i_abc, so a balanced set of rms value X has axes of rms value sqrt(3/2) X.
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

CLARKE = sqrt(2 / 3) * np.array([[1.0, -0.5, -0.5], [0.0, sqrt(3) / 2, -sqrt(3) / 2]])
"""T of thesis (3.11), shape (2, 3); its transpose is the way back (3.21)."""

CLARKE_FROM_LINE = np.array([[sqrt(2 / 3) / 2, 0.0, -sqrt(2 / 3) / 2], [0.0, sqrt(1 / 2), 0.0]])
"""Matrix of the same axes from line voltages ab, bc, ca, shape (2, 3)."""


def clarke(x_abc: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform phase quantities to power-invariant Clarke axes (3.11).

    Parameters
    ----------
    x_abc : ndarray, shape (3, n)
        Quantities of phases a, b, c.

    Returns
    -------
    ndarray, shape (2, n)
        Alpha and beta, in the same unit.
    """
    return CLARKE @ x_abc


def inverse_clarke(x_ab: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform Clarke axes to phase quantities without zero sequence (3.21).

    Parameters
    ----------
    x_ab : ndarray, shape (2, n)
        Alpha and beta.

    Returns
    -------
    ndarray, shape (3, n)
        Quantities of phases a, b, c, in the same unit.
    """
    return CLARKE.T @ x_ab


def clarke_from_line_voltages(v_line: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform line voltages to power-invariant Clarke axes.

    v_alpha = sqrt(2/3) (v_ab - v_ca)/2, v_beta = sqrt(1/2) v_bc: what `clarke` gives of the phase voltages
    against any star point, whose potential cancels.

    Parameters
    ----------
    v_line : ndarray, shape (3, n)
        Voltages v_ab, v_bc, v_ca [V].

    Returns
    -------
    ndarray, shape (2, n)
        Alpha and beta [V].
    """
    return CLARKE_FROM_LINE @ v_line
