"""A cage whose bars displace their current, and leakage that saturates.

An outer cage of the resistance R_o and an inner one of R_i and the leakage L_i, each of them three coils,
have the leakage L_c in common. At a small slip their resistance is R_o R_i / (R_o + R_i), their leakage
L_c + L_i (R_o / (R_o + R_i))^2; at a great one R_o and L_c.

Teeth tips saturate: the leakage of the stator and L_c, which cross them, fall as an arc tangent does,

    L(i) = L (1 - k + k atan(x) / x),   x = |i_s| / i_0

with i_s the stator's current; what lies deep in the slots, L_i, stays.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import MachineParameters
from ied_sim.motor.rotor import RotorLoops, three_coils

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class DeepBars:
    """Bars that displace their current.

    Parameters
    ----------
    resistance_ratio : float
        Resistance at a great slip over that at a small one, above 1.
    leakage_share : float
        Leakage at a great slip over that at a small one, below 1.
    """

    resistance_ratio: float
    leakage_share: float

    def loops(self, parameters: MachineParameters) -> RotorLoops:
        """Return the loops of both cages; the parameters are those of a small slip."""
        R_r, L_lr = parameters.rotor_resistance_ohm, parameters.rotor_leakage_H
        R_o = self.resistance_ratio * R_r
        R_i = R_o * R_r / (R_o - R_r)
        L_c = self.leakage_share * L_lr
        # At a small slip the inner cage carries R_r / R_i of the current; its leakage counts by the square.
        L_i = (L_lr - L_c) * (R_i / R_r) ** 2
        one = three_coils(parameters)
        closed = one.resistance / R_r
        return RotorLoops(
            leakage=_of_cages(np.full((2, 2), L_c), closed),
            deep_leakage=_of_cages(np.diag([0.0, L_i]), closed),
            gap=_of_cages(np.ones((2, 2)), one.gap),
            resistance=_of_cages(np.diag([R_o, R_i]), closed),
            axes=np.hstack((one.axes, one.axes)),
        )


@dataclass(frozen=True, slots=True)
class LeakageSaturation:
    """Teeth that saturate by the current of the stator.

    Parameters
    ----------
    share : float
        Part k of the leakage that is lost at great currents.
    knee_A : float
        Current i_0, the amplitude of a winding's [A].
    """

    share: float
    knee_A: float


UNSATURATED = LeakageSaturation(0.0, 1.0)


def _of_cages(between: Matrix, of_one: Matrix) -> Matrix:
    """Return the matrix of the loops of both cages."""
    return np.asarray(np.kron(between, of_one), np.float64)
