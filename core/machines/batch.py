"""A batch of candidates from matrices to squared errors in one compiled call.

What a candidate costs besides stepping (inverting its inductances, finding its steady state, delaying its
voltages) is done here too, so that the price of a candidate is the price of this one function.
"""

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.discretisation import invert
from core.machines.kernel import LANES, simulate
from core.machines.steady_state import SinusoidalSupply, SteadyState, answer_ripple, balance
from core.machines.stepping import Comparison, InitialState, MachineRates, SteppedVoltage, Track


@compiled
def find_rates(inductance: Array, resistance: Array, decay: Array, current_from_flux: Array) -> None:
    """Fill the matrices that a batch is stepped with.

    Parameters
    ----------
    inductance : ndarray, shape (candidates, 5, 5)
        L [H].
    resistance : ndarray, shape (candidates, 5, 5)
        R [ohm].
    decay : ndarray, shape (candidates, 5, 5)
        Filled with -R inv(L) [1/s].
    current_from_flux : ndarray, shape (candidates, 5, 5)
        Filled with inv(L) [1/H].
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
    machines: MachineRates, delay_s: Array, supply: SinusoidalSupply, state: SteadyState
) -> None:
    """Fill the periodic steady state of every candidate (see steady_state.py).

    Parameters
    ----------
    machines : MachineRates
        Coefficients of the batch.
    delay_s : ndarray, shape (candidates,)
        Delay of each candidate's voltages [s].
    supply : SinusoidalSupply
        The supply, and where the machine pulls out on it.
    state : SteadyState
        The steady states, which are filled.
    """
    drive, rotor = np.zeros(4, np.complex128), np.empty(2, np.complex128)
    flux, third = np.empty(5, np.complex128), np.empty(5, np.complex128)
    w_s = supply.angular_frequency
    for c in range(delay_s.size):
        machine = MachineRates(
            machines.decay[c], machines.current_from_flux[c], machines.load[c], machines.gain
        )
        arrival = np.exp(-1j * w_s * delay_s[c])
        drive[0], drive[1] = supply.phasor[0] * arrival, supply.phasor[1] * arrival
        w, state.balanced[c] = balance(machine, w_s, drive, supply.pull_out_slip, flux, rotor)
        w, ripple = answer_ripple(machine, w, w_s, flux, rotor, third)
        state.mean_speed[c] = w
        state.speed[c] = w + ripple.real
        for i in range(5):
            state.flux[i, c] = (flux[i] + third[i]).real
        for axis in range(2):
            state.current[axis, c] = 0.0
            for j in range(5):
                state.current[axis, c] += machine.current_from_flux[axis, j] * flux[j]


@compiled
def play(
    feed: SteppedVoltage, delay_s: Array, machines: MachineRates, beginning: InitialState,
    comparison: Comparison, track: Track,
) -> None:  # fmt: skip
    """Step every candidate from its initial state through the feed.

    The squared error of a candidate is infinite where its currents are not finite.

    Parameters
    ----------
    feed : SteppedVoltage
        Stator voltage and the columns of it that are stepped through.
    delay_s : ndarray, shape (candidates,)
        Delay of each candidate's voltages [s].
    machines : MachineRates
        Coefficients of the batch.
    beginning : InitialState
        State of the candidates at the first column.
    comparison : Comparison
        Measured current, and the squared errors that are filled.
    track : Track
        Currents and speeds that are filled.
    """
    columns, substeps = feed.last - feed.first, feed.substeps
    recorded = columns if track.current.shape[2] > 0 else 0
    lane_track = Track(np.empty((2, recorded, LANES)), np.empty((recorded, LANES)))
    source, delays = np.zeros(LANES, np.uint64), np.empty(LANES + 1)
    loads, distance = np.zeros((3, LANES)), np.zeros(LANES)
    initial = InitialState(np.zeros((5, LANES)), np.zeros(LANES))
    lane_comparison = Comparison(comparison.measured, comparison.compare_from, distance)
    for start in range(0, delay_s.size, LANES):
        lanes = min(LANES, delay_s.size - start)
        sources = 0
        for b in range(lanes):
            c = start + b
            delays[sources] = delay_s[c] / feed.step_s
            source[b] = 0
            while source[b] < sources and delays[source[b]] != delays[sources]:
                source[b] += 1
            if source[b] == sources:
                sources += 1
            for i in range(5):
                initial.flux[i, b] = beginning.flux[i, c]
            for n in range(3):
                loads[n, b] = machines.load[c, n]
            initial.speed[b], distance[b] = beginning.speed[c], 0.0
        batch = MachineRates(
            machines.decay[start : start + lanes], machines.current_from_flux[start : start + lanes], loads,
            machines.gain,
        )  # fmt: skip
        simulate(feed, source, delays[:sources], batch, initial, lane_comparison, lane_track, lanes)
        for b in range(lanes):
            comparison.squared_error[start + b] = distance[b] if np.isfinite(distance[b]) else np.inf
            for k in range(0, recorded, substeps):
                track.current[start + b, 0, k // substeps] = lane_track.current[0, k, b]
                track.current[start + b, 1, k // substeps] = lane_track.current[1, k, b]
                track.speed[start + b, k // substeps] = lane_track.speed[k, b]
