"""Lines at both sides of the fundamental, fitted by least squares beside what is slow.

The lines stand at kappa times twice the slip, kappa near 1: their phase follows the slip through the record,
so that a load that changes slowly does not smear them.
"""

from dataclasses import dataclass, replace

import numpy as np

from core.machines.base import Array
from core.machines.steady_state import ComplexArray
from core.rotor.baseband import Baseband

LONG_TURNS = 4.0
"""Cycles of the sidebands' distance over the record from which on it fades in and out (Hann), so that lines
of the load farther off do not leak in, and more than a straight line counts as slow. A shorter record has to
be used to its ends."""
SLOW_DEGREE = 3


@dataclass(frozen=True, slots=True)
class Lines:
    """Amplitudes of a space vector's lines, in the frame of the supply.

    Parameters
    ----------
    upper : ndarray of complex, shape (kappas, 2)
        Of voltage and current at + kappa 2s f.
    lower : ndarray of complex, shape (kappas, 2)
        At - kappa 2s f.
    """

    upper: ComplexArray
    lower: ComplexArray

    def at(self, index: int) -> "Lines":
        """Return one of the pairs.

        Parameters
        ----------
        index : int
            Its number.

        Returns
        -------
        Lines
            The pair.
        """
        return Lines(self.upper[index : index + 1], self.lower[index : index + 1])

    def with_lower_current(self, current: complex) -> "Lines":
        """Return the same pairs with another current at the lower sideband.

        Parameters
        ----------
        current : complex
            The current [A].

        Returns
        -------
        Lines
            The pairs.
        """
        lower = self.lower.copy()
        lower[:, 1] = current
        return Lines(self.upper, lower)


def sideband_angle(baseband: Baseband, slip: Array) -> Array:
    """Return the angle through which the rotor falls behind the supply, twice.

    Parameters
    ----------
    baseband : Baseband
        The record.
    slip : ndarray, shape (n,)
        Slip over the record.

    Returns
    -------
    ndarray, shape (n,)
        Integral of 2 s w_s over time, zero in the middle [rad].
    """
    rate = 2.0 * slip * baseband.angular_frequency
    step_s = float(baseband.time_s[1] - baseband.time_s[0])
    angle = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) * (step_s / 2.0))])
    return np.asarray(angle - angle[angle.size // 2])


def fit_lines(baseband: Baseband, angle: Array, kappa: Array) -> Lines:
    """Fit pairs of lines, one pair after the other, with the slow part beside each.

    Parameters
    ----------
    baseband : Baseband
        The record.
    angle : ndarray, shape (n,)
        Angle of the sidebands for kappa = 1 [rad].
    kappa : ndarray, shape (kappas,)
        Where to fit.

    Returns
    -------
    Lines
        Amplitudes of voltage and current.
    """
    turns = float(angle[-1] - angle[0]) / (2.0 * np.pi)
    n, degree = angle.size, SLOW_DEGREE if turns >= LONG_TURNS else 1
    weight = np.hanning(n + 2)[1:-1] if turns >= LONG_TURNS else np.ones(n)
    slow_basis = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, n), degree).T
    both = np.stack([baseband.voltage, baseband.current])
    weighted_slow, weighted = slow_basis * weight, both * weight
    slow_slow, slow_both = weighted_slow @ slow_basis.T, weighted_slow @ both.T
    count = degree + 1
    gram = np.empty((kappa.size, count + 2, count + 2), np.complex128)
    right = np.empty((kappa.size, count + 2, 2), np.complex128)
    gram[:, :count, :count], right[:, :count] = slow_slow, slow_both
    for k, ratio in enumerate(kappa.tolist()):
        line = np.exp(1j * ratio * angle)
        on_slow = weighted_slow @ line
        gram[k, :count, -2], gram[k, :count, -1] = on_slow, on_slow.conj()
        gram[k, -2, :count], gram[k, -1, :count] = on_slow.conj(), on_slow
        gram[k, -2, -2] = gram[k, -1, -1] = weight.sum()
        gram[k, -1, -2] = weight @ line**2
        gram[k, -2, -1] = gram[k, -1, -2].conj()
        right[k, -2], right[k, -1] = weighted @ line.conj(), weighted @ line
    found = np.linalg.solve(gram, right)[:, -2:]
    found /= _gain(baseband, angle, kappa)[:, np.newaxis, np.newaxis]
    return Lines(upper=np.asarray(found[:, 0]), lower=np.asarray(found[:, 1]))


def without_lines(baseband: Baseband, angle: Array, kappa: Array, lines: Lines) -> Baseband:
    """Take pairs of lines off a record.

    Parameters
    ----------
    baseband : Baseband
        The record.
    angle : ndarray, shape (n,)
        Angle of the sidebands for kappa = 1 [rad].
    kappa : ndarray, shape (kappas,)
        Where the pairs stand.
    lines : Lines
        Their amplitudes.

    Returns
    -------
    Baseband
        What is left.
    """
    turning = np.exp(1j * np.outer(kappa, angle)) * _gain(baseband, angle, kappa)[:, np.newaxis]
    fitted = lines.upper.T @ turning + lines.lower.T @ turning.conj()
    return replace(baseband, voltage=baseband.voltage - fitted[0], current=baseband.current - fitted[1])


def _gain(baseband: Baseband, angle: Array, kappa: Array) -> Array:
    """Return what the means over cycles leave of the lines."""
    mean_hertz = float(angle[-1] - angle[0]) / (2.0 * np.pi * baseband.span_s)
    return baseband.gain(kappa * mean_hertz)
