"""Shorted turns as part of the phase winding, in a coil that may lie beside the phase's axis.

Tallam, Habetler, Harley, IEEE Trans. Ind. Appl. 38, 2002, with the leakage and the axis of a coil.
"""

from math import pi

import numpy as np

from core.machines.base import CLARKE_PHASE, Circuits, winding_axis
from core.machines.candidates import Candidates
from core.machines.healthy import symmetrical
from core.machines.model_names import Model
from core.machines.parameters import Connection, Motor

LOWEST_LEVEL = -0.01
"""Lowest level of turns with a leakage of 1, in proportion with another. The loop's inductance
psi L_ls + 2/3 m L_m / k_d^2 stays positive while L_m / L_ls is below 100."""
SMALLEST_LEVEL = 1e-9
"""Level below which the shorted turns' current vanishes beside i_s in double precision."""
LEAST_OWN_LEAKAGE = 1.001
"""Least leakage psi over the level m. At 1 the turns share all of their leakage with the phase; in delta
nothing would then hold back a current around the shunt."""


class SplitWinding:
    """A fraction mu of the phase's turns, in one coil, bridged by a path of resistance r_f.

    The path carries i_f = j / mu. The coil lies on the axis n_c = (cos(th + delta), sin(th + delta)) / k_d,
    delta from the axis n of its phase, and keeps the share kappa of its turns' leakage to itself; the rest is
    linked with the phase, whose slots it shares:

        v_s     = R_s (i_s - k n j) + d(psi_s)/dt
        psi_s   = L_ls (i_s - k n j) + psi_m,       psi_m = L_m (i_s - k n_c j + i_r)
        r_f i_f = mu R_s (i_x - i_f) + d(psi_x2)/dt,
        psi_x2  = mu (L_ls (i_x - lambda i_f) + k n_c . psi_m),     lambda = kappa + (1 - kappa) mu

    i_x, the current of the faulted winding, is k n . i_s in star. In delta the windings also carry the
    circulating current j / 3 that the terminals never see: the phase voltages of a delta add up to zero, so
    the zero-sequence part of the shunt current has no other way to go.

    Divided by mu, the loop reads

        (R_s / m) j + (psi L_ls / m) dj/dt = R_s i_x + d(L_ls i_x + k n_c . psi_m)/dt,
        m = mu / (1 + p),   psi = lambda / (1 + p),   p = r_f / (mu R_s)

    so that the terminals see two numbers of the three, in transients too: the equivalent level m, which is
    that of dead-shorted turns with the same resistance, and the leakage psi. Tallam's winding has kappa = 1,
    delta = 0 and k_d = 1. The thesis's shorted winding is the limit of a great linkage
    (mu = m / k_d^2, psi = mu).

    The fifth row below is -psi_x2 / (1 + p): at m = 0 it is the idle winding of the healthy machine. Its rate
    is R_s / (psi L_ls) or less, so nothing is stiff but turns with hardly a leakage of their own.
    """

    name = Model.SPLIT_WINDING
    lowest_level = LOWEST_LEVEL

    def circuits(self, motor: Motor, candidates: Candidates) -> Circuits:
        """Return the matrices of a batch of candidates.

        Parameters
        ----------
        motor : Motor
            Nameplate, parameters, channel names and limits of the motor.
        candidates : Candidates
            The batch of hypotheses. Leakages below the level, which no coil has, are raised to it.

        Returns
        -------
        Circuits
            Inductances and resistances.
        """
        circuits = symmetrical(motor, len(candidates))
        L, R = circuits.inductance, circuits.resistance
        machine = motor.parameters
        L_ls, L_m, R_s = (
            machine.stator_leakage_H,
            machine.magnetising_inductance_H,
            machine.stator_resistance_ohm,
        )
        leakage = candidates.leakage
        level = np.maximum(candidates.fault_level, LOWEST_LEVEL * leakage)
        psi = np.maximum(leakage, LEAST_OWN_LEAKAGE * level)
        psi[np.abs(level) < SMALLEST_LEVEL] = 1.0
        linkage, angle = candidates.linkage, candidates.winding * (2.0 * pi / 3.0) + candidates.axis_rad
        n = CLARKE_PHASE * winding_axis(candidates.winding)
        n_c = CLARKE_PHASE * linkage[:, np.newaxis] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        m = level[:, np.newaxis]
        fed = L_ls * n + L_m * n_c
        L[:, 0:2, 4] = -fed
        L[:, 2:4, 4] = -L_m * n_c
        L[:, 4, 0:2] = -m * fed
        L[:, 4, 2:4] = -m * L_m * n_c
        R[:, 0:2, 4] = -R_s * n
        R[:, 4, 0:2] = -m * R_s * n
        circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
        L[:, 4, 4] = (psi - circulating * level) * L_ls + (CLARKE_PHASE * linkage) ** 2 * level * L_m
        R[:, 4, 4] = (1.0 - circulating * level) * R_s
        return circuits
