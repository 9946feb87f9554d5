"""Leakage of slots and of coil ends, coil by coil, from shapes: permeances for one turn a coil.

A slot is a rectangle with open sides: of a layer of height h in a slot of width b, the flux across the layer
itself links its own turns with h / 3b; across what lies above it, with that height over b. Wedge and opening
above the layers count as one permeance. Between two layers, the upper's own flux links all of the lower and
half of the upper's turns.

Reference: J. Pyrhonen, T. Jokinen, V. Hrabovcova, Design of Rotating Electrical Machines, ch. 4.3.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ied_sim.motor.slots import Coil

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SlotShape:
    """What the leakage of slots and ends is shared out by; its total is the motor's.

    Parameters
    ----------
    layer_height : float, default 1.2
        Height of one of two layers over the width of the slot.
    opening : float, default 0.6
        Permeance of wedge and opening above them.
    end_share : float, default 0.25
        Share of the coil ends in the leakage of slots and ends.
    """

    layer_height: float = 1.2
    opening: float = 0.6
    end_share: float = 0.25


USUAL_SLOTS = SlotShape()


def slot_permeances(coils: tuple[Coil, ...], slots: int, layers: int, shape: SlotShape) -> Matrix:
    """Return the permeances of the slots between coils, relative, shape (n, n).

    Parameters
    ----------
    coils : tuple of Coil
        The n coils.
    slots : int
        Number of slots.
    layers : int
        Coil sides in a slot; the first side of a coil lies above the second one of another.
    shape : SlotShape
        Shape of the slots.

    Returns
    -------
    ndarray, shape (n, n)
        Permeances for one turn a coil.
    """
    sides = np.zeros((layers, slots, len(coils)))
    for index, coil in enumerate(coils):
        sides[0, coil.go % slots, index] += coil.sign
        sides[-1, coil.back % slots, index] -= coil.sign
    h, above = shape.layer_height, shape.opening
    if layers == 1:
        single: Matrix = (2 * h / 3 + above) * sides[0].T @ sides[0]
        return single
    top, bottom = sides
    both: Matrix = (h / 3 + above) * top.T @ top + (h / 3 + h + above) * bottom.T @ bottom
    both += (h / 2 + above) * (top.T @ bottom + bottom.T @ top)
    return both


def end_permeances(coils: tuple[Coil, ...]) -> Matrix:
    """Return the permeances of the coil ends, relative, shape (n, n): each for itself, by its pitch."""
    return np.diag([float(coil.pitch_slots) for coil in coils])
