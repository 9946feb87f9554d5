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
    """A batch of hypotheses on one motor, each field of shape (candidates,).

    fault_level: mu_f; winding: theta_f, 0, 1, 2; load_level: LL; time_offset_s: T_d, delay of the currents;
    path_ratio: r_f / (mu R_s) of the path bridging the turns.
    """

    fault_level: Array
    winding: NDArray[np.int64]
    load_level: Array
    time_offset_s: Array
    path_ratio: Array

    def __len__(self) -> int:
        return self.fault_level.size

    def part(self, rows: slice) -> "Candidates":
        """The candidates of some rows."""
        return Candidates(
            self.fault_level[rows],
            self.winding[rows],
            self.load_level[rows],
            self.time_offset_s[rows],
            self.path_ratio[rows],
        )
