"""Stepping a batch of candidates through the same record: the only loop that runs per sample.

Candidates lie side by side in the last axis, so that one vector instruction advances several of them.
Within a step the speed is constant. The electrical part is exact for a straight-line voltage at a reference
speed; what the speed differs from it enters as a voltage of the rotor, (w - w_reference) Jr psi_r, its mean
over the step extrapolated from two steps, so that a stiff loop sees it steadily. The speed is advanced at
half steps (leapfrog). All of it is of second order; the reference follows the machine from block to block.

The stepped state is x = (i_s, psi_r, j): what is compared and what makes the torque lie in it as they are.
"""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.delay import delay_voltage
from core.machines.discretisation import discretise, invert, multiply

LANES = 16
SHORTEST_BLOCK, LONGEST_BLOCK = 16, 256
"""Steps between two looks at the speed: twice as many or half as many as it changes slowly or fast."""
REFERENCE_DRIFT = 10.0
"""Largest |w - w_reference| before a candidate is discretised anew [rad/s]: the error follows it."""


@compiled
def mean_over_next_step(turn: float) -> tuple[float, float]:
    """Weights of a vector's values now and one step before that give its mean over the next step, exact for
    vectors that turn by +-`turn` a step [rad]."""
    mean = np.sin(0.5 * turn) / (0.5 * turn * np.sin(turn))
    return mean * np.sin(1.5 * turn), -mean * np.sin(0.5 * turn)


@compiled
def advance(
    voltage: Array,
    source: NDArray[np.uint64],
    first: int,
    last: int,
    E_in: Array,
    G0_in: Array,
    G1_in: Array,
    H_in: Array,
    torque_in: Array,
    load_in: Array,
    acceleration: float,
    turn: float,
    reference_speed: Array,
    state: Array,
    speed: Array,
    measured: Array,
    substeps: int,
    error: Array,
    current: Array,
    speed_out: Array,
    lanes: int,
) -> None:
    """Advance `lanes` candidates from sample `first` to sample `last`.

    voltage (sources, samples, 2) from `first` on; source (lanes,): which of them a candidate sees.
    torque_in (3, LANES): i_r = t0 i_s + (t1, t2) j + a share of psi_r, which makes no torque.
    load_in (3, LANES): T_load / p = l0 + l1 w + l2 w^2; acceleration: h p^2 / J; turn: w_s h.
    state (8, LANES): x, the rotor's flux of one step before, the last gain in speed; speed (LANES,): half
    a step ahead of the state; both in and out.
    measured (samples / substeps, 2): the squared distance of i_s to it is added to error (LANES,); or empty.
    current (2, samples, LANES), speed_out (samples, LANES): filled for first < k <= last; or empty.
    """
    # Arrays made here have strides the compiler knows: without that it will not use vector instructions.
    E, G0, G1 = np.empty((5, 5, LANES)), np.empty((5, 2, LANES)), np.empty((5, 2, LANES))
    H, torque, load = np.empty((5, 2, LANES)), np.empty((3, LANES)), np.empty((3, LANES))
    E[:], G0[:], G1[:], H[:], torque[:], load[:] = E_in, G0_in, G1_in, H_in, torque_in, load_in
    x = np.empty((8, LANES))
    u, u_next, w, w_reference = np.empty((2, LANES)), np.empty((2, LANES)), np.empty(LANES), np.empty(LANES)
    x[:], w[:], w_reference[:] = state, speed, reference_speed
    distance = np.empty(LANES)
    distance[:] = error
    now, before = mean_over_next_step(turn)
    recorded = current.shape[1] > 0
    compared = measured.shape[0] > 0
    for b in range(lanes):
        u[0, b] = voltage[source[b], 0, 0]
        u[1, b] = voltage[source[b], 0, 1]
    # Indices that cannot be negative (n, source): no wrapping around to be checked for.
    for n in range(last - first):
        k = first + 1 + n
        for b in range(lanes):
            u_next[0, b] = voltage[source[b], n + 1, 0]
            u_next[1, b] = voltage[source[b], n + 1, 1]
        # Everything of one candidate and step in one expression tree: values stay in registers.
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
    state[:], speed[:], error[:] = x, w, distance


@compiled
def change_state(current_from_flux: Array, to_state: Array, to_flux: Array, torque: Array) -> None:
    """Fill to_state and to_flux (5, 5), between the flux of all circuits and x = (i_s, psi_r, j), and torque
    (3,), what of i_r makes torque; the rotor's own inductance is the same in both axes."""
    to_state[:] = current_from_flux
    to_state[2:4] = np.eye(5)[2:4]
    invert(to_state, to_flux)
    for n, (row, column) in enumerate(((2, 0), (2, 4), (3, 4))):
        torque[n] = 0.0
        for k in range(5):
            torque[n] += current_from_flux[row, k] * to_flux[k, column]


@compiled
def discretise_state(
    decay: Array, w: float, step: float, to_state: Array, to_flux: Array, E: Array, G0: Array, G1: Array,
    H: Array,
) -> None:  # fmt: skip
    """The hold at speed w of the state x: that of the flux between the two changes of state."""
    E_flux, product = np.empty((5, 5)), np.empty((5, 5))
    G0_flux, G1_flux, H_flux = np.empty((5, 2)), np.empty((5, 2)), np.empty((5, 2))
    discretise(decay, w, step, E_flux, G0_flux, G1_flux, H_flux)
    multiply(E_flux, to_flux, product)
    multiply(to_state, product, E)
    multiply(to_state, G0_flux, G0)
    multiply(to_state, G1_flux, G1)
    multiply(to_state, H_flux, H)


@compiled
def next_block(block: int, change: float) -> int:
    """Steps of the next block, after the speed changed by `change` in one of `block` [rad/s]."""
    if change > 0.5 * REFERENCE_DRIFT:
        return max(SHORTEST_BLOCK, block // 2)
    return min(LONGEST_BLOCK, 2 * block) if change < 0.2 * REFERENCE_DRIFT else block


@compiled
def simulate(
    voltage: Array,
    first_column: int,
    samples: int,
    source: NDArray[np.uint64],
    delays: Array,
    step: float,
    decay: Array,
    current_from_flux: Array,
    load: Array,
    acceleration: float,
    turn: float,
    flux: Array,
    speed: Array,
    measured: Array,
    substeps: int,
    compare_from: int,
    error: Array,
    current: Array,
    speed_out: Array,
    lanes: int,
) -> None:
    """Simulate up to LANES candidates over `samples` columns from `first_column` on; arrays as in `advance`.

    voltage (columns, 2): undelayed; delays (sources,): of what the candidates see [columns].
    decay = -R inv(L), current_from_flux = inv(L), both (lanes, 5, 5).  flux (5, LANES), speed (LANES,): at
    sample 0; the speed at the last sample out.
    compare_from: first sample whose distance to the measured current counts.
    """
    E, G0, G1 = np.zeros((5, 5, LANES)), np.zeros((5, 2, LANES)), np.zeros((5, 2, LANES))
    H, torque, state = np.zeros((5, 2, LANES)), np.zeros((3, LANES)), np.zeros((8, LANES))
    to_state, to_flux = np.empty((lanes, 5, 5)), np.empty((lanes, 5, 5))
    delayed = np.empty((delays.size, LONGEST_BLOCK + 1, 2))
    reference, before = np.full(LANES, np.inf), np.zeros(LANES)
    for b in range(lanes):
        change_state(current_from_flux[b], to_state[b], to_flux[b], torque[:, b])
        for n in range(5):
            for m in range(5):
                state[n, b] += to_state[b, n, m] * flux[m, b]
        if current.shape[1] > 0:
            current[0, 0, b], current[1, 0, b], speed_out[0, b] = state[0, b], state[1, b], speed[b]
        i_r_alpha = torque[0, b] * state[0, b] + torque[1, b] * state[4, b]
        i_r_beta = torque[0, b] * state[1, b] + torque[2, b] * state[4, b]
        demand = load[0, b] + speed[b] * (load[1, b] + speed[b] * load[2, b])
        state[5, b], state[6, b] = state[2, b], state[3, b]
        state[7, b] = acceleration * (state[3, b] * i_r_alpha - state[2, b] * i_r_beta - demand)
        speed[b] += 0.5 * state[7, b]
    nothing = np.empty((0, 2))
    first, block = 0, SHORTEST_BLOCK
    while first < samples - 1:
        last = min(first + block, samples - 1)
        if first < compare_from - 1:
            last = min(last, compare_from - 1)
        for b in range(lanes):
            if abs(speed[b] - reference[b]) > REFERENCE_DRIFT:
                reference[b] = speed[b]
                discretise_state(
                    decay[b], reference[b], step, to_state[b], to_flux[b], E[:, :, b], G0[:, :, b],
                    G1[:, :, b], H[:, :, b],
                )  # fmt: skip
        for s in range(delays.size):
            delay_voltage(voltage, delays[s], first_column + first, delayed[s, : last - first + 1])
        before[:] = speed
        advance(
            delayed, source, first, last, E, G0, G1, H, torque, load, acceleration, turn, reference, state,
            speed, measured if last >= compare_from else nothing, substeps, error, current, speed_out, lanes,
        )  # fmt: skip
        block = next_block(block, np.abs(speed - before)[:lanes].max())
        first = last
