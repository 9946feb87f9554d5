"""A batch of candidates from matrices to squared errors in one compiled call.

What a candidate costs besides stepping (inverting its inductances, finding its steady state, delaying its
voltages) is done here too, so that the price of a candidate is the price of this one function.
"""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.kernel import LANES, simulate
from core.machines.steady_state import balance


@compiled
def invert(L: Array, inverse: Array) -> None:
    """Inverse of a 5 x 5 inductance matrix by Gauss and Jordan; its diagonal dominates, so no pivoting."""
    work = L.copy()
    inverse[:] = np.eye(5)
    for i in range(5):
        pivot = 1.0 / work[i, i]
        for j in range(5):
            work[i, j] *= pivot
            inverse[i, j] *= pivot
        for row in range(5):
            if row != i:
                factor = work[row, i]
                for j in range(5):
                    work[row, j] -= factor * work[i, j]
                    inverse[row, j] -= factor * inverse[i, j]


@compiled
def delay_voltage(voltage: Array, delay_columns: float, first: int, out: Array) -> None:
    """out[k] = voltage[first + k - delay] through four columns (Lagrange's cubic); both (columns, 2)."""
    whole = int(np.ceil(delay_columns))
    x = whole - delay_columns
    before = -x * (x - 1.0) * (x - 2.0) / 6.0
    here = (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0
    after = -(x + 1.0) * x * (x - 2.0) / 2.0
    beyond = (x + 1.0) * x * (x - 1.0) / 6.0
    start = first - whole
    for k in range(out.shape[0]):
        m = start + k
        for axis in range(2):
            out[k, axis] = (
                before * voltage[m - 1, axis]
                + here * voltage[m, axis]
                + after * voltage[m + 1, axis]
                + beyond * voltage[m + 2, axis]
            )


@compiled
def find_steady_states(
    inductance: Array, resistance: Array, load: Array, delay_s: Array, w_s: float,
    phasor: NDArray[np.complex128], pull_out_slip: float, ripple_gain: float, decay: Array,
    current_from_flux: Array, flux_0: Array, speed_0: Array, mean_speed: Array,
    current: NDArray[np.complex128], balanced: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Periodic steady state of every candidate (see steady_state.py), and the matrices it is stepped with.

    inductance, resistance (n, 5, 5); load (n, 3); delay_s (n,); phasor (2,): of the undelayed voltage, peak.
    Filled: decay = -R inv(L) (n, 5, 5), current_from_flux = first four rows of inv(L) (n, 4, 5), flux_0
    (5, n), speed_0, mean_speed (n,), current (2, n), balanced (n,). ripple_gain: p^2 / J.
    """
    inverse = np.empty((5, 5))
    flux, rotor = np.empty(5, np.complex128), np.empty(2, np.complex128)
    for c in range(inductance.shape[0]):
        invert(inductance[c], inverse)
        for i in range(5):
            for j in range(5):
                total = 0.0
                for k in range(5):
                    total -= resistance[c, i, k] * inverse[k, j]
                decay[c, i, j] = total
        current_from_flux[c] = inverse[:4]
        arrival = np.exp(-1j * w_s * delay_s[c])
        w, balanced[c] = balance(
            decay[c], current_from_flux[c], load[c], w_s, phasor[0] * arrival, phasor[1] * arrival,
            pull_out_slip, flux, rotor,
        )  # fmt: skip
        ripple = 0.5 * (flux[3] * rotor[0] - flux[2] * rotor[1])
        mean_speed[c] = w
        speed_0[c] = w + (ripple_gain * ripple / (2j * w_s)).real
        for i in range(5):
            flux_0[i, c] = flux[i].real
        for axis in range(2):
            current[axis, c] = 0.0
            for j in range(5):
                current[axis, c] += current_from_flux[c, axis, j] * flux[j]


@compiled
def play(
    voltage: Array, first: int, last: int, step: float, substeps: int, delay_s: Array, decay: Array,
    current_from_flux: Array, load: Array, acceleration: float, flux_0: Array, speed_0: Array,
    measured: Array, compare_from: int, error: Array, current: Array, speed: Array,
) -> None:  # fmt: skip
    """Step every candidate from its initial state through columns [first, last) of the voltage (columns, 2).

    measured (samples, 2): error (n,) is filled with the squared distance from `compare_from` on; or empty.
    current (n, 2, samples), speed (n, samples): filled at the samples of the record; or empty.
    """
    columns = last - first
    recorded = columns if current.shape[2] > 0 else 0
    lane_current, lane_speed = np.empty((2, recorded, LANES)), np.empty((recorded, LANES))
    delayed = np.empty((LANES, columns, 2))
    source, known = np.zeros(LANES, np.int64), np.empty(LANES)
    output, loads = np.zeros((4, 5, LANES)), np.zeros((3, LANES))
    state, pace, distance = np.zeros((5, LANES)), np.zeros(LANES), np.zeros(LANES)
    for start in range(0, delay_s.size, LANES):
        lanes = min(LANES, delay_s.size - start)
        sources = 0
        for b in range(lanes):
            c = start + b
            source[b] = -1
            for s in range(sources):
                if known[s] == delay_s[c]:
                    source[b] = s
            if source[b] < 0:
                source[b], known[sources] = sources, delay_s[c]
                delay_voltage(voltage, delay_s[c] / step, first, delayed[sources])
                sources += 1
            for i in range(5):
                state[i, b] = flux_0[i, c]
                for n in range(4):
                    output[n, i, b] = current_from_flux[c, n, i]
            for n in range(3):
                loads[n, b] = load[c, n]
            pace[b], distance[b] = speed_0[c], 0.0
        simulate(
            delayed, source, step, decay[start : start + lanes], output, loads, acceleration, state, pace,
            measured, substeps, compare_from, distance, lane_current, lane_speed, lanes,
        )  # fmt: skip
        for b in range(lanes):
            error[start + b] = distance[b]
            for k in range(0, recorded, substeps):
                current[start + b, 0, k // substeps] = lane_current[0, k, b]
                current[start + b, 1, k // substeps] = lane_current[1, k, b]
                speed[start + b, k // substeps] = lane_speed[k, b]
