"""The symmetrical machine (thesis 3.13-3.16)."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array, Circuits
from core.machines.parameters import MachineParameters, Motor


class HealthyMachine:
    """No fault: the fifth circuit is an idle winding of its own, decaying and coupled to nothing."""

    name = "healthy"
    lowest_level = 0.0
    knows_path = False

    def circuits(
        self, motor: Motor, fault_level: Array, winding: NDArray[np.int64], path_ratio: Array
    ) -> Circuits:
        del winding, path_ratio
        return symmetrical(motor, fault_level.size)


def symmetrical(motor: Motor, candidates: int) -> Circuits:
    """psi_s = L_ls i_s + psi_m, psi_r = L_lr i_r + psi_m, psi_m = L_m (i_s + i_r) (3.14, 3.15)."""
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
