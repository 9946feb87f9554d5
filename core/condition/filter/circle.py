"""Filter of what moves the forward-turning current off its circle, and what a change adds there.

    D_k = h_k b + n_k,   b = (offset, gain, errors of R_s, leakages and L_s, saturation, R_s by temperature,
                              real and imaginary part of what z I1/V1 has beside the motor)

The last two are zero until a change is taken in that moves z I1/V1: an element or another load.

The load moves the current along the circle, so that D shows nothing of it. A change of z I1/V1 by g moves D
by Re(conj(outwards) g): g is in proportion to the level of shorted turns, to j1 of a channel's error, and to
-j1^2 of a joint's resistance.
"""

from math import exp, log
from typing import Final

import numpy as np

from core.condition.filter.kalman import CHANGE_NOISE, TEMPERATURE, TIME_CONSTANT_S
from core.condition.filter.state import CHANNEL, CIRCLE_COLUMNS, CIRCLE_STATES, TURNS, Candidate, CircleState
from core.condition.measuring.circle import BesideCircle
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

WANDERS: Final = (1e-3, 1e-3, 1e-4, 1e-4, 1e-4, 1e-3)
"""Standard deviations by which the unknowns wander from record to record."""
_TEMPERATURE, _BESIDE = 6, 7
"""Places of the temperature and of the current beside the motor among the unknowns."""
LARGEST_ELEMENT: Final = 0.06
"""|z I1/V1| from which on a load beside the motor is another motor, whose own load varies."""
LOAD_VARIES: Final = 0.3
"""Standard deviation of its current from record to record over it."""
FIRST_NOISE: Final = 5e-4
"""Standard deviation of D to start from: inductances scatter by 0.5 %."""
FIRST_COUNT, MOST_COUNT = 6.0, 100.0
"""Number of records that it counts for, and most that are remembered."""
LEAST_NOISE: Final = 5e-5
LEARNING_CLIP, LEARNING_MEAN = 6.0, 0.95
LEAST_SHARE: Final = 0.3
OUTLIER: Final = 9.0
"""Largest squared innovation over its variance."""
LOAD: Final = 0.1
"""Standard deviation of each part of z I1/V1 that another load adds."""
JUMP: Final = 0.005
"""Standard deviation of a jump of z I1/V1 that no cause explains, each part."""


@compiled
def begin_circle(state: CircleState) -> None:
    """Forget all but what the filter starts from, `spread`.

    Parameters
    ----------
    state : CircleState
        The filter.
    """
    state.x[:] = 0.0
    state.P[:] = 0.0
    for k in range(CIRCLE_STATES):
        state.P[k, k] = state.spread[k] ** 2
    state.s2, state.known, state.S = FIRST_NOISE**2, FIRST_COUNT, 0.0


@compiled
def expected_beside(one: Candidate, seen: BesideCircle, ramp: float, drifts: bool) -> float:
    """Return what a change adds to the innovation of the next record, as the records before it have it.

    Parameters
    ----------
    one : Candidate
        The change.
    seen : BesideCircle
        Where the record lies.
    ramp : float
        How far a drift has come.
    drifts : bool
        Whether it drifts.

    Returns
    -------
    float
        What shorted turns, or a jump of no known cause, would add.
    """
    at = 1 if drifts else 0
    information, d = one.circle_information[at, TURNS], one.circle_d[at]
    p, q, r = information[0] + JUMP**-2, information[1], information[2] + JUMP**-2
    g = (r * d[0] - q * d[1]) / (p * r - q * q), (p * d[1] - q * d[0]) / (p * r - q * q)
    shape = ramp if drifts else 1.0
    added: float = shape * (seen.outwards.real * g[0] + seen.outwards.imag * g[1])
    for k in range(CIRCLE_STATES):
        slope = _slope(seen, k)
        for c in range(2):
            added -= slope * one.circle_f[k, CIRCLE_COLUMNS * at + c] * g[c]
    return added


@compiled
def _slope(seen: BesideCircle, k: int) -> float:
    """Return by how much the distance grows with an unknown."""
    if k < _TEMPERATURE:
        return seen.slopes[k]
    if k == _TEMPERATURE:
        return seen.slopes[2]
    return seen.outwards.real if k == _BESIDE else seen.outwards.imag


@compiled
def _let_load_vary(state: CircleState) -> None:
    """Let the current beside the motor be another in each record where it is that of another motor."""
    square = state.x[_BESIDE] ** 2 + state.x[_BESIDE + 1] ** 2
    if square > LARGEST_ELEMENT**2:
        for i in range(_BESIDE, CIRCLE_STATES):
            state.P[i, i] += LOAD_VARIES**2 * square


@compiled
def fold_circle(
    state: CircleState, seen: BesideCircle, j1: complex, elapsed_s: float, learns: bool, changed_by: float
) -> None:
    """Take one record in; leave gain, innovation and its variance in the state.

    Parameters
    ----------
    state : CircleState
        The filter.
    seen : BesideCircle
        Where the record lies.
    j1 : complex
        z I1/V1 of the record.
    elapsed_s : float
        Time since the record before [s].
    learns : bool
        Whether the record teaches the noise.
    changed_by : float
        What a change that is seen adds to the innovation. A record that it explains is no outlier.
    """
    x, P, h, K = state.x, state.P, state.h, state.K
    last = _TEMPERATURE
    rho = exp(-elapsed_s / TIME_CONSTANT_S)
    state.rho = rho
    x[last] *= rho
    for i in range(CIRCLE_STATES):
        P[i, last] *= rho
        P[last, i] *= rho
    for i in range(last):
        P[i, i] += WANDERS[i] ** 2
    P[last, last] += (1.0 - rho * rho) * TEMPERATURE**2
    _let_load_vary(state)
    state.S = 0.0
    if seen.outwards == 0.0:
        return
    for i in range(CIRCLE_STATES):
        h[i] = _slope(seen, i)
    w = seen.outwards.conjugate() * j1
    state.columns[0], state.columns[1] = seen.outwards.real, seen.outwards.imag
    state.columns[2], state.columns[3] = w.real, -w.imag
    state.columns[4] = -(w * j1).real
    predicted, nu = 0.0, seen.distance
    for i in range(CIRCLE_STATES):
        K[i] = 0.0
        for j in range(CIRCLE_STATES):
            K[i] += P[i, j] * h[j]
        predicted += K[i] * h[i]
        nu -= h[i] * x[i]
    usual = predicted + state.s2 + (CHANGE_NOISE * changed_by) ** 2
    odd = min(abs(nu), abs(nu - changed_by))
    S = max(usual, odd * odd / OUTLIER)
    for i in range(CIRCLE_STATES):
        K[i] /= S
        x[i] += K[i] * nu
    for i in range(CIRCLE_STATES):
        for j in range(i, CIRCLE_STATES):
            P[i, j] -= S * K[i] * K[j]
            P[j, i] = P[i, j]
        P[i, i] = max(P[i, i], 1e-14)
    state.S, state.nu = S, nu
    share = state.s2 / usual
    if learns and share > LEAST_SHARE:
        state.known = min(state.known + share, MOST_COUNT)
        surprise = min(nu * nu / usual, LEARNING_CLIP) / LEARNING_MEAN
        state.s2 = max(state.s2 * (1.0 + share * (surprise - 1.0) / state.known), LEAST_NOISE**2)


@compiled
def fold_circle_candidate(one: Candidate, state: CircleState, ramp: float) -> None:
    """Let the record tell of a candidate.

    Parameters
    ----------
    one : Candidate
        The candidate.
    state : CircleState
        The filter, after the record.
    ramp : float
        How far a drift has come.
    """
    f, h, K = one.circle_f, state.h, state.K
    for c in range(2 * CIRCLE_COLUMNS):
        f[_TEMPERATURE, c] *= state.rho
    if state.S <= 0.0:
        return
    G = np.empty(2 * CIRCLE_COLUMNS)
    for c in range(2 * CIRCLE_COLUMNS):
        total = state.columns[c % CIRCLE_COLUMNS] * (1.0 if c < CIRCLE_COLUMNS else ramp)
        for k in range(CIRCLE_STATES):
            total -= h[k] * f[k, c]
        G[c] = total
        for k in range(CIRCLE_STATES):
            f[k, c] += K[k] * total
    for drifts in range(2):
        information, d = one.circle_information[drifts], one.circle_d[drifts]
        at = CIRCLE_COLUMNS * drifts
        for c in range(CIRCLE_COLUMNS):
            d[c] += G[at + c] * state.nu / state.S
        for pair in range(2):
            a, b = G[at + 2 * pair], G[at + 2 * pair + 1]
            information[pair, 0] += a * a / state.S
            information[pair, 1] += a * b / state.S
            information[pair, 2] += b * b / state.S
        information[2, 0] += G[at + 4] ** 2 / state.S


@compiled
def take_in_circle(state: CircleState, one: Candidate) -> None:
    """Take a step into the unknowns: that of a load beside the motor, or else errors of the channels.

    Parameters
    ----------
    state : CircleState
        The filter; it changes.
    one : Candidate
        The change.
    """
    x, P = state.x, state.P
    information, d = one.circle_information[0], one.circle_d[0]
    most = np.zeros(2)
    for pair in range(2):
        p, q, r = information[pair, 0], information[pair, 1], information[pair, 2]
        determinant = p * r - q * q
        if determinant > 1e-6 * p * r:
            a, b = d[2 * pair], d[2 * pair + 1]
            most[pair] = 0.5 * (a * a * r - 2.0 * a * b * q + b * b * p) / determinant
    if most[TURNS] <= most[CHANNEL]:
        for k in range(2):
            P[k, k] += state.spread[k] ** 2
        return
    M = np.zeros((2, 2))
    p, q, r = information[TURNS, 0] + LOAD**-2, information[TURNS, 1], information[TURNS, 2] + LOAD**-2
    determinant = p * r - q * q
    M[0, 0], M[0, 1], M[1, 0], M[1, 1] = r / determinant, -q / determinant, -q / determinant, p / determinant
    T = np.zeros((CIRCLE_STATES, 2))
    for k in range(CIRCLE_STATES):
        for c in range(2):
            T[k, c] = -one.circle_f[k, c]
    T[_BESIDE, 0] += 1.0
    T[_BESIDE + 1, 1] += 1.0
    g0, g1 = M[0, 0] * d[0] + M[0, 1] * d[1], M[1, 0] * d[0] + M[1, 1] * d[1]
    spread = T @ M @ T.T
    for i in range(CIRCLE_STATES):
        x[i] += T[i, 0] * g0 + T[i, 1] * g1
        for j in range(CIRCLE_STATES):
            P[i, j] += spread[i, j]


@compiled
def along_circle(one: Candidate, drifts: bool, column: int, s: complex, power: float, out: Array) -> None:
    """Add what the current shows of a signature to the information on its size.

    Parameters
    ----------
    one : Candidate
        The candidate.
    drifts : bool
        Whether it drifts.
    column : int
        TURNS, CHANNEL or JOINT: what the change is in proportion to.
    s : complex
        The signature; real of a joint.
    power : float
        Weight of the information.
    out : ndarray, shape (5,)
        Information a, b, c and vector l0, l1 on (m, m e), as `evidence.along` has them; it grows.
    """
    at = 1 if drifts else 0
    information = one.circle_information[at, column]
    p, q, r = information[0], information[1], information[2]
    d0 = one.circle_d[at, 2 * column]
    d1 = one.circle_d[at, 2 * column + 1] if 2 * column + 1 < CIRCLE_COLUMNS else 0.0
    x, y = s.real, s.imag
    out[0] += power * (p * x * x + 2.0 * q * x * y + r * y * y)
    out[1] += power * (-p * x * y + q * (x * x - y * y) + r * x * y)
    out[2] += power * (p * y * y - 2.0 * q * x * y + r * x * x)
    out[3] += power * (x * d0 + y * d1)
    out[4] += power * (-y * d0 + x * d1)


@compiled
def circle_without(one: Candidate, drifts: bool, power: float, spread: float) -> float:
    """Return the evidence for a jump of z I1/V1 that no cause explains.

    Parameters
    ----------
    one : Candidate
        The candidate.
    drifts : bool
        Whether it drifts.
    power : float
        Weight of the information.
    spread : float
        Standard deviation of each part of the jump before.

    Returns
    -------
    float
        Log of its Bayes factor against none.
    """
    at = 1 if drifts else 0
    D = spread**2
    p = 1.0 + D * power * one.circle_information[at, 0, 0]
    q = D * power * one.circle_information[at, 0, 1]
    r = 1.0 + D * power * one.circle_information[at, 0, 2]
    d0, d1 = power * one.circle_d[at, 0], power * one.circle_d[at, 1]
    determinant = p * r - q * q
    explained: float = D * (d0 * d0 * r - 2.0 * d0 * d1 * q + d1 * d1 * p) / determinant
    return 0.5 * (explained - log(determinant))
