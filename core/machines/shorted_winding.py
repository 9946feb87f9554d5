"""The thesis's fault model: an additional shorted winding on the axis of one phase (thesis 6.10-6.15)."""

import numpy as np

from core.machines.base import CLARKE_PHASE, Circuits, winding_axis
from core.machines.candidates import Candidates
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

    def circuits(self, motor: Motor, candidates: Candidates) -> Circuits:
        """Return the matrices of a batch of candidates.

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
        fault_level = candidates.fault_level
        circuits = symmetrical(motor, len(candidates))
        L, R = circuits.inductance, circuits.resistance
        machine = motor.parameters
        L_m = machine.magnetising_inductance_H
        faulty = np.abs(fault_level) > SMALLEST_LEVEL
        coupling = CLARKE_PHASE * L_m * winding_axis(candidates.winding[faulty])
        L[faulty, 0:2, 4] = L[faulty, 2:4, 4] = coupling
        L[faulty, 4, 0:2] = L[faulty, 4, 2:4] = coupling
        L[faulty, 4, 4] = machine.stator_leakage_H + CLARKE_PHASE**2 * L_m
        R[faulty, 4, 4] = machine.stator_resistance_ohm / fault_level[faulty]
        return circuits
