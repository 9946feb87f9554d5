"""Shorted turns as they lie in the motor: from the frame of the windings to the terminals."""

from math import degrees
from typing import Final

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence

SURE_AXIS: Final = 0.9
"""Probability from which on an axis is told."""


def phases_of(
    windings: tuple[float, float, float], motor: Motor, sequence: PhaseSequence
) -> tuple[float, float, float] | None:
    """Return the probability of each phase at the terminals.

    Parameters
    ----------
    windings : tuple of float
        Probability of each winding of the positive-sequence frame.
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.

    Returns
    -------
    tuple of float or None
        Those of a, b and c; None of a motor with slip rings, whose rotor does not damp the harmonics of a
        coil: there the figures of a cage say nothing of a phase.
    """
    if motor.wound_rotor is not None:
        return None
    found = [0.0, 0.0, 0.0]
    for winding, probability in enumerate(windings):
        found[terminal_winding(winding, sequence, motor.nameplate.connection)] += probability
    a, b, c = found
    return a, b, c


def axis_of(axes_rad: Array, shares: Array, motor: Motor, sequence: PhaseSequence) -> float | None:
    """Return the axis of the coils with the shorted turns.

    Parameters
    ----------
    axes_rad, shares : ndarray
        Angles in the frame of the windings [rad] and their probabilities.
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.

    Returns
    -------
    float or None
        Electrical degrees from the phase's axis, positive in the direction in which the field of an a-b-c
        supply turns; None where the winding is not known, has one axis, or the axis is not sure.
    """
    if motor.winding is None or motor.wound_rotor is not None:
        return None
    coils = np.array([one.angle_rad for one in motor.winding.coil_axes(motor.nameplate.pole_pairs)])
    if coils.size < 2:
        return None
    angles = -axes_rad if sequence is PhaseSequence.ACB else axes_rad
    nearest = np.argmin(np.abs(angles[:, np.newaxis] - coils), axis=1)
    found = np.bincount(nearest, shares, coils.size)
    best = int(np.argmax(found))
    return degrees(coils[best]) if found[best] >= SURE_AXIS else None
