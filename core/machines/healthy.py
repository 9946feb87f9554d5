"""The symmetrical machine (thesis 3.13-3.16)."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array, Circuits
from core.machines.parameters import MachineParameters, Motor


class HealthyMachine:
    """The machine without a fault.

    The fifth circuit is an idle winding of its own, decaying and coupled to nothing.
    """

    name = "healthy"
    lowest_level = 0.0
    knows_path = False

    def circuits(
        self, motor: Motor, fault_level: Array, winding: NDArray[np.int64], path_ratio: Array
    ) -> Circuits:
        """Return the matrices of a batch of candidates, which are all alike.

        Parameters
        ----------
        motor : Motor
            Nameplate, parameters, channel names and limits of the motor.
        fault_level : ndarray, shape (candidates,)
            Fault level, a fraction of the phase turns; 0 is the healthy machine.
        winding : ndarray of int, shape (candidates,)
            Winding with the fault: 0, 1 or 2 for the one on terminals a, b, c.
        path_ratio : ndarray, shape (candidates,)
            Resistance of the path that bridges the turns over that of the turns, r_f / (mu R_s).

        Returns
        -------
        Circuits
            Inductances and resistances.
        """
        del winding, path_ratio
        return symmetrical(motor, fault_level.size)


def symmetrical(motor: Motor, candidates: int) -> Circuits:
    """Return the matrices of the symmetrical machine (3.14, 3.15).

    psi_s = L_ls i_s + psi_m, psi_r = L_lr i_r + psi_m, psi_m = L_m (i_s + i_r).

    Parameters
    ----------
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    candidates : int
        Size of the batch.

    Returns
    -------
    Circuits
        Inductances and resistances, alike for every candidate.
    """
    L, R = _matrices(motor.parameters)
    return Circuits(
        np.repeat(L[np.newaxis], candidates, axis=0), np.repeat(R[np.newaxis], candidates, axis=0)
    )


@lru_cache
def _matrices(machine: MachineParameters) -> tuple[Array, Array]:
    L_m = machine.magnetising_inductance_H
    L, R = np.zeros((5, 5)), np.zeros((5, 5))
    for axis in (0, 1):
        stator, rotor = axis, axis + 2
        L[stator, stator] = machine.stator_leakage_H + L_m
        L[rotor, rotor] = machine.rotor_leakage_H + L_m
        L[stator, rotor] = L[rotor, stator] = L_m
        R[stator, stator] = machine.stator_resistance_ohm
        R[rotor, rotor] = machine.rotor_resistance_ohm
    L[4, 4] = machine.stator_leakage_H
    R[4, 4] = machine.stator_resistance_ohm
    return L, R
