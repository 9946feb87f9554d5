"""From the terminals to the windings: the frame in which the machine models count.

The models know windings in a supply of positive sequence. A delta is turned into its windings, and a supply
of sequence a-c-b is mirrored, so that rotation, slip and load always count positive.
"""

from math import pi, sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Connection
from core.machines.stator_winding import Winding
from core.signals.clarke import inverse_clarke
from core.signals.sequence import PhaseSequence

_TERMINAL_WINDINGS: dict[tuple[Connection, PhaseSequence], tuple[Winding, Winding, Winding]] = {
    (Connection.STAR, PhaseSequence.ABC): (0, 1, 2),
    (Connection.DELTA, PhaseSequence.ABC): (0, 1, 2),
    # Mirroring exchanges terminals b and c, so in delta the windings a-b and c-a change places.
    (Connection.STAR, PhaseSequence.ACB): (0, 2, 1),
    (Connection.DELTA, PhaseSequence.ACB): (2, 1, 0),
}


def to_winding_frame(
    current_ab: Array, voltage_ab: Array, sequence: PhaseSequence, connection: Connection
) -> tuple[Array, Array]:
    """Turn terminal quantities into those of the windings in a positive-sequence supply.

    Parameters
    ----------
    current_ab, voltage_ab : ndarray, shape (2, n)
        Line currents [A] and line-to-neutral voltages [V] on power-invariant Clarke axes.
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    connection : Connection
        Star or delta.

    Returns
    -------
    current_ab : ndarray, shape (2, n)
        Currents of the windings on the same axes [A].
    voltage_ab : ndarray, shape (2, n)
        Voltages of the windings on the same axes [V].
    """
    if sequence is PhaseSequence.ACB:
        mirror = np.array([[1.0], [-1.0]])
        current_ab, voltage_ab = mirror * current_ab, mirror * voltage_ab
    if connection is Connection.DELTA:
        # v_ab = v_a - v_b and i_a = i_ab - i_ca turn and stretch the space vectors by sqrt 3 and 30 degrees.
        ahead = _rotation(pi / 6.0)
        current_ab, voltage_ab = ahead @ current_ab / sqrt(3.0), ahead @ voltage_ab * sqrt(3.0)
    return current_ab, voltage_ab


def line_currents(current_ab: Array, sequence: PhaseSequence, connection: Connection) -> Array:
    """Turn currents of the windings back into those of the lines, the way back from `to_winding_frame`.

    Parameters
    ----------
    current_ab : ndarray, shape (2, n)
        Currents of the windings on power-invariant Clarke axes, in a positive-sequence supply [A].
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    connection : Connection
        Star or delta.

    Returns
    -------
    ndarray, shape (3, n)
        Line currents of terminals a, b, c, which sum to zero [A].
    """
    if connection is Connection.DELTA:
        current_ab = sqrt(3.0) * (_rotation(-pi / 6.0) @ current_ab)
    if sequence is PhaseSequence.ACB:
        current_ab = np.array([[1.0], [-1.0]]) * current_ab
    return inverse_clarke(current_ab)


def terminal_winding(winding: int, sequence: PhaseSequence, connection: Connection) -> Winding:
    """Give the number under which the terminals know a winding of the winding frame.

    Parameters
    ----------
    winding : int
        0, 1 or 2 in the winding frame.
    sequence : PhaseSequence
        Order in which the supply's phases reach their maxima.
    connection : Connection
        Star or delta.

    Returns
    -------
    Winding
        0, 1 or 2 for the winding on terminal a, b or c.
    """
    return _TERMINAL_WINDINGS[connection, sequence][winding]


def _rotation(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
