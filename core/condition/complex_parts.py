"""Complex numbers given by their real and imaginary parts, as the filter has them."""

from collections.abc import Sequence

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled


def turned(vector: Array, factor: complex) -> Array:
    """Multiply a complex number by a factor.

    Parameters
    ----------
    vector : ndarray, shape (2,)
        Real and imaginary part.
    factor : complex
        The factor.

    Returns
    -------
    ndarray, shape (2,)
        Real and imaginary part of the product.
    """
    value = complex(vector[0], vector[1]) * factor
    return np.array([value.real, value.imag])


def rotated(covariance: Array, factor: complex) -> Array:
    """Return the covariance of a complex number that is multiplied by a factor.

    Parameters
    ----------
    covariance : ndarray, shape (2, 2)
        Covariance of its parts.
    factor : complex
        The factor.

    Returns
    -------
    ndarray, shape (2, 2)
        Covariance of the product's parts.
    """
    turn = np.array([[factor.real, -factor.imag], [factor.imag, factor.real]])
    return np.asarray(turn @ covariance @ turn.T)


def symmetric(values: Sequence[float]) -> Array:
    """Return the symmetric matrix of its elements.

    Parameters
    ----------
    values : sequence of float
        Elements 00, 01, 11.

    Returns
    -------
    ndarray, shape (2, 2)
        The matrix.
    """
    return np.array([[values[0], values[1]], [values[1], values[2]]])


@compiled
def inverse(matrix: Array) -> Array:
    """Return the inverse of a matrix of two rows and columns.

    Parameters
    ----------
    matrix : ndarray, shape (2, 2)
        The matrix.

    Returns
    -------
    ndarray, shape (2, 2)
        Its inverse.
    """
    a, b, c, d = matrix[0, 0], matrix[0, 1], matrix[1, 0], matrix[1, 1]
    determinant = a * d - b * c
    out = np.empty((2, 2))
    out[0, 0], out[0, 1] = d / determinant, -b / determinant
    out[1, 0], out[1, 1] = -c / determinant, a / determinant
    return out
