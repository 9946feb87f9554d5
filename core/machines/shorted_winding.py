"""The thesis's fault model: an additional shorted winding on the axis of one phase (thesis 6.10-6.15)."""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import CLARKE_PHASE, Array, Circuits, winding_axis
from core.machines.healthy import symmetrical
from core.machines.model_names import Model
from core.machines.parameters import Motor

SMALLEST_LEVEL = 1e-9
"""Level below which the loop current vanishes beside i_s in double precision: the machine is healthy."""


class ShortedWinding:
    """A winding of mu times the phase turns, closed on itself, beside an intact stator (thesis 6.10-6.15).

    With j = mu i_f and psi_j = psi_f / mu (the turns ratio N_s/N_r printed in 6.14 must not be there):

        psi_m = L_m (i_s + i_r + k n j)
        psi_j = k n . psi_m + L_ls j
        0     = (R_s / mu) j + d(psi_j)/dt                                        (6.12)
    """

    name = Model.SHORTED_WINDING
    lowest_level = 0.0
    knows_path = False

    def circuits(
        self, motor: Motor, fault_level: Array, winding: NDArray[np.int64], path_ratio: Array
    ) -> Circuits:
        """Return the matrices of a batch of candidates.

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
        del path_ratio
        circuits = symmetrical(motor, fault_level.size)
        L, R = circuits.inductance, circuits.resistance
        machine = motor.parameters
        L_m = machine.magnetising_inductance_H
        faulty = np.abs(fault_level) > SMALLEST_LEVEL
        coupling = CLARKE_PHASE * L_m * winding_axis(winding[faulty])
        L[faulty, 0:2, 4] = L[faulty, 2:4, 4] = coupling
        L[faulty, 4, 0:2] = L[faulty, 4, 2:4] = coupling
        L[faulty, 4, 4] = machine.stator_leakage_H + CLARKE_PHASE**2 * L_m
        R[faulty, 4, 4] = machine.stator_resistance_ohm / fault_level[faulty]
        return circuits
