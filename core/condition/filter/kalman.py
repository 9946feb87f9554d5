"""Kalman filter of a motor's standing errors.

    y_k = E + C j1_k + (r + t_k + j x) j2_k + n_k

The state is x = (E_re, E_im, C_re, C_im, r, x, t). E is what the voltage channels and the winding leave, C
the current channels and joints, r + j x the error of the negative-sequence impedance, and t what the
winding's temperature adds to its resistance, a first-order autoregression in time.
"""

from math import exp

import numpy as np

from core.condition.filter.state import START, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

STATES = 7
WANDER_EC = 1e-5
"""Standard deviation by which each part of E and C wanders from record to record."""
WANDER_Z = 1e-3
"""The same of r and x."""
TEMPERATURE = 0.08
"""Standard deviation of Z2's change with the winding's temperature over |Z2|."""
TIME_CONSTANT_S = 3.0 * 3600.0
"""How long a winding keeps its temperature [s]."""
DRIFT_FADES = 1.0 - 1.0 / 64.0
"""Factor of a drift's variance from record to record: no drift goes on for ever."""
C_NOISE = 0.14
"""Share of C that temperature makes uncertain, for it acts through Z2."""
Z_NOISE = 0.003
"""Share of j2 that speed and frequency leave uncertain."""
MOST_Z = 0.6
"""Largest error of Z2 over |Z2| that explains a surprising record: four standard deviations before."""
CHANGE_NOISE = 0.1
"""Share of a change by which it varies from record to record: the temperature of R_s, the load."""
OUTLIER = 12.25
"""Largest squared innovation over its variance: a record counts 6 nats at most."""
LEARNING_CLIP, LEARNING_MEAN = 6.0, 1.85
LEAST_SHARE = 0.3
"""Share of the noise in the innovation above which the innovation teaches the noise."""
FIRST_KNOWN, MOST_KNOWN = 2.5, 100.0
"""Records that the noise is known from after the first eight, and at most: it remembers a hundred."""
W_APART, W_CLIP = 16.0, 9.0
W_FIRST = 8.0
W_JUMP = 6.0
W_SLOWEST = 1.0 / 128.0
BISECTIONS = 50
NOISE_OF_W = 0.5
"""Largest variance of the regressor's noise over y's; that of balanced noises is a quarter."""
TINY = 1e-30


@compiled
def predict(state: FilterState, elapsed_s: float) -> float:
    """Let time pass from one record to the next.

    Parameters
    ----------
    state : FilterState
        The filter.
    elapsed_s : float
        Time since the record before [s].

    Returns
    -------
    float
        rho, the factor of the temperature.
    """
    x, P = state.x, state.P
    rho = exp(-elapsed_s / TIME_CONSTANT_S)
    x[6] *= rho
    for i in range(6):
        P[i, 6] *= rho
        P[6, i] *= rho
    P[6, 6] = rho * rho * P[6, 6] + (1.0 - rho * rho) * TEMPERATURE * TEMPERATURE
    for i in range(2):
        P[i, i] += WANDER_EC * WANDER_EC + state.drift_E
        P[i + 2, i + 2] += WANDER_EC * WANDER_EC + state.drift_C
    state.drift_E *= DRIFT_FADES
    state.drift_C *= DRIFT_FADES
    for i in range(4, 6):
        P[i, i] += WANDER_Z * WANDER_Z
    return rho


@compiled
def regressor(state: FilterState, y: complex, j2: complex) -> complex:
    """Return j2 with the noise of voltages and currents in balance.

    Noise of the currents is in y and in j2. As a regressor j2 would draw r + jx towards -Z2n/z: the more,
    the less V2 changes. That of the voltages is in y and in v2 = y + Z2n j2/z. With the share b of y's noise
    that the currents make,

        w = j2 + b y z / Z2n,

    the noises of w and y have nothing in common. The state is then (E, C, r + jx) / (1 + b q), with
    q = (r + jx) z / Z2n, and so are the signatures.

    Parameters
    ----------
    state : FilterState
        The filter.
    y, j2 : complex
        The record.

    Returns
    -------
    complex
        w.
    """
    return j2 + state.balance * y / state.nominal


@compiled
def smooth(state: FilterState, w: complex, earlier: complex) -> None:
    """Take the noise off the regressor, lest it passes for a supply that changes and teaches the impedance.

    V2 wanders or jumps. Of a small difference to the record before, the share is taken that a wandering level
    with such noise has in it; of a large one nearly all. By how much it wanders is seen over 16 records, in
    which noise counts no more than over one.

    Parameters
    ----------
    state : FilterState
        The filter; `state.w` is that of the record before, and then that of this one.
    w : complex
        Regressor of the record.
    earlier : complex
        `state.w` of 16 records before.
    """
    gain = max(1.0 / (state.records + 1.0 - W_FIRST), W_SLOWEST)
    state.w_near += gain * (_clipped(w - state.w_raw, state.w_near) - state.w_near)
    state.w_far += gain * (_clipped(w - earlier, state.w_near) - state.w_far)
    state.w_raw = w
    noise = min(NOISE_OF_W * state.s2, 0.5 * state.w_near)
    wander = max(state.w_far - state.w_near, 0.0) / (W_APART - 1.0)
    ratio = max(wander / max(noise, TINY), TINY)
    share = 2.0 / (1.0 + np.sqrt(1.0 + 4.0 / ratio))
    apart = w - state.w
    share = max(share, 1.0 - W_JUMP * noise / max(apart.real**2 + apart.imag**2, TINY))
    state.w += share * apart


@compiled
def _clipped(difference: complex, usual: float) -> float:
    """Return the square of a difference, of an unusual one not more than nine times the usual square."""
    square = difference.real**2 + difference.imag**2
    return min(square, W_CLIP * usual) if usual > 0.0 else square


@compiled
def rebalance(state: FilterState, balance: float) -> None:
    """Let the regressor be another; E, C and the impedance stay what they are.

    Parameters
    ----------
    state : FilterState
        The filter.
    balance : float
        Share of y's noise that the currents make.
    """
    x, b = state.x, state.balance
    found = complex(x[4], x[5]) / state.nominal
    q = found / (1.0 - b * found)
    other = q / (1.0 + balance * q)
    ratio = (1.0 - balance * other) / (1.0 - b * found)
    E, C, Z = complex(x[0], x[1]) * ratio, complex(x[2], x[3]) * ratio, other * state.nominal
    x[0], x[1], x[2], x[3], x[4], x[5] = E.real, E.imag, C.real, C.imag, Z.real, Z.imag
    state.balance = balance


@compiled
def update(
    state: FilterState, y: complex, j1: complex, j2: complex, bounded: bool, changed_by: tuple[float, float]
) -> None:
    """Take one record in; leave H, K, S_inverse and nu in the state.

    Parameters
    ----------
    state : FilterState
        The filter, after `predict`.
    y, j1, j2 : complex
        The record.
    bounded : bool
        Whether the record teaches no error of Z2 that is larger than a file's can be. After a change it
        teaches none at all: shorted turns that go on growing look like one.
    changed_by : tuple of float
        What a change that is seen adds to the innovation. A record that it explains is no outlier.
    """
    x, H, K, Si, nu = state.x, state.H, state.K, state.S_inverse, state.nu
    rows(j1, j2, H)
    PH = np.zeros((STATES, 2))
    _times_transposed(state.P, H, PH)
    a, b, c = _predicted(H, PH)
    nu[0], nu[1] = y.real, y.imag
    for j in range(STATES):
        nu[0] -= H[0, j] * x[j]
        nu[1] -= H[1, j] * x[j]
    nominal = 0.5 * (
        state.s2
        + (C_NOISE * state.current_deviation) ** 2 * (j1.real**2 + j1.imag**2)
        + Z_NOISE**2 * (j2.real**2 + j2.imag**2)
        + CHANGE_NOISE**2 * (changed_by[0] ** 2 + changed_by[1] ** 2)
    )
    state.surprise = _chi_square(nominal, a, b, c, nu[0], nu[1])
    state.share = 2.0 * nominal / (a + c + 2.0 * nominal)
    _tell_noise(state, nominal, a, b, c)
    taught = PH
    if bounded and state.surprise > OUTLIER and _is_no_impedance(state, PH, nominal, a, b, c):
        taught = _of_known_impedance(state.P, PH)
        a, b, c = _predicted(H, taught)
    odd0, odd1 = nu[0] - changed_by[0], nu[1] - changed_by[1]
    if _chi_square(nominal, a, b, c, odd0, odd1) > _chi_square(nominal, a, b, c, nu[0], nu[1]):
        odd0, odd1 = nu[0], nu[1]
    R = _bounded_noise(nominal, a, b, c, odd0, odd1)
    determinant = (a + R) * (c + R) - b * b
    Si[0, 0], Si[1, 1] = (c + R) / determinant, (a + R) / determinant
    Si[0, 1] = Si[1, 0] = -b / determinant
    state.log_likelihood = -0.5 * (_chi_square(R, a, b, c, nu[0], nu[1]) + np.log(determinant))
    for i in range(STATES):
        K[i, 0] = taught[i, 0] * Si[0, 0] + taught[i, 1] * Si[1, 0]
        K[i, 1] = taught[i, 0] * Si[0, 1] + taught[i, 1] * Si[1, 1]
        if not bounded and 4 <= i < 6 and state.records > START:
            K[i, 0] = K[i, 1] = 0.0
        x[i] += K[i, 0] * nu[0] + K[i, 1] * nu[1]
    _reduce(state.P, PH, H, K, R)


@compiled
def _predicted(H: Array, PH: Array) -> tuple[float, float, float]:
    """Return the elements 00, 01, 11 of H P H'."""
    a = b = c = 0.0
    for j in range(STATES):
        a += H[0, j] * PH[j, 0]
        b += H[0, j] * PH[j, 1]
        c += H[1, j] * PH[j, 1]
    return a, b, c


@compiled
def _is_no_impedance(state: FilterState, PH: Array, R: float, a: float, b: float, c: float) -> bool:
    """Return whether the error of Z2 that would explain a record is larger than a file's can be.

    On a supply whose V2/V1 is constant nothing tells Z2 from E. A step of the currents alone, as of shorted
    turns, then looks like Z2 = 0, and one of the voltages alone like a Z2 without bounds.
    """
    nu = state.nu
    determinant = (a + R) * (c + R) - b * b
    u = ((c + R) * nu[0] - b * nu[1]) / determinant
    v = ((a + R) * nu[1] - b * nu[0]) / determinant
    r, x = state.x[4] + PH[4, 0] * u + PH[4, 1] * v, state.x[5] + PH[5, 0] * u + PH[5, 1] * v
    found = complex(r, x) / state.nominal
    return abs(found) > MOST_Z * abs(1.0 - state.balance * found)


@compiled
def _of_known_impedance(P: Array, PH: Array) -> Array:
    """Return P H' of a filter to which Z2 is known: a record then teaches nothing of it."""
    p, q, s = P[4, 4], P[4, 5], P[5, 5]
    determinant = p * s - q * q
    out = PH.copy()
    for r in range(2):
        u = (s * PH[4, r] - q * PH[5, r]) / determinant
        v = (p * PH[5, r] - q * PH[4, r]) / determinant
        for i in range(STATES):
            out[i, r] -= P[i, 4] * u + P[i, 5] * v
        out[4, r] = out[5, r] = 0.0
    return out


@compiled
def learn_noise(state: FilterState) -> None:
    """Let the innovation of the latest record teach the variance of the noise.

    Parameters
    ----------
    state : FilterState
        The filter, after `update`.
    """
    if state.share > LEAST_SHARE:
        state.noise_known = min(state.noise_known + state.noise_information, MOST_KNOWN)
        state.s2 *= 1.0 + state.noise_score / state.noise_known


@compiled
def _tell_noise(state: FilterState, R: float, a: float, b: float, c: float) -> None:
    """Leave slope and curvature of the log-likelihood over ln R in the state; S = [[a + R, b], [b, c + R]].

    One record of nothing but noise has a curvature of 1. Of an outlier, the slope is that at a usual one.
    """
    nu = state.nu
    p, q = a + R, c + R
    determinant = p * q - b * b
    u = (q * nu[0] - b * nu[1]) / determinant
    v = (p * nu[1] - b * nu[0]) / determinant
    usual = 2.0 / LEARNING_MEAN * min(1.0, LEARNING_CLIP / max(state.surprise, TINY))
    state.noise_score = 0.5 * R * (usual * (u * u + v * v) - (p + q) / determinant)
    state.noise_information = 0.5 * R * R * (p * p + q * q + 2.0 * b * b) / (determinant * determinant)


@compiled
def rows(j1: complex, j2: complex, H: Array) -> None:
    """Fill H, whose rows are the real and the imaginary part of y.

    Parameters
    ----------
    j1, j2 : complex
        The record.
    H : ndarray, shape (2, 7)
        Filled.
    """
    H[0, 0], H[0, 1], H[1, 0], H[1, 1] = 1.0, 0.0, 0.0, 1.0
    H[0, 2], H[0, 3], H[1, 2], H[1, 3] = j1.real, -j1.imag, j1.imag, j1.real
    H[0, 4], H[0, 5], H[1, 4], H[1, 5] = j2.real, -j2.imag, j2.imag, j2.real
    H[0, 6], H[1, 6] = j2.real, j2.imag


@compiled
def _times_transposed(P: Array, H: Array, out: Array) -> None:
    """Compute P H'."""
    for i in range(STATES):
        for r in range(2):
            total = 0.0
            for j in range(STATES):
                total += P[i, j] * H[r, j]
            out[i, r] = total


@compiled
def _reduce(P: Array, PH: Array, H: Array, K: Array, R: float) -> None:
    """Joseph's form, (I - K H) P (I - K H)' + K R K': P stays symmetric and positive for ever."""
    A, AH = np.zeros((STATES, STATES)), np.zeros((STATES, 2))
    for i in range(STATES):
        for j in range(STATES):
            A[i, j] = P[i, j] - K[i, 0] * PH[j, 0] - K[i, 1] * PH[j, 1]
    _times_transposed(A, H, AH)
    for i in range(STATES):
        for j in range(i, STATES):
            value = A[i, j] - AH[i, 0] * K[j, 0] - AH[i, 1] * K[j, 1]
            value += R * (K[i, 0] * K[j, 0] + K[i, 1] * K[j, 1])
            P[i, j] = P[j, i] = value


@compiled
def _bounded_noise(R: float, a: float, b: float, c: float, nu0: float, nu1: float) -> float:
    """Return R, or as much more as makes the record no outlier; H P H' = [[a, b], [b, c]]."""
    if _chi_square(R, a, b, c, nu0, nu1) <= OUTLIER:
        return R
    low, high = R, R + (nu0 * nu0 + nu1 * nu1) / OUTLIER
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if _chi_square(middle, a, b, c, nu0, nu1) > OUTLIER:
            low = middle
        else:
            high = middle
    return high


@compiled
def _chi_square(R: float, a: float, b: float, c: float, nu0: float, nu1: float) -> float:
    """Return nu' S^-1 nu with S = [[a + R, b], [b, c + R]]."""
    p, q = a + R, c + R
    return (nu0 * nu0 * q - 2.0 * nu0 * nu1 * b + nu1 * nu1 * p) / (p * q - b * b)
