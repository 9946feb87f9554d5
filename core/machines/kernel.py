"""Stepping a batch of candidates through the same record: the only loop that runs per sample.

Candidates lie side by side in the last axis, so that one vector instruction advances several of them.
Within a step the speed is constant. The electrical part is exact for a straight-line voltage at a reference
speed; what the speed differs from it enters as a voltage of the rotor, (w - w_reference) Jr psi_r, its mean
over the step extrapolated from two steps, so that a stiff loop sees it steadily. The speed is advanced at
half steps (leapfrog). All of it is of second order; the reference follows the machine from block to block.

The stepped state is x = (i_s, psi_r, j): what is compared and what makes the torque lie in it as they are.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.delay import delay_voltage
from core.machines.discretisation import Hold, discretise, invert, multiply
from core.machines.stepping import Comparison, InitialState, MachineRates, SteppedVoltage, Track

LANES = 16
SHORTEST_BLOCK, LONGEST_BLOCK = 16, 256
"""Steps between two checks of the speed; doubled while it changes slowly, halved while it changes fast."""
REFERENCE_DRIFT = 10.0
"""Largest |w - w_reference| before a candidate is discretised anew [rad/s]; the error grows with it."""
NO_REFERENCE = -1e300
"""Reference speed of a candidate that was never discretised; it is finite and far from every speed."""


class LaneVoltage(NamedTuple):
    """Delayed voltages of one block, and which of them each lane sees.

    Parameters
    ----------
    voltage : ndarray, shape (sources, columns, 2)
        Clarke voltages from the block's first column on [V].
    source : ndarray of uint64, shape (LANES,)
        Index of the voltage that drives each lane.
    first, last : int
        Columns of the record at which the block begins and ends.
    """

    voltage: Array
    source: NDArray[np.uint64]
    first: int
    last: int


class LaneMachines(NamedTuple):
    """Candidates side by side, in the coordinates x = (i_s, psi_r, j).

    Parameters
    ----------
    hold : Hold
        Matrices of a step at the reference speeds, each with a last axis of LANES.
    torque : ndarray, shape (3, LANES)
        Coefficients of i_r = t0 i_s + (t1, t2) j + a share of psi_r, which makes no torque.
    load : ndarray, shape (3, LANES)
        T_load / p = l0 + l1 w + l2 w^2.
    reference_speed : ndarray, shape (LANES,)
        Electrical speed for which `hold` is exact [rad/s].
    acceleration : float
        Step times p^2 / J.
    turn : float
        Angle that the supply turns in a step [rad].
    """

    hold: Hold
    torque: Array
    load: Array
    reference_speed: Array
    acceleration: float
    turn: float


class LaneState(NamedTuple):
    """State of the candidates side by side, which a block advances.

    Parameters
    ----------
    x : ndarray, shape (8, LANES)
        State i_s, psi_r, j, then the rotor's flux of one step before and the last gain in speed.
    speed : ndarray, shape (LANES,)
        Electrical speed, half a step ahead of x [rad/s].
    """

    x: Array
    speed: Array


@compiled
def mean_over_next_step(turn: float) -> tuple[float, float]:
    """Return the weights of a vector's values now and one step before in its mean over the next step.

    They are exact for vectors that turn by `turn` a step, either way.

    Parameters
    ----------
    turn : float
        Angle that the supply turns in a step [rad].

    Returns
    -------
    tuple of float
        Weight of the value now, weight of the one before.
    """
    mean = np.sin(0.5 * turn) / (0.5 * turn * np.sin(turn))
    return mean * np.sin(1.5 * turn), -mean * np.sin(0.5 * turn)


@compiled
def advance(
    feed: LaneVoltage, machines: LaneMachines, state: LaneState, comparison: Comparison, substeps: int,
    track: Track, lanes: int,
) -> None:  # fmt: skip
    """Advance some candidates through the block of a feed.

    The comparison, where its measured current is not empty, adds up the squared errors (LANES,). The track,
    where it is not empty, is filled for first < k <= last.

    Parameters
    ----------
    feed : LaneVoltage
        Delayed voltages of the block.
    machines : LaneMachines
        The candidates side by side.
    state : LaneState
        Their state, in and out.
    comparison : Comparison
        Measured current, and the squared errors that are filled.
    substeps : int
        Columns in one sample of the record.
    track : Track
        Currents and speeds that are filled.
    lanes : int
        Number of lanes in use.
    """
    # The compiler uses vector instructions because it knows the strides of arrays that are made here.
    E, G0, G1 = np.empty((5, 5, LANES)), np.empty((5, 2, LANES)), np.empty((5, 2, LANES))
    H, torque, load = np.empty((5, 2, LANES)), np.empty((3, LANES)), np.empty((3, LANES))
    E[:], G0[:], G1[:], H[:] = machines.hold.E, machines.hold.G0, machines.hold.G1, machines.hold.H
    torque[:], load[:], acceleration = machines.torque, machines.load, machines.acceleration
    x = np.empty((8, LANES))
    u, u_next, w, w_reference = np.empty((2, LANES)), np.empty((2, LANES)), np.empty(LANES), np.empty(LANES)
    x[:], w[:], w_reference[:] = state.x, state.speed, machines.reference_speed
    voltage, source, first, last = feed
    measured, current, speed_out = comparison.measured, track.current, track.speed
    distance = np.empty(LANES)
    distance[:] = comparison.squared_error
    now, before = mean_over_next_step(machines.turn)
    recorded = current.shape[1] > 0
    compared = measured.shape[0] > 0
    for b in range(lanes):
        u[0, b] = voltage[source[b], 0, 0]
        u[1, b] = voltage[source[b], 0, 1]
    # The indices n and source cannot be negative, so the compiler need not check for wrapping around.
    for n in range(last - first):
        k = first + 1 + n
        for b in range(lanes):
            u_next[0, b] = voltage[source[b], n + 1, 0]
            u_next[1, b] = voltage[source[b], n + 1, 1]
        # One expression tree for each candidate and step keeps the values in registers.
        for b in range(lanes):
            x0, x1, x2, x3, x4 = x[0, b], x[1, b], x[2, b], x[3, b], x[4, b]
            u0, u1, y0, y1 = u[0, b], u[1, b], u_next[0, b], u_next[1, b]
            ahead = w[b] - w_reference[b]
            e0 = -ahead * (now * x3 + before * x[6, b])
            e1 = ahead * (now * x2 + before * x[5, b])
            z0 = E[0, 0, b] * x0 + E[0, 1, b] * x1 + E[0, 2, b] * x2 + E[0, 3, b] * x3 + E[0, 4, b] * x4
            z0 += G0[0, 0, b] * u0 + G0[0, 1, b] * u1 + G1[0, 0, b] * y0 + G1[0, 1, b] * y1
            z0 += H[0, 0, b] * e0 + H[0, 1, b] * e1
            z1 = E[1, 0, b] * x0 + E[1, 1, b] * x1 + E[1, 2, b] * x2 + E[1, 3, b] * x3 + E[1, 4, b] * x4
            z1 += G0[1, 0, b] * u0 + G0[1, 1, b] * u1 + G1[1, 0, b] * y0 + G1[1, 1, b] * y1
            z1 += H[1, 0, b] * e0 + H[1, 1, b] * e1
            z2 = E[2, 0, b] * x0 + E[2, 1, b] * x1 + E[2, 2, b] * x2 + E[2, 3, b] * x3 + E[2, 4, b] * x4
            z2 += G0[2, 0, b] * u0 + G0[2, 1, b] * u1 + G1[2, 0, b] * y0 + G1[2, 1, b] * y1
            z2 += H[2, 0, b] * e0 + H[2, 1, b] * e1
            z3 = E[3, 0, b] * x0 + E[3, 1, b] * x1 + E[3, 2, b] * x2 + E[3, 3, b] * x3 + E[3, 4, b] * x4
            z3 += G0[3, 0, b] * u0 + G0[3, 1, b] * u1 + G1[3, 0, b] * y0 + G1[3, 1, b] * y1
            z3 += H[3, 0, b] * e0 + H[3, 1, b] * e1
            z4 = E[4, 0, b] * x0 + E[4, 1, b] * x1 + E[4, 2, b] * x2 + E[4, 3, b] * x3 + E[4, 4, b] * x4
            z4 += G0[4, 0, b] * u0 + G0[4, 1, b] * u1 + G1[4, 0, b] * y0 + G1[4, 1, b] * y1
            z4 += H[4, 0, b] * e0 + H[4, 1, b] * e1
            i_r_alpha = torque[0, b] * z0 + torque[1, b] * z4
            i_r_beta = torque[0, b] * z1 + torque[2, b] * z4
            # T_e / p = psi_r_beta i_r_alpha - psi_r_alpha i_r_beta: torque on the rotor, whatever the stator
            pace = w[b] + 0.5 * x[7, b]
            demand = load[0, b] + pace * (load[1, b] + pace * load[2, b])
            kick = acceleration * (z3 * i_r_alpha - z2 * i_r_beta - demand)
            w[b] += kick
            x[0, b], x[1, b], x[2, b], x[3, b], x[4, b] = z0, z1, z2, z3, z4
            x[5, b], x[6, b], x[7, b] = x2, x3, kick
            u[0, b], u[1, b] = y0, y1
        if recorded:
            for b in range(lanes):
                current[0, k, b] = x[0, b]
                current[1, k, b] = x[1, b]
                speed_out[k, b] = w[b] - 0.5 * x[7, b]
        if compared and k % substeps == 0:
            i_alpha, i_beta = measured[k // substeps, 0], measured[k // substeps, 1]
            for b in range(lanes):
                distance[b] += (x[0, b] - i_alpha) ** 2 + (x[1, b] - i_beta) ** 2
    state.x[:], state.speed[:], comparison.squared_error[:] = x, w, distance


@compiled
def change_state(current_from_flux: Array, to_state: Array, to_flux: Array, torque: Array) -> None:
    """Fill the changes between the flux of all circuits and x = (i_s, psi_r, j).

    The rotor's own inductance is the same in both axes.

    Parameters
    ----------
    current_from_flux : ndarray, shape (5, 5)
        Inverse of the inductances, inv(L) [1/H].
    to_state, to_flux : ndarray, shape (5, 5)
        Filled.
    torque : ndarray, shape (3,)
        Filled with the coefficients of i_r that make torque.
    """
    to_state[:] = current_from_flux
    to_state[2:4] = np.eye(5)[2:4]
    invert(to_state, to_flux)
    for n, (row, column) in enumerate(((2, 0), (2, 4), (3, 4))):
        torque[n] = 0.0
        for k in range(5):
            torque[n] += current_from_flux[row, k] * to_flux[k, column]


@compiled
def discretise_state(
    decay: Array, w: float, step: float, to_state: Array, to_flux: Array, hold: Hold
) -> None:
    """Fill the hold of the state x at speed w: that of the flux between the two changes of state.

    Parameters
    ----------
    decay : ndarray, shape (5, 5)
        Matrix of the flux's decay, -R inv(L) [1/s].
    w : float
        Electrical speed [rad/s].
    step : float
        Step [s].
    to_state, to_flux : ndarray, shape (5, 5)
        Changes between flux and state.
    hold : Hold
        Matrices of a step, which are filled.
    """
    product = np.empty((5, 5))
    of_flux = Hold(np.empty((5, 5)), np.empty((5, 2)), np.empty((5, 2)), np.empty((5, 2)))
    discretise(decay, w, step, of_flux)
    multiply(of_flux.E, to_flux, product)
    multiply(to_state, product, hold.E)
    multiply(to_state, of_flux.G0, hold.G0)
    multiply(to_state, of_flux.G1, hold.G1)
    multiply(to_state, of_flux.H, hold.H)


@compiled
def next_block(block: int, change: float) -> int:
    """Return the number of steps of the next block.

    Parameters
    ----------
    block : int
        Steps of the last block.
    change : float
        Change of the speed in it [rad/s].

    Returns
    -------
    int
        Steps.
    """
    if change > 0.5 * REFERENCE_DRIFT:
        return max(SHORTEST_BLOCK, block // 2)
    return min(LONGEST_BLOCK, 2 * block) if change < 0.2 * REFERENCE_DRIFT else block


@compiled
def greatest_change(now: Array, before: Array, lanes: int) -> float:
    """Return the greatest change of the speeds; speeds that are not numbers do not count.

    Parameters
    ----------
    now, before : ndarray, shape (LANES,)
        Speeds [rad/s].
    lanes : int
        Number of lanes in use.

    Returns
    -------
    float
        Change [rad/s].
    """
    greatest = 0.0
    for b in range(lanes):
        change = abs(now[b] - before[b])
        if change > greatest:
            greatest = change
    return greatest


@compiled
def simulate(
    feed: SteppedVoltage, source: NDArray[np.uint64], delays: Array, machines: MachineRates,
    beginning: InitialState, comparison: Comparison, track: Track, lanes: int,
) -> None:  # fmt: skip
    """Simulate up to LANES candidates over the columns of the feed.

    The machines' load is (3, LANES), the flux (5, LANES), the speed (LANES,); the speed is that at the last
    column afterwards.

    Parameters
    ----------
    feed : SteppedVoltage
        Stator voltage and the columns of it that are stepped through.
    source : ndarray of uint64, shape (LANES,)
        Index among `delays` of what a candidate sees.
    delays : ndarray, shape (sources,)
        Delays [columns].
    machines : MachineRates
        Coefficients of the batch.
    beginning : InitialState
        State of the candidates at the first column.
    comparison : Comparison
        Measured current, and the squared errors that are filled.
    track : Track
        Currents and speeds that are filled.
    lanes : int
        Number of lanes in use.
    """
    current, speed_out, load, speed = track.current, track.speed, machines.load, beginning.speed
    acceleration = machines.gain * feed.step_s
    hold = Hold(
        np.zeros((5, 5, LANES)), np.zeros((5, 2, LANES)), np.zeros((5, 2, LANES)), np.zeros((5, 2, LANES))
    )
    torque, x = np.zeros((3, LANES)), np.zeros((8, LANES))
    to_state, to_flux = np.empty((lanes, 5, 5)), np.empty((lanes, 5, 5))
    delayed = np.empty((delays.size, LONGEST_BLOCK + 1, 2))
    reference, before = np.full(LANES, NO_REFERENCE), np.zeros(LANES)
    for b in range(lanes):
        change_state(machines.current_from_flux[b], to_state[b], to_flux[b], torque[:, b])
        for n in range(5):
            for m in range(5):
                x[n, b] += to_state[b, n, m] * beginning.flux[m, b]
        if current.shape[1] > 0:
            current[0, 0, b], current[1, 0, b], speed_out[0, b] = x[0, b], x[1, b], speed[b]
        i_r_alpha = torque[0, b] * x[0, b] + torque[1, b] * x[4, b]
        i_r_beta = torque[0, b] * x[1, b] + torque[2, b] * x[4, b]
        demand = load[0, b] + speed[b] * (load[1, b] + speed[b] * load[2, b])
        x[5, b], x[6, b] = x[2, b], x[3, b]
        x[7, b] = acceleration * (x[3, b] * i_r_alpha - x[2, b] * i_r_beta - demand)
        speed[b] += 0.5 * x[7, b]
    side_by_side = LaneMachines(
        hold, torque, load, reference, acceleration, feed.angular_frequency * feed.step_s
    )
    state, error = LaneState(x, speed), comparison.squared_error
    nothing = Comparison(np.empty((0, 2)), comparison.compare_from, error)
    columns, compare_from = feed.last - feed.first, comparison.compare_from
    first, block = 0, SHORTEST_BLOCK
    while first < columns - 1:
        last = min(first + block, columns - 1)
        if first < compare_from - 1:
            last = min(last, compare_from - 1)
        for b in range(lanes):
            if not abs(speed[b] - reference[b]) <= REFERENCE_DRIFT:
                reference[b] = speed[b]
                discretise_state(
                    machines.decay[b], reference[b], feed.step_s, to_state[b], to_flux[b],
                    Hold(hold.E[:, :, b], hold.G0[:, :, b], hold.G1[:, :, b], hold.H[:, :, b]),
                )  # fmt: skip
        for s in range(delays.size):
            delay_voltage(feed.voltage, delays[s], feed.first + first, delayed[s, : last - first + 1])
        before[:] = speed
        advance(
            LaneVoltage(delayed, source, first, last), side_by_side, state,
            comparison if last >= compare_from else nothing, feed.substeps, track, lanes,
        )  # fmt: skip
        block = next_block(block, greatest_change(speed, before, lanes))
        first = last
