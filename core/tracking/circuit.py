"""The circuit that a motor's terminals tell: stator resistance, total leakage, magnetising inductance, rotor.

The T circuit has one inductance more than terminals can tell: another split of the leakage, with the rotor
referred otherwise, draws the same current at every load [1]_. Its inverse-Gamma form has none too many:

    Z1 = R_s + j X_sigma + j X_M R_R/s / (R_R/s + j X_M),     L_M = L_m^2 / L_r,  R_R = (L_m / L_r)^2 R_r,
                                                              L_sigma = L_s - L_M

Over all loads Z1 lies on a circle about R_s + j (X_sigma + X_M / 2) of radius X_M / 2. The slip says only
where on it, and comes with R_R alone. So records of the positive sequence tell R_s, L_sigma and L_M, and
nothing of R_r.

References
----------
.. [1] Slemon, "Modelling of induction machines for electric drives", IEEE Trans. Ind. Appl. 25 (1989)
   1126-1131.
"""

from dataclasses import dataclass
from math import hypot

import numpy as np

from core.machines.base import Array
from core.machines.parameters import MachineParameters

RUNNING_SLIP = 0.02
"""Slip of a motor that runs; the negative sequence hardly depends on it."""


@dataclass(frozen=True, slots=True)
class TerminalCircuit:
    """Inverse-Gamma circuit of one winding.

    Parameters
    ----------
    R_s, R_R : float
        Resistances of stator and rotor [ohm].
    L_sigma, L_M : float
        Total leakage and magnetising inductance [H].
    """

    R_s: float
    R_R: float
    L_sigma: float
    L_M: float

    def negative_impedance(self, w: float) -> complex:
        """Return the impedance to the negative sequence of a motor that runs.

        Parameters
        ----------
        w : float
            Angular frequency of the supply [rad/s].

        Returns
        -------
        complex
            Z2 [ohm].
        """
        rotor, magnetising = self.R_R / (2.0 - RUNNING_SLIP), 1j * w * self.L_M
        return complex(self.R_s, w * self.L_sigma) + magnetising * rotor / (magnetising + rotor)

    def impedance(self, w: float, r: float) -> complex:
        """Return the impedance to the positive sequence.

        Parameters
        ----------
        w : float
            Angular frequency of the supply [rad/s].
        r : float
            R_R over the slip [ohm].

        Returns
        -------
        complex
            Z1 [ohm].
        """
        magnetising = 1j * w * self.L_M
        return complex(self.R_s, w * self.L_sigma) + magnetising * r / (magnetising + r)


def terminal_circuit(machine: MachineParameters) -> TerminalCircuit:
    """Return the inverse-Gamma circuit of a motor.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the T circuit.

    Returns
    -------
    TerminalCircuit
        The circuit that shows the same impedance at every load and frequency.
    """
    L_m = machine.magnetising_inductance_H
    L_r = L_m + machine.rotor_leakage_H
    return TerminalCircuit(
        R_s=machine.stator_resistance_ohm,
        R_R=(L_m / L_r) ** 2 * machine.rotor_resistance_ohm,
        L_sigma=machine.stator_leakage_H + L_m - L_m**2 / L_r,
        L_M=L_m**2 / L_r,
    )


def distance_from_circle(Z: complex, R_s: float, X_sigma: float, X_M: float) -> tuple[float, Array]:
    """Return how far an impedance lies outside the circle of a motor, and how that follows its figures.

    Parameters
    ----------
    Z : complex
        Impedance to the positive sequence [ohm].
    R_s, X_sigma, X_M : float
        Figures of the circle [ohm].

    Returns
    -------
    float
        Distance [ohm].
    ndarray, shape (3,)
        Its slopes over R_s, X_sigma and X_M.
    """
    x, y = Z.real - R_s, Z.imag - X_sigma - 0.5 * X_M
    length = hypot(x, y)
    along, up = x / length, y / length
    return length - 0.5 * X_M, np.array([-along, -up, -0.5 * (1.0 + up)])
