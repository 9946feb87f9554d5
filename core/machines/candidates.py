"""Hypotheses on one motor: a batch of them, and how the load torque grows with speed."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array


class LoadLaw(IntEnum):
    """How the load torque grows with speed: its exponent."""

    CONSTANT = 0
    LINEAR = 1
    QUADRATIC = 2


@dataclass(frozen=True, slots=True)
class Candidates:
    """A batch of hypotheses on one motor.

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
    path_ratio : ndarray, shape (candidates,)
        Resistance of the path that bridges the turns over that of the turns, r_f / (mu R_s).
    """

    fault_level: Array
    winding: NDArray[np.int64]
    load_level: Array
    time_offset_s: Array
    path_ratio: Array

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
            self.path_ratio[rows],
        )
