"""What a machine model is: coupled circuits, linear in flux at a given speed.

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

from core.machines.parameters import Motor

Array = NDArray[np.float64]

CLARKE_PHASE = float(np.sqrt(2.0 / 3.0))
"""k: length of one phase's unit vector in power-invariant Clarke axes (3.11)."""


class RotorAsymmetry(NamedTuple):
    """Turning part of the rotor's resistance.

    Attributes
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
    """Inductances L [H] and resistances R [ohm] of a batch, each of shape (candidates, 5, 5).

    Where a rotor is not the same all around, R has its mean and `rotor_asymmetry` what turns with it.
    """

    inductance: Array
    resistance: Array
    rotor_asymmetry: RotorAsymmetry | None = None


class StatorModel(Protocol):
    """A machine with a fault of a level, in a stator model's case in one phase; replaceable (thesis 6.5)."""

    @property
    def name(self) -> str:
        """As written on the command line: "split-winding"."""
        ...

    @property
    def lowest_level(self) -> float:
        """Least fault level the equations can be continued to: below zero an estimate is free of bias."""
        ...

    @property
    def knows_path(self) -> bool:
        """Whether the resistance of the path that bridges the turns can be told from their level."""
        ...

    def circuits(
        self, motor: Motor, fault_level: Array, winding: NDArray[np.int64], path_ratio: Array
    ) -> Circuits:
        """Matrices for a batch of candidates, every argument of shape (candidates,).

        fault_level: equivalent level mu_eq, fraction of the phase turns; 0 is the healthy machine exactly.
        winding: theta_f, 0, 1 or 2 for the winding on terminals a, b, c.
        path_ratio: resistance of the path that bridges the turns over that of the turns, r_f / (mu R_s);
        models that know no path ignore it.
        """
        ...


_ANGLES = 2.0 * np.pi / 3.0 * np.arange(3)
_AXES = np.stack([np.cos(_ANGLES), np.sin(_ANGLES)], axis=1)


def winding_axis(winding: NDArray[np.int64]) -> Array:
    """n = (cos th, sin th), th = theta_f 2 pi / 3, shape (candidates, 2) (6.9)."""
    return _AXES[winding]
