"""Broken rotor bars: a cage that conducts less along one axis, which turns with the rotor.

A cage of N_b bars with n_bb neighbouring ones broken has lost the share alpha = 2 n_bb / N_b of its
conductance along their axis and nothing across it (the squares of the bars' shares of a sine-shaped current
add up to N_b / 2). With q = (cos th, sin th), th the axis's electrical angle on the stator,

    R(th) = R_r (I + g q q'),     g = alpha / (1 - alpha)
          = R_r (1 + g/2) I + R_r g/2 [[cos 2th, sin 2th], [sin 2th, -cos 2th]]

(Bachir, Tnani, Trigeassou, Champenois, IEEE Trans. Ind. Electron. 53(3), 2006: alpha = 2/3 eta with
eta = 3 n_bb / N_b.) The even part is one more rotor resistance, which every formula of the other models
takes; the part that turns needs the rotor's angle and so a stepping of its own (turning_rotor.py). It throws
the rotor's current back at -s f in the rotor, which the stator sees at (1 - 2 s) f; the ripple of torque and
speed at 2 s f adds (1 + 2 s) f.
"""

from dataclasses import dataclass

import numpy as np

from core.machines.base import Array, Circuits, RotorAsymmetry
from core.machines.candidates import Candidates
from core.machines.healthy import symmetrical
from core.machines.parameters import Motor


@dataclass(frozen=True, slots=True)
class BrokenBars:
    """A cage with broken bars; its level is n_bb / N_b, the share that is broken, all in one place.

    The steady state is that of the mean rotor resistance; the sidebands need about a slip period to settle.

    Parameters
    ----------
    axis_angle : float, default 0.0
        Electrical angle of the bars' axis on the stator's alpha axis at the window's first sample [rad].
    """

    axis_angle: float = 0.0
    name = "broken-bars"
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
            Inductances, mean resistances and the rotor's turning part.
        """
        circuits = symmetrical(motor, len(candidates))
        half = 0.5 * motor.parameters.rotor_resistance_ohm * resistance_growth(candidates.fault_level)
        for axis in (2, 3):
            circuits.resistance[:, axis, axis] += half
        angle = np.full(len(candidates), self.axis_angle)
        return Circuits(circuits.inductance, circuits.resistance, RotorAsymmetry(half, angle))


def resistance_growth(broken_share: Array) -> Array:
    """Return the growth of the rotor resistance along the broken bars' axis.

    It is g = alpha / (1 - alpha) with alpha = 2 n_bb / N_b.

    Parameters
    ----------
    broken_share : ndarray, shape (candidates,)
        Share of the bars that are broken, n_bb / N_b.

    Returns
    -------
    ndarray, shape (candidates,)
        Growth g, relative.
    """
    alpha = 2.0 * broken_share
    return np.asarray(alpha / (1.0 - alpha), dtype=np.float64)
