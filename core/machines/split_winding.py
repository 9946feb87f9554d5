"""Shorted turns as part of the phase winding (Tallam, Habetler, Harley, IEEE Trans. Ind. Appl. 38, 2002)."""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import CLARKE_PHASE, Array, Circuits, winding_axis
from core.machines.healthy import symmetrical
from core.machines.model_names import Model
from core.machines.parameters import Connection, Motor

WHOLE_PHASE = 1.0
"""Highest level: all turns of the phase."""
LOWEST_LEVEL = -0.01
"""Lowest level. The loop's inductance L_ls + 2/3 mu L_m stays positive while L_m / L_ls is below 100."""


class SplitWinding:
    """A fraction mu of the phase's turns, bridged by a path of resistance r_f that carries i_f = j / mu.

        v_s     = R_s (i_s - k n j) + d(psi_s)/dt
        psi_s   = L_ls (i_s - k n j) + psi_m,       psi_m = L_m (i_s - k n j + i_r)
        r_f i_f = mu R_s (i_x - i_f) + d(psi_x2)/dt,
        psi_x2  = mu (L_ls (i_x - i_f) + k n . psi_m)

    i_x, the current of the faulted winding, is k n . i_s in star. In delta the windings also carry the
    circulating current j / 3 that the terminals never see: the phase voltages of a delta add up to zero, so
    the zero-sequence part of the shunt current has no other way to go.

    At one slip the terminals see a shunt across the phase whose impedance is r_f / mu^2 + (R_s + j X_ls) / mu
    (beside terms of order 1). The level is given as that of the dead-shorted turns with the same resistance,
    mu_eq = mu / (1 + r_f / (mu R_s)).

    The fifth row below is -psi_x2: at mu = 0 it is the idle winding of the healthy machine, and its rate
    R_s / L_ls stays finite for every mu, so nothing is stiff.
    """

    name = Model.SPLIT_WINDING
    lowest_level = LOWEST_LEVEL
    knows_path = True

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
        circuits = symmetrical(motor, fault_level.size)
        L, R = circuits.inductance, circuits.resistance
        machine = motor.parameters
        L_ls, L_m, R_s = (
            machine.stator_leakage_H,
            machine.magnetising_inductance_H,
            machine.stator_resistance_ohm,
        )
        axis = CLARKE_PHASE * winding_axis(winding)
        level = np.clip(fault_level * (1.0 + path_ratio), LOWEST_LEVEL, WHOLE_PHASE)
        mu = level[:, np.newaxis]
        L[:, 0:2, 4] = -(L_ls + L_m) * axis
        L[:, 2:4, 4] = -L_m * axis
        L[:, 4, 0:2] = -mu * (L_ls + L_m) * axis
        L[:, 4, 2:4] = -mu * L_m * axis
        R[:, 0:2, 4] = -R_s * axis
        R[:, 4, 0:2] = -mu * R_s * axis
        circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
        own_share = 1.0 - circulating * level
        L[:, 4, 4] = own_share * L_ls + CLARKE_PHASE**2 * level * L_m
        R[:, 4, 4] = (own_share + path_ratio) * R_s
        return circuits
