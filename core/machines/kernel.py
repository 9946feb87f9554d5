"""Stepping a batch of candidates through the same record: the only loop that runs per sample.

Candidates lie side by side in the last axis, so that one vector instruction advances several of them.
Within a step the speed is constant: the electrical part is exact for a straight-line voltage, with the
rotor's rotation by (w - w_reference) h split symmetrically around it (Strang), and the speed is advanced at
half steps (leapfrog). Both are of second order; the reference speed follows the machine from block to block,
so that the split angle stays small even in a start from rest.
"""

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.discretisation import first_order_hold

LANES = 16
BLOCK_SAMPLES = 256
REFERENCE_DRIFT = 20.0
"""Largest |w - w_reference| before a candidate is discretised anew [rad/s]: the split's error follows it."""


@compiled
def advance(
    voltage: Array,
    source: NDArray[np.int64],
    first: int,
    last: int,
    step: float,
    E_in: Array,
    G0_in: Array,
    G1_in: Array,
    C_in: Array,
    load_in: Array,
    acceleration: float,
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

    voltage (sources, samples, 2); source (lanes,): which voltage a candidate sees.
    C_in (4, 5, LANES): rows of inverse inductance giving i_s and i_r from the flux.
    load_in (3, LANES): T_load / p = l0 + l1 w + l2 w^2; acceleration: h p^2 / J.
    state (5, LANES), speed (LANES,): in and out, the speed half a step ahead of the state.
    measured (samples / substeps, 2): the squared distance of i_s to it is added to error (LANES,); or empty.
    current (2, samples, LANES), speed_out (samples, LANES): filled for first < k <= last; or empty.
    """
    # Arrays made here have strides the compiler knows: without that it will not use vector instructions.
    E, G0, G1 = np.empty((5, 5, LANES)), np.empty((5, 2, LANES)), np.empty((5, 2, LANES))
    C, load = np.empty((4, 5, LANES)), np.empty((3, LANES))
    E[:], G0[:], G1[:], C[:], load[:] = E_in, G0_in, G1_in, C_in, load_in
    x, i_s, kick = np.empty((5, LANES)), np.empty((2, LANES)), np.empty(LANES)
    u, u_next, w, w_reference = np.empty((2, LANES)), np.empty((2, LANES)), np.empty(LANES), np.empty(LANES)
    x[:], w[:], w_reference[:] = state, speed, reference_speed
    distance = np.empty(LANES)
    distance[:] = error
    half = 0.5 * step
    recorded = current.shape[1] > 0
    compared = measured.shape[0] > 0
    for b in range(lanes):
        u[0, b] = voltage[source[b], first, 0]
        u[1, b] = voltage[source[b], first, 1]
    for k in range(first + 1, last + 1):
        for b in range(lanes):
            u_next[0, b] = voltage[source[b], k, 0]
            u_next[1, b] = voltage[source[b], k, 1]
        # Everything of one candidate and step in one expression tree: values stay in registers.
        for b in range(lanes):
            x0, x1, x2, x3, x4 = x[0, b], x[1, b], x[2, b], x[3, b], x[4, b]
            u0, u1, y0, y1 = u[0, b], u[1, b], u_next[0, b], u_next[1, b]
            angle = half * (w[b] - w_reference[b])
            square = angle * angle
            sine = angle * (1.0 - square * (1.0 / 6.0))
            cosine = 1.0 - square * (0.5 - square * (1.0 / 24.0))
            r2 = cosine * x2 - sine * x3
            r3 = sine * x2 + cosine * x3
            z0 = E[0, 0, b] * x0 + E[0, 1, b] * x1 + E[0, 2, b] * r2 + E[0, 3, b] * r3 + E[0, 4, b] * x4
            z0 += G0[0, 0, b] * u0 + G0[0, 1, b] * u1 + G1[0, 0, b] * y0 + G1[0, 1, b] * y1
            z1 = E[1, 0, b] * x0 + E[1, 1, b] * x1 + E[1, 2, b] * r2 + E[1, 3, b] * r3 + E[1, 4, b] * x4
            z1 += G0[1, 0, b] * u0 + G0[1, 1, b] * u1 + G1[1, 0, b] * y0 + G1[1, 1, b] * y1
            z2 = E[2, 0, b] * x0 + E[2, 1, b] * x1 + E[2, 2, b] * r2 + E[2, 3, b] * r3 + E[2, 4, b] * x4
            z2 += G0[2, 0, b] * u0 + G0[2, 1, b] * u1 + G1[2, 0, b] * y0 + G1[2, 1, b] * y1
            z3 = E[3, 0, b] * x0 + E[3, 1, b] * x1 + E[3, 2, b] * r2 + E[3, 3, b] * r3 + E[3, 4, b] * x4
            z3 += G0[3, 0, b] * u0 + G0[3, 1, b] * u1 + G1[3, 0, b] * y0 + G1[3, 1, b] * y1
            z4 = E[4, 0, b] * x0 + E[4, 1, b] * x1 + E[4, 2, b] * r2 + E[4, 3, b] * r3 + E[4, 4, b] * x4
            z4 += G0[4, 0, b] * u0 + G0[4, 1, b] * u1 + G1[4, 0, b] * y0 + G1[4, 1, b] * y1
            r2 = cosine * z2 - sine * z3
            r3 = sine * z2 + cosine * z3
            i_s_alpha = (
                C[0, 0, b] * z0 + C[0, 1, b] * z1 + C[0, 2, b] * r2 + C[0, 3, b] * r3 + C[0, 4, b] * z4
            )
            i_s_beta = C[1, 0, b] * z0 + C[1, 1, b] * z1 + C[1, 2, b] * r2 + C[1, 3, b] * r3 + C[1, 4, b] * z4
            i_r_alpha = (
                C[2, 0, b] * z0 + C[2, 1, b] * z1 + C[2, 2, b] * r2 + C[2, 3, b] * r3 + C[2, 4, b] * z4
            )
            i_r_beta = C[3, 0, b] * z0 + C[3, 1, b] * z1 + C[3, 2, b] * r2 + C[3, 3, b] * r3 + C[3, 4, b] * z4
            # T_e / p = psi_r_beta i_r_alpha - psi_r_alpha i_r_beta: torque on the rotor, whatever the stator
            demand = load[0, b] + w[b] * (load[1, b] + w[b] * load[2, b])
            kick[b] = acceleration * (r3 * i_r_alpha - r2 * i_r_beta - demand)
            w[b] += kick[b]
            x[0, b], x[1, b], x[2, b], x[3, b], x[4, b] = z0, z1, r2, r3, z4
            u[0, b], u[1, b] = y0, y1
            i_s[0, b], i_s[1, b] = i_s_alpha, i_s_beta
        if recorded:
            for b in range(lanes):
                current[0, k, b] = i_s[0, b]
                current[1, k, b] = i_s[1, b]
                speed_out[k, b] = w[b] - 0.5 * kick[b]
        if compared and k % substeps == 0:
            i_alpha, i_beta = measured[k // substeps, 0], measured[k // substeps, 1]
            for b in range(lanes):
                distance[b] += (i_s[0, b] - i_alpha) ** 2 + (i_s[1, b] - i_beta) ** 2
    state[:], speed[:], error[:] = x, w, distance


@compiled
def simulate(
    voltage: Array,
    source: NDArray[np.int64],
    step: float,
    decay: Array,
    current_from_flux: Array,
    load: Array,
    acceleration: float,
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
    """Simulate up to LANES candidates over a whole record; see `advance` for the arrays.

    decay (LANES, 5, 5): -R inv(L).  flux (5, LANES), speed (LANES,): at sample 0 in, at the last sample out.
    compare_from: first sample whose distance to the measured current counts.
    """
    samples = voltage.shape[1]
    E, G0, G1 = np.zeros((5, 5, LANES)), np.zeros((5, 2, LANES)), np.zeros((5, 2, LANES))
    A, E1, G01, G11 = np.empty((5, 5)), np.empty((5, 5)), np.empty((5, 2)), np.empty((5, 2))
    reference = np.full(LANES, np.inf)
    i = np.zeros(4)
    for b in range(lanes):
        for n in range(4):
            i[n] = 0.0
            for m in range(5):
                i[n] += current_from_flux[n, m, b] * flux[m, b]
        if current.shape[1] > 0:
            current[0, 0, b], current[1, 0, b], speed_out[0, b] = i[0], i[1], speed[b]
        demand = load[0, b] + speed[b] * (load[1, b] + speed[b] * load[2, b])
        speed[b] += 0.5 * acceleration * (flux[3, b] * i[2] - flux[2, b] * i[3] - demand)
    nothing = np.empty((0, 2))
    first = 0
    while first < samples - 1:
        last = min(first + BLOCK_SAMPLES, samples - 1)
        if first < compare_from - 1:
            last = min(last, compare_from - 1)
        for b in range(lanes):
            if abs(speed[b] - reference[b]) > REFERENCE_DRIFT:
                reference[b] = speed[b]
                A[:] = decay[b]
                A[2, 3] -= speed[b]
                A[3, 2] += speed[b]
                first_order_hold(A, step, E1, G01, G11)
                E[:, :, b], G0[:, :, b], G1[:, :, b] = E1, G01, G11
        advance(
            voltage, source, first, last, step, E, G0, G1, current_from_flux, load, acceleration, reference,
            flux, speed, measured if last >= compare_from else nothing, substeps, error, current, speed_out,
            lanes,
        )  # fmt: skip
        first = last
