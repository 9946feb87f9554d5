"""Hypotheses on one motor: a batch of them, and how the load torque grows with speed."""

from dataclasses import dataclass, field
from enum import IntEnum
from functools import partial

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class LoadLaw(IntEnum):
    """How the load torque grows with speed: its exponent."""

    CONSTANT = 0
    LINEAR = 1
    QUADRATIC = 2


@dataclass(frozen=True, slots=True)
class Candidates:
    """A batch of hypotheses on one motor.

    The last three place the shorted turns (see split_winding.py). A single value of them holds for all
    candidates; without one the turns lie on their phase's axis and have their leakage to themselves.

    Parameters
    ----------
    fault_level : ndarray, shape (candidates,)
        Fault level, a fraction of the phase turns; 0 is the healthy machine.
    winding : ndarray of int, shape (candidates,)
        Winding with the fault: 0, 1 or 2 for the one on terminals a, b, c.
    load_level : ndarray, shape (candidates,)
        Load torque over rated torque.
    time_offset_s : ndarray, shape (candidates,)
        Delay of the currents against the voltages, T_d [s].
    leakage : ndarray, shape (candidates,) or (1,), default 1
        Leakage psi of the shorted turns, 1 / (1 + r_f / (mu R_s)) where they have it to themselves.
    axis_rad : ndarray, shape (candidates,) or (1,), default 0
        Angle delta from the phase's axis to that of the coil, positive as the field turns [rad].
    linkage : ndarray, shape (candidates,) or (1,), default 1
        Field that a turn of the coil links, over that of the phase's mean turn, 1 / k_d.
    """

    fault_level: Array
    winding: NDArray[np.int64]
    load_level: Array
    time_offset_s: Array
    leakage: Array = field(default_factory=partial(np.ones, 1), kw_only=True)
    axis_rad: Array = field(default_factory=partial(np.zeros, 1), kw_only=True)
    linkage: Array = field(default_factory=partial(np.ones, 1), kw_only=True)

    def __post_init__(self) -> None:
        shape = self.fault_level.shape
        for name in ("leakage", "axis_rad", "linkage"):
            value = getattr(self, name)
            if value.shape != shape:
                object.__setattr__(self, name, np.full(shape, value))

    def __len__(self) -> int:
        return self.fault_level.size

    def part(self, rows: slice) -> "Candidates":
        """Return some of the candidates.

        Parameters
        ----------
        rows : slice
            Which of them.

        Returns
        -------
        Candidates
            The candidates of these rows.
        """
        return Candidates(
            self.fault_level[rows],
            self.winding[rows],
            self.load_level[rows],
            self.time_offset_s[rows],
            leakage=self.leakage[rows],
            axis_rad=self.axis_rad[rows],
            linkage=self.linkage[rows],
        )
