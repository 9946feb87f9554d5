"""A batch of candidates from matrices to squared errors in one compiled call.

What a candidate costs besides stepping (inverting its inductances, finding its steady state, delaying its
voltages) is done here too, so that the price of a candidate is the price of this one function.
"""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.discretisation import invert
from core.machines.kernel import LANES, simulate
from core.machines.steady_state import ComplexArray, answer_ripple, balance


@compiled
def find_rates(inductance: Array, resistance: Array, decay: Array, current_from_flux: Array) -> None:
    """The matrices a batch is stepped with, from its circuits (n, 5, 5).

    Filled: decay = -R inv(L), current_from_flux = inv(L), both (n, 5, 5).
    """
    inverse = np.empty((5, 5))
    for c in range(inductance.shape[0]):
        invert(inductance[c], inverse)
        for i in range(5):
            for j in range(5):
                total = 0.0
                for k in range(5):
                    total -= resistance[c, i, k] * inverse[k, j]
                decay[c, i, j] = total
        current_from_flux[c] = inverse


@compiled
def find_steady_states(
    decay: Array, current_from_flux: Array, load: Array, delay_s: Array, w_s: float, phasor: ComplexArray,
    pull_out_slip: float, ripple_gain: float, flux_0: Array, speed_0: Array, mean_speed: Array,
    current: ComplexArray, balanced: NDArray[np.bool_],
) -> None:  # fmt: skip
    """Periodic steady state of every candidate (see steady_state.py).

    load (n, 3); delay_s (n,); phasor (2,): of the undelayed voltage, peak; ripple_gain: p^2 / J.
    Filled: flux_0 (5, n), speed_0, mean_speed (n,), current (2, n), balanced (n,).
    """
    drive, rotor = np.zeros(4, np.complex128), np.empty(2, np.complex128)
    flux, third = np.empty(5, np.complex128), np.empty(5, np.complex128)
    for c in range(decay.shape[0]):
        arrival = np.exp(-1j * w_s * delay_s[c])
        drive[0], drive[1] = phasor[0] * arrival, phasor[1] * arrival
        w, balanced[c] = balance(
            decay[c], current_from_flux[c], load[c], w_s, drive, pull_out_slip, flux, rotor
        )
        w, ripple = answer_ripple(
            decay[c], current_from_flux[c], load[c], w, w_s, ripple_gain, flux, rotor, third
        )
        mean_speed[c] = w
        speed_0[c] = w + ripple.real
        for i in range(5):
            flux_0[i, c] = (flux[i] + third[i]).real
        for axis in range(2):
            current[axis, c] = 0.0
            for j in range(5):
                current[axis, c] += current_from_flux[c, axis, j] * flux[j]


@compiled
def play(
    voltage: Array, first: int, last: int, step: float, substeps: int, delay_s: Array, decay: Array,
    current_from_flux: Array, load: Array, acceleration: float, turn: float, flux_0: Array, speed_0: Array,
    measured: Array, compare_from: int, error: Array, current: Array, speed: Array,
) -> None:  # fmt: skip
    """Step every candidate from its initial state through columns [first, last) of the voltage (columns, 2).

    acceleration: h p^2 / J; turn: w_s h.
    measured (samples, 2): error (n,) is filled with the squared distance from `compare_from` on; or empty.
    current (n, 2, samples), speed (n, samples): filled at the samples of the record; or empty.
    """
    columns = last - first
    recorded = columns if current.shape[2] > 0 else 0
    lane_current, lane_speed = np.empty((2, recorded, LANES)), np.empty((recorded, LANES))
    source, delays = np.zeros(LANES, np.uint64), np.empty(LANES + 1)
    loads, state = np.zeros((3, LANES)), np.zeros((5, LANES))
    pace, distance = np.zeros(LANES), np.zeros(LANES)
    for start in range(0, delay_s.size, LANES):
        lanes = min(LANES, delay_s.size - start)
        sources = 0
        for b in range(lanes):
            c = start + b
            delays[sources] = delay_s[c] / step
            source[b] = 0
            while delays[source[b]] != delays[sources]:
                source[b] += 1
            if source[b] == sources:
                sources += 1
            for i in range(5):
                state[i, b] = flux_0[i, c]
            for n in range(3):
                loads[n, b] = load[c, n]
            pace[b], distance[b] = speed_0[c], 0.0
        simulate(
            voltage, first, columns, source, delays[:sources], step, decay[start : start + lanes],
            current_from_flux[start : start + lanes], loads, acceleration, turn, state, pace, measured,
            substeps, compare_from, distance, lane_current, lane_speed, lanes,
        )  # fmt: skip
        for b in range(lanes):
            error[start + b] = distance[b]
            for k in range(0, recorded, substeps):
                current[start + b, 0, k // substeps] = lane_current[0, k, b]
                current[start + b, 1, k // substeps] = lane_current[1, k, b]
                speed[start + b, k // substeps] = lane_speed[k, b]
