"""Evidence for a change of unknown size: log of its Bayes factor against no change."""

from math import erfc, exp, log, sqrt

import numpy as np

from core.condition.changes.hypotheses import Hypothesis
from core.condition.filter.state import Candidate, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

LOG_2PI = 1.8378770664093453
LOG_2 = 0.6931471805599453
TINY = 1e-300


@compiled
def log_twice_normal(z: float) -> float:
    """Return ln 2 Phi(z), also far out.

    Parameters
    ----------
    z : float
        Standard deviations.

    Returns
    -------
    float
        Log of twice the normal distribution function.
    """
    if z < -30.0:
        return -0.5 * (z * z + LOG_2PI) - log(-z) + log(2.0)
    return log(erfc(-z / sqrt(2.0)))


@compiled
def of_size(
    a: float, b: float, c: float, l0: float, l1: float, spread: float, direction: float, one_sided: bool
) -> tuple[float, float, float]:
    """Return the evidence for a signature of unknown real size and nearly known direction.

    Parameters
    ----------
    a, b, c : float
        Information Q = [[a, b], [b, c]] on (m, m e).
    l0, l1 : float
        Information vector.
    spread : float
        s, standard deviation of m before.
    direction : float
        Standard deviation of e, the error of the signature's direction: g = m (1 + j e).
    one_sided : bool
        Whether m is positive.

    Returns
    -------
    evidence : float
        l' (Q + D^-1)^-1 l / 2 - ln det(I + D Q) / 2, and ln 2 Phi(m / sd) where m is positive.
    size, deviation : float
        Mean and standard deviation of m afterwards, as if it had no sign.
    """
    D0, D1 = spread * spread, (direction * spread) ** 2
    p, q = a + 1.0 / D0, c + 1.0 / D1
    determinant = p * q - b * b
    size = (q * l0 - b * l1) / determinant
    across = (p * l1 - b * l0) / determinant
    deviation = sqrt(q / determinant)
    evidence = 0.5 * (l0 * size + l1 * across - log(D0 * D1 * determinant))
    if one_sided:
        evidence += log_twice_normal(size / deviation)
    return evidence, size, deviation


@compiled
def of_free_side(information: float, vector: complex, spread: float) -> float:
    """Return the evidence for a jump of any direction in a side channel.

    Parameters
    ----------
    information : float
        Lambda.
    vector : complex
        d.
    spread : float
        Standard deviation of the jump before (complex magnitude).

    Returns
    -------
    float
        |d|^2 D / (1 + D Lambda) - ln(1 + D Lambda).
    """
    D = spread * spread
    grown = 1.0 + D * information
    return (vector.real**2 + vector.imag**2) * D / grown - log(grown)


@compiled
def of_free(information: Array, vector: Array, spreads: Array) -> float:
    """Return the evidence for jumps of any direction.

    Parameters
    ----------
    information : ndarray, shape (n, n)
        Lambda, n at most 4.
    vector : ndarray, shape (n,)
        d.
    spreads : ndarray, shape (n,)
        Standard deviations before.

    Returns
    -------
    float
        d' (Lambda + D^-1)^-1 d / 2 - ln det(I + D Lambda) / 2.
    """
    n = vector.shape[0]
    L, z = np.zeros((4, 4)), np.zeros(4)
    evidence = 0.0
    # Cholesky's factor of I + D^(1/2) Lambda D^(1/2).
    for i in range(n):
        for j in range(i + 1):
            total = spreads[i] * information[i, j] * spreads[j]
            if i == j:
                total += 1.0
            for k in range(j):
                total -= L[i, k] * L[j, k]
            L[i, j] = sqrt(max(total, TINY)) if i == j else total / L[j, j]
        z[i] = spreads[i] * vector[i]
        for k in range(i):
            z[i] -= L[i, k] * z[k]
        z[i] /= L[i, i]
        evidence += 0.5 * z[i] * z[i] - log(L[i, i])
    return evidence


@compiled
def most_of_pair(information: Array, first: int, vector: Array, second: int) -> float:
    """Return the evidence that no hypothesis on a pair of columns can exceed.

    Parameters
    ----------
    information : ndarray
        Lambda; the pair's block begins at row and column `first`.
    first : int
        Where the block begins.
    vector : ndarray
        d; the pair's part begins at `second`.
    second : int
        Where the part begins.

    Returns
    -------
    float
        d' Lambda^-1 d / 2 and what a sign may add, ln 2.
    """
    a, b, c = information[first, first], information[first, first + 1], information[first + 1, first + 1]
    d0, d1 = vector[second], vector[second + 1]
    determinant = a * c - b * b
    if determinant <= 1e-12 * a * c or a <= 0.0:
        return 0.0
    most: float = 0.5 * (d0 * d0 * c - 2.0 * d0 * d1 * b + d1 * d1 * a) / determinant
    return most + LOG_2


@compiled
def along(one: Candidate, column: int, ramp: bool, u: complex, out: Array) -> None:
    """Project a candidate's information onto a signature.

    Parameters
    ----------
    one : Candidate
        The candidate.
    column : int
        0 for a signature in y, 1 for one in proportion to j1, 2 to j2.
    ramp : bool
        Whether it drifts.
    u : complex
        The signature.
    out : ndarray, shape (5,)
        Filled with Q = U' Lambda U as a, b, c and l = U' d, U = [[Re u, -Im u], [Im u, Re u]].
    """
    if column == 2:
        _project(one.impedance, 0, one.d, 4, u, out)
    elif not ramp:
        _project(one.step, 2 * column, one.d, 2 * column, u, out)
    elif column == 0:
        _project(one.ramp_voltage, 0, one.d, 6, u, out)
    else:
        _project(one.ramp_current, 0, one.d, 8, u, out)


@compiled
def _project(block: Array, first: int, d: Array, second: int, u: complex, out: Array) -> None:
    p, q, r = block[first, first], block[first, first + 1], block[first + 1, first + 1]
    d0, d1 = d[second], d[second + 1]
    x, y = u.real, u.imag
    out[0] = p * x * x + 2.0 * q * x * y + r * y * y
    out[1] = -p * x * y + q * (x * x - y * y) + r * x * y
    out[2] = p * y * y - 2.0 * q * x * y + r * x * x
    out[3] = x * d0 + y * d1
    out[4] = -y * d0 + x * d1


Learnt = tuple[complex, complex, float]
"""Factors of the signatures in proportion to Z2 and of the others, and deviation of Z2's direction [rad]."""


@compiled
def learnt(state: FilterState) -> Learnt:
    """Return what the learnt impedance makes of the signatures; see `regressor`.

    Parameters
    ----------
    state : FilterState
        The filter.

    Returns
    -------
    Learnt
        Factors.
    """
    variance = 0.5 * (state.P[4, 4] + state.P[5, 5])
    return _factors(state, state.x[4], state.x[5], variance)


@compiled
def learnt_without(state: FilterState, one: Candidate, ramp: bool) -> Learnt:
    """Return the same if y has jumped or drifts: the filter, which knows nothing of it, let Z2 take up some.

    Parameters
    ----------
    state : FilterState
        The filter.
    one : Candidate
        Where the change began.
    ramp : bool
        Whether y drifts.

    Returns
    -------
    Learnt
        Factors.
    """
    x, P, f, d = state.x, state.P, one.f, one.d
    if ramp:
        c = 6
        p, q, s = one.ramp_voltage[0, 0], one.ramp_voltage[0, 1], one.ramp_voltage[1, 1]
    else:
        c = 0
        p, q, s = one.step[0, 0], one.step[0, 1], one.step[1, 1]
    determinant = p * s - q * q
    r, i = x[4], x[5]
    variance = 0.5 * (P[4, 4] + P[5, 5])
    if determinant > 1e-12 * p * s:
        A, B, C = s / determinant, -q / determinant, p / determinant
        g, h = A * d[c] + B * d[c + 1], B * d[c] + C * d[c + 1]
        r -= f[4, c] * g + f[4, c + 1] * h
        i -= f[5, c] * g + f[5, c + 1] * h
        for k in range(4, 6):
            variance += 0.5 * (A * f[k, c] ** 2 + 2.0 * B * f[k, c] * f[k, c + 1] + C * f[k, c + 1] ** 2)
    return _factors(state, r, i, variance)


@compiled
def _factors(state: FilterState, r: float, i: float, variance: float) -> Learnt:
    nominal = state.nominal
    found = complex(r, i) / nominal
    deviation = sqrt(variance / (nominal.real**2 + nominal.imag**2))
    return 1.0 + (1.0 - state.balance) * found, 1.0 - state.balance * found, deviation


@compiled
def signature(known: Learnt, it: Hypothesis) -> tuple[complex, float]:
    """Return what a cause looks like in y with the impedance that has been learnt.

    Parameters
    ----------
    known : Learnt
        Factors of the signatures.
    it : Hypothesis
        The cause and its place.

    Returns
    -------
    u : complex
        Signature per size.
    direction : float
        Standard deviation of its direction [rad].
    """
    if not it.impedance:
        return it.u * known[1], it.direction
    return it.u * known[0], sqrt(it.direction**2 + known[2] ** 2)


@compiled
def log_add(a: float, b: float) -> float:
    """Return ln(exp a + exp b).

    Parameters
    ----------
    a, b : float
        Logs.

    Returns
    -------
    float
        Log of the sum.
    """
    high, low = max(a, b), min(a, b)
    return high + log(1.0 + exp(low - high))
