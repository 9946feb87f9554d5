"""Motion of the winding circuit in time: classical Runge-Kutta method of fourth order, compiled.

The state is the loop fluxes [V s], the rotor's speed [rad/s] and its electrical angle [rad]. Voltages and
load torque are known functions of time, given at the middle of the steps too; pulsations of the load's torque
depend on the rotor's angle beside it.
"""

from math import atan, cos, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ied_sim.motor.compiled import compiled

Array = NDArray[np.float64]

ROUNDS_OF_SATURATION = 3
"""Each brings the inductances nearer to those of their own current; the currents of the step before are
near."""


class Loops(NamedTuple):
    """Loop matrices of the winding circuit, see `windings`, and what turns with its rotor.

    Parameters
    ----------
    leakage, deep_leakage : ndarray, shape (m, m)
        Inductance of the leakage that crosses the teeth's tips, and of that which does not [H].
    A, B, D : ndarray, shape (m, m)
        Parts of the inductance of the air-gap field, P (A + B cos(theta) + D sin(theta)) [H], with P the
        gap's relative permeance.
    R : ndarray, shape (m, m)
        Resistance [ohm].
    pole_pairs : int
        Pole pairs of the motor.
    inertia : float
        Moment of inertia of motor and load [kg m^2].
    static, dynamic : float
        Eccentricities, see `eccentricity`.
    stator_current : ndarray, shape (2, m)
        The stator's current on the axes of the field.
    saturation, knee : float
        Part of the leakage that is lost at great currents, and the current at which it begins [A]; see
        `deep_bars`.
    rotor_current : ndarray, shape (2, m)
        The rotor's current on its own axes.
    main_share, main_exponent : float
        Share and exponent of the saturation of the main inductance; see `saturation`.
    flux_per_current : float
        Flux of the air gap over its rated one, per magnetising current [1/A].
    """

    leakage: Array
    deep_leakage: Array
    A: Array
    B: Array
    D: Array
    R: Array
    pole_pairs: int
    inertia: float
    static: float
    dynamic: float
    stator_current: Array
    saturation: float
    knee: float
    rotor_current: Array
    main_share: float
    main_exponent: float
    flux_per_current: float


class Drive(NamedTuple):
    """Known inputs at every half step.

    Parameters
    ----------
    voltage : ndarray, shape (2 n + 1, m)
        Voltage around each loop [V].
    load_torque : ndarray, shape (2 n + 1,)
        Load torque without its pulsations [N m].
    pulsation_torque, pulsation_order : ndarray, shape (k,)
        Amplitude of each pulsation [N m], and how much its angle grows with the rotor's electrical angle.
    pulsation_angle : ndarray, shape (2 n + 1, k)
        The rest of its angle [rad].
    step : float
        Length of a step [s].
    """

    voltage: Array
    load_torque: Array
    pulsation_torque: Array
    pulsation_order: Array
    pulsation_angle: Array
    step: float


@compiled
def _solve_symmetric(matrix: Array, x: Array) -> None:
    """Solve matrix y = x into x by an in-place Cholesky factorisation.

    For so few loops a call of LAPACK costs more.
    """
    m = x.size
    for j in range(m):
        pivot = matrix[j, j]
        for k in range(j):
            pivot -= matrix[j, k] * matrix[j, k]
        pivot = sqrt(pivot)
        matrix[j, j] = pivot
        for i in range(j + 1, m):
            entry = matrix[i, j]
            for k in range(j):
                entry -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = entry / pivot
    for i in range(m):
        value = x[i]
        for k in range(i):
            value -= matrix[i, k] * x[k]
        x[i] = value / matrix[i, i]
    for i in range(m - 1, -1, -1):
        value = x[i]
        for k in range(i + 1, m):
            value -= matrix[k, i] * x[k]
        x[i] = value / matrix[i, i]


@compiled
def _permeance(loops: Loops, angle: float) -> tuple[float, float]:
    """Return the air gap's relative permeance at an electrical rotor angle, and its slope over a turn."""
    both = 2 * loops.static * loops.dynamic
    turn = angle / loops.pole_pairs
    gap = 1 - loops.static**2 - loops.dynamic**2 - both * cos(turn)
    permeance = 1 / sqrt(gap)
    return permeance, -0.5 * both * sin(turn) * permeance / gap


@compiled
def _unsaturated(loops: Loops, q: Array) -> float:
    """Return the leakage at loop currents q over that at small ones."""
    alpha = beta = 0.0
    for i in range(q.size):
        alpha += loops.stator_current[0, i] * q[i]
        beta += loops.stator_current[1, i] * q[i]
    x = sqrt(alpha * alpha + beta * beta) / loops.knee
    if x < 1e-6:
        return 1.0
    return 1.0 - loops.saturation + loops.saturation * atan(x) / x


@compiled
def _main_share(loops: Loops, c: float, s: float, before: float, q: Array) -> float:
    """Return the main inductance at loop currents q over that at rated flux, from an estimate `before`."""
    alpha = beta = d = e = 0.0
    for i in range(q.size):
        alpha += loops.stator_current[0, i] * q[i]
        beta += loops.stator_current[1, i] * q[i]
        d += loops.rotor_current[0, i] * q[i]
        e += loops.rotor_current[1, i] * q[i]
    alpha += c * d - s * e
    beta += s * d + c * e
    flux = before * loops.flux_per_current * sqrt(alpha * alpha + beta * beta)
    needed: float = 1.0 - loops.main_share + loops.main_share * flux ** (loops.main_exponent - 1.0)
    return 1.0 / needed


@compiled
def _loop_currents(loops: Loops, angle: float, state: Array, matrix: Array, q: Array) -> float:
    """Solve L(theta, q) q = flux for the loop currents q, which hold an estimate of them.

    Returns the main inductance over that at rated flux.
    """
    m = q.size
    c, s = cos(angle), sin(angle)
    gap_permeance, _ = _permeance(loops, angle)
    rounds = 1 if loops.saturation == 0.0 and loops.main_share == 0.0 else ROUNDS_OF_SATURATION
    main = 1.0
    for _ in range(rounds):
        if loops.main_share != 0.0:
            main = _main_share(loops, c, s, main, q)
        P = gap_permeance * main
        share = 1.0 if loops.saturation == 0.0 else _unsaturated(loops, q)
        for i in range(m):
            q[i] = state[i]
            for j in range(i + 1):
                gap = P * (loops.A[i, j] + loops.B[i, j] * c + loops.D[i, j] * s)
                matrix[i, j] = share * loops.leakage[i, j] + loops.deep_leakage[i, j] + gap
        _solve_symmetric(matrix, q)
    return main


@compiled
def _load_torque(drive: Drive, now: int, angle: float) -> float:
    """Return the load's torque with its pulsations at half step `now`."""
    torque: float = drive.load_torque[now]
    for k in range(drive.pulsation_torque.size):
        swing = drive.pulsation_order[k] * angle + drive.pulsation_angle[now, k]
        torque += drive.pulsation_torque[k] * cos(swing)
    return torque


@compiled
def _derivative(
    loops: Loops, drive: Drive, now: int, state: Array, work: Array, q: Array, rate: Array
) -> None:
    """Compute the state's derivative at half step `now` into `rate`.

    d(flux)/dt = e - R q;  J dw_m/dt = p q' (dL/dtheta) q / 2 - T_load;  dtheta/dt = p w_m.
    """
    A, B, D, R = loops.A, loops.B, loops.D, loops.R
    m = q.size
    angle = state[m + 1]
    c, s = cos(angle), sin(angle)
    P, slope = _permeance(loops, angle)
    slope /= loops.pole_pairs
    main = _loop_currents(loops, angle, state, work, q)
    P, slope = P * main, slope * main
    torque = 0.0
    for i in range(m):
        drop = 0.0
        turn = 0.0
        for j in range(m):
            drop += R[i, j] * q[j]
            turn += P * (D[i, j] * c - B[i, j] * s) * q[j]
            if slope != 0.0:
                turn += slope * (A[i, j] + B[i, j] * c + D[i, j] * s) * q[j]
        rate[i] = drive.voltage[now, i] - drop
        torque += q[i] * turn
    rate[m] = (0.5 * loops.pole_pairs * torque - _load_torque(drive, now, angle)) / loops.inertia
    rate[m + 1] = loops.pole_pairs * state[m]


@compiled
def integrate(loops: Loops, drive: Drive, steps_per_sample: int, state: Array) -> tuple[Array, Array]:
    """Integrate the winding circuit; return loop currents and speed at every `steps_per_sample`-th step.

    Parameters
    ----------
    loops : Loops
        The circuit and its rotor.
    drive : Drive
        Voltages and the load's torque at every half step.
    steps_per_sample : int
        Number of steps between samples.
    state : ndarray, shape (m + 2,)
        Initial fluxes [V s], speed [rad/s] and angle [rad]. It holds the final state afterwards.

    Returns
    -------
    currents : ndarray, shape (n / steps_per_sample + 1, m)
        Loop currents [A], those of the initial state first.
    speed : ndarray, shape (n / steps_per_sample + 1,)
        Mechanical speed [rad/s].
    """
    m = state.size - 2
    step = drive.step
    steps = (drive.load_torque.size - 1) // 2
    samples = steps // steps_per_sample + 1
    currents = np.empty((samples, m))
    speed = np.empty(samples)
    work = np.empty((m, m))
    q = np.zeros(m)
    trial = np.empty(m + 2)
    k1, k2, k3, k4 = np.empty(m + 2), np.empty(m + 2), np.empty(m + 2), np.empty(m + 2)

    _loop_currents(loops, state[m + 1], state, work, q)
    currents[0] = q
    speed[0] = state[m]
    for n in range(samples - 1):
        for k in range(steps_per_sample):
            now = 2 * (n * steps_per_sample + k)
            _derivative(loops, drive, now, state, work, q, k1)
            for i in range(m + 2):
                trial[i] = state[i] + 0.5 * step * k1[i]
            _derivative(loops, drive, now + 1, trial, work, q, k2)
            for i in range(m + 2):
                trial[i] = state[i] + 0.5 * step * k2[i]
            _derivative(loops, drive, now + 1, trial, work, q, k3)
            for i in range(m + 2):
                trial[i] = state[i] + step * k3[i]
            _derivative(loops, drive, now + 2, trial, work, q, k4)
            for i in range(m + 2):
                state[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i])
        _loop_currents(loops, state[m + 1], state, work, q)
        currents[n + 1] = q
        speed[n + 1] = state[m]
    return currents, speed
