"""Interpolation of voltages that are delayed by a sensor."""

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled


@compiled
def delay_voltage(voltage: Array, delay_columns: float, first: int, out: Array) -> None:
    """Fill `out` with the voltage as it was a delay ago, through four columns (Lagrange's cubic).

    out[k] = voltage[first + k - delay_columns].

    Parameters
    ----------
    voltage : ndarray, shape (columns, 2)
        Clarke voltages [V].
    delay_columns : float
        Delay [columns].
    first : int
        First column wanted.
    out : ndarray, shape (wanted, 2)
        Filled with the delayed voltages [V].
    """
    whole = int(np.ceil(delay_columns))
    x = whole - delay_columns
    before = -x * (x - 1.0) * (x - 2.0) / 6.0
    here = (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0
    after = -(x + 1.0) * x * (x - 2.0) / 2.0
    beyond = (x + 1.0) * x * (x - 1.0) / 6.0
    # Both axes lie side by side, two apart from column to column: one plain loop over memory. Slices, because
    # an index that might be negative keeps the compiler from vector instructions.
    delayed, start = out.reshape(-1), 2 * (first - whole)
    n = delayed.size
    v = voltage.reshape(-1)[start - 2 : start + n + 4]
    v_before, v_here, v_after, v_beyond = v[:n], v[2 : n + 2], v[4 : n + 4], v[6 : n + 6]
    for k in range(n):
        delayed[k] = before * v_before[k] + here * v_here[k] + after * v_after[k] + beyond * v_beyond[k]
