"""Periodic steady state from phasors: the slip by one torque balance, the flux of every circuit at t = 0.

At constant speed the five circuits are linear and real, so one complex solution per candidate at +w_s carries
the positive and the negative sequence together: with v(t) = Re(V e^{j w_s t}) on both Clarke axes,

    (j w_s I - A(w)) Psi = [V; 0],   A(w) = -R inv(L) + w Jr,
    T_e / p = Re(Psi_r x conj(I_r)) / 2  (mean)  +  Re((Psi_r x I_r) e^{j 2 w_s t}) / 2  (ripple)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled

SPEED_TOLERANCE = 1e-9
MOST_ITERATIONS = 60


@dataclass(frozen=True, slots=True)
class SteadyState:
    """Of each candidate: flux at t = 0 (5, candidates) [V s], speed at t = 0 and mean speed (candidates,)
    [electrical rad/s], stator current phasors on the Clarke axes (2, candidates) [A, peak], and whether a
    speed exists at which the torques balance (candidates,)."""

    flux: Array
    speed: Array
    mean_speed: Array
    current: NDArray[np.complex128]
    balanced: NDArray[np.bool_]


@compiled
def solve_circuits(
    decay: Array, w: float, w_s: float, V_alpha: complex, V_beta: complex, flux: NDArray[np.complex128]
) -> None:
    """flux = inv(j w_s I - decay - w Jr) [V; 0] by elimination; the diagonal dominates, so no pivoting."""
    M = np.empty((5, 6), np.complex128)
    for i in range(5):
        for j in range(5):
            M[i, j] = -decay[i, j]
        M[i, i] += 1j * w_s
        M[i, 5] = 0.0
    M[2, 3] += w
    M[3, 2] -= w
    M[0, 5] = V_alpha
    M[1, 5] = V_beta
    for i in range(5):
        for row in range(i + 1, 5):
            factor = M[row, i] / M[i, i]
            for j in range(i, 6):
                M[row, j] -= factor * M[i, j]
    for i in range(4, -1, -1):
        total = M[i, 5]
        for j in range(i + 1, 5):
            total -= M[i, j] * flux[j]
        flux[i] = total / M[i, i]


@compiled
def mean_torque(
    decay: Array, current_from_flux: Array, w: float, w_s: float, V_alpha: complex, V_beta: complex,
    flux: NDArray[np.complex128], rotor: NDArray[np.complex128],
) -> float:  # fmt: skip
    """Mean of T_e / p at speed w; leaves the flux and the rotor currents of that speed behind."""
    solve_circuits(decay, w, w_s, V_alpha, V_beta, flux)
    for axis in range(2):
        rotor[axis] = 0.0
        for j in range(5):
            rotor[axis] += current_from_flux[2 + axis, j] * flux[j]
    crossed = flux[3] * np.conj(rotor[0]) - flux[2] * np.conj(rotor[1])
    return 0.5 * float(crossed.real)


@compiled
def balance(
    decay: Array, current_from_flux: Array, load: Array, w_s: float, V_alpha: complex, V_beta: complex,
    pull_out_slip: float, flux: NDArray[np.complex128], rotor: NDArray[np.complex128],
) -> tuple[float, bool]:  # fmt: skip
    """Speed between pull-out and synchronism (a little above, for the drag of the negative sequence) at
    which motor and load torque agree, by regula falsi (Illinois); False where the load is too heavy."""
    low, high = w_s * (1.0 - pull_out_slip), w_s * (1.0 + 0.1 * pull_out_slip)
    surplus_low = (
        mean_torque(decay, current_from_flux, low, w_s, V_alpha, V_beta, flux, rotor)
        - load[0] - low * (load[1] + low * load[2])
    )  # fmt: skip
    if surplus_low <= 0.0:
        return low, False
    surplus_high = (
        mean_torque(decay, current_from_flux, high, w_s, V_alpha, V_beta, flux, rotor)
        - load[0] - high * (load[1] + high * load[2])
    )  # fmt: skip
    w, side = high, 0
    for _ in range(MOST_ITERATIONS):
        previous = w
        w = (low * surplus_high - high * surplus_low) / (surplus_high - surplus_low)
        surplus = (
            mean_torque(decay, current_from_flux, w, w_s, V_alpha, V_beta, flux, rotor)
            - load[0] - w * (load[1] + w * load[2])
        )  # fmt: skip
        if abs(w - previous) < SPEED_TOLERANCE * w_s:
            break
        if surplus > 0.0:
            low, surplus_low = w, surplus
            if side == 1:
                surplus_high *= 0.5
            side = 1
        else:
            high, surplus_high = w, surplus
            if side == -1:
                surplus_low *= 0.5
            side = -1
    return w, True
