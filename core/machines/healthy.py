"""The symmetrical machine (thesis 3.13-3.16)."""

from functools import lru_cache

import numpy as np

from core.machines.base import Array, Circuits
from core.machines.candidates import Candidates
from core.machines.parameters import MachineParameters, Motor


class HealthyMachine:
    """The machine without a fault.

    The fifth circuit is an idle winding of its own, decaying and coupled to nothing.
    """

    name = "healthy"
    lowest_level = 0.0

    def circuits(self, motor: Motor, candidates: Candidates) -> Circuits:
        """Return the matrices of a batch of candidates, which are all alike.

        Parameters
        ----------
        motor : Motor
            Nameplate, parameters, channel names and limits of the motor.
        candidates : Candidates
            The batch of hypotheses.

        Returns
        -------
        Circuits
            Inductances and resistances.
        """
        return symmetrical(motor, len(candidates))


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
