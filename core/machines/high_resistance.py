"""A high-resistance connection: one winding with a resistance in series (a loose joint, a cracked lead)."""

import numpy as np

from core.machines.base import CLARKE_PHASE, Circuits, winding_axis
from core.machines.candidates import Candidates
from core.machines.healthy import symmetrical
from core.machines.parameters import Connection, Motor

ZERO_SEQUENCE = float(np.sqrt(1.0 / 3.0))
"""Length of one phase's unit vector on the zero-sequence axis of power-invariant Clarke axes."""


class HighResistanceConnection:
    """A resistance in series with one winding; the level is the resistance added, over R_s.

        dR = mu R_s,     v_s = R_s i_s + k n dR i_x + d(psi_s)/dt,        i_x = k n . i_s

    In delta the resistance is the winding's own (a joint inside the terminals). The three winding voltages
    add up to zero, their drops no longer do, so that a current i_0 runs around the delta which the lines
    never see. It is the fifth circuit, through the leakage alone:

        i_x = k n . i_s + i_0 / sqrt(3)
        0   = R_s i_0 + dR i_x / sqrt(3) + L_ls d(i_0)/dt

    A resistance in a line of a delta is not this model: it acts on two windings.
    """

    name = "high-resistance"
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
        circuits = symmetrical(motor, len(candidates))
        axis = np.zeros((len(candidates), 5))
        axis[:, 0:2] = CLARKE_PHASE * winding_axis(candidates.winding)
        if motor.nameplate.connection is Connection.DELTA:
            axis[:, 4] = ZERO_SEQUENCE
        added = candidates.fault_level * motor.parameters.stator_resistance_ohm
        drop = added[:, np.newaxis, np.newaxis] * axis[:, :, np.newaxis] * axis[:, np.newaxis, :]
        return Circuits(circuits.inductance, circuits.resistance + drop)
