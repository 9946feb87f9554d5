"""Interface of the machine models: coupled circuits, linear in flux at a given speed.

Every model of the stator is five coupled circuits z = (i_s_alpha, i_s_beta, i_r_alpha, i_r_beta, j)

    psi = L z
    d(psi)/dt = B v_s - R z + w Jr psi          Jr turns the rotor flux, B feeds the stator equations

so that a model is two small matrices that can be read against the page, and everything else (steady state,
stepping, cost) is written once. `j` is the model's fifth current, scaled to the phase winding (j = mu i_f).
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from core.machines.candidates import Candidates
from core.machines.parameters import Motor

Array = NDArray[np.float64]

CLARKE_PHASE = float(np.sqrt(2.0 / 3.0))
"""k: length of one phase's unit vector in power-invariant Clarke axes (3.11)."""


class RotorAsymmetry(NamedTuple):
    """Turning part of the rotor's resistance.

    Parameters
    ----------
    resistance : ndarray, shape (candidates,)
        Half the difference between the resistances of the two axes [ohm].
    angle : ndarray, shape (candidates,)
        Electrical angle of the axis of more resistance at the window's first sample [rad].
    """

    resistance: Array
    angle: Array


@dataclass(frozen=True, slots=True)
class Circuits:
    """Inductances and resistances of a batch.

    Where a rotor is not the same all around, `resistance` has its mean and `rotor_asymmetry` the part that
    turns with it.

    Parameters
    ----------
    inductance : ndarray, shape (candidates, 5, 5)
        L [H].
    resistance : ndarray, shape (candidates, 5, 5)
        R [ohm].
    rotor_asymmetry : RotorAsymmetry or None, optional
        Part of the rotor's resistance that turns with it.
    """

    inductance: Array
    resistance: Array
    rotor_asymmetry: RotorAsymmetry | None = None


class StatorModel(Protocol):
    """A machine with a fault of some level, in a stator model's case in one phase.

    Models can be exchanged for one another (thesis 6.5).
    """

    @property
    def name(self) -> str:
        """Name as written on the command line, such as "split-winding"."""
        ...

    @property
    def lowest_level(self) -> float:
        """Least fault level to which the equations hold; below zero an estimate is free of bias."""
        ...

    def circuits(self, motor: Motor, candidates: Candidates) -> Circuits:
        """Return the matrices of a batch of candidates.

        Parameters
        ----------
        motor : Motor
            Nameplate, parameters, channel names and limits of the motor.
        candidates : Candidates
            The batch of hypotheses. A model ignores what its fault has not, such as an axis.

        Returns
        -------
        Circuits
            Inductances and resistances.
        """
        ...


_ANGLES = 2.0 * np.pi / 3.0 * np.arange(3)
_AXES = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], axis=1)


def winding_axis(winding: NDArray[np.int64]) -> Array:
    """Return the axis of each winding, n = (cos th, sin th) with th = theta_f 2 pi / 3 (6.9).

    Parameters
    ----------
    winding : ndarray of int, shape (candidates,)
        Winding with the fault: 0, 1 or 2 for the one on terminals a, b, c.

    Returns
    -------
    ndarray, shape (candidates, 2)
        Unit vectors.
    """
    return _AXES[winding]
