"""The rotor's loops in coordinates that turn with it, and the healthy rotor: three coils.

The stator's winding links the air-gap field of its own number of poles alone. So a rotor of any shape is
known by how its loops stand on two axes of that field, and by its own leakage, air-gap inductance and
resistance, all of which are constant.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import MachineParameters

Matrix = NDArray[np.float64]

PHASE_AXES = np.array([0.0, 2 * np.pi / 3, 4 * np.pi / 3])
FLOATING_POINT = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]])
"""Loop currents of three coils whose common point floats: the third returns the sum of the other two."""


@dataclass(frozen=True, slots=True)
class RotorLoops:
    """Matrices of a rotor's m loops, referred to the turns of a stator phase.

    Parameters
    ----------
    leakage, gap : ndarray, shape (m, m)
        Inductance of the leakage and of the air-gap field [H].
    resistance : ndarray, shape (m, m)
        Resistance [ohm], at the temperature of the parameters.
    axes : ndarray, shape (2, m)
        Share of each loop's field on the rotor's two axes; (1, 0) is a coil of a phase's turns on the first.
    outside : ndarray, shape (m, m), optional
        Resistance at the ends of a wound rotor, which does not warm up with it [ohm].
    deep_leakage : ndarray, shape (m, m), optional
        Inductance of leakage that does not cross the teeth's tips, beside `leakage` [H].
    """

    leakage: Matrix
    gap: Matrix
    resistance: Matrix
    axes: Matrix
    outside: Matrix | None = None
    deep_leakage: Matrix | None = None


def three_coils(parameters: MachineParameters) -> RotorLoops:
    """Return the loops of a healthy rotor: three coils like the stator's, closed in a star."""
    on_axes = np.vstack((np.cos(PHASE_AXES), np.sin(PHASE_AXES)))
    between = np.subtract.outer(PHASE_AXES, PHASE_AXES)
    closed = FLOATING_POINT.T @ FLOATING_POINT
    return RotorLoops(
        leakage=parameters.rotor_leakage_H * closed,
        gap=parameters.stator_self_inductance_H * FLOATING_POINT.T @ np.cos(between) @ FLOATING_POINT,
        resistance=parameters.rotor_resistance_ohm * closed,
        axes=on_axes @ FLOATING_POINT,
    )
