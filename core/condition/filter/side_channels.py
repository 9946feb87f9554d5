"""Side channels: what shows an error of a voltage or a current channel, and no shorted turns.

Each is z_k = level + slope w_k + noise, complex. V0/V1 follows v2 (w = v2), as an unbalanced supply has a
zero sequence too; I0/I1 follows I2/I1; v2 itself follows nothing; and v2 less that of the bus follows v2.
The level wanders with variance q; q and the noise's variance r are learnt from the differences D of
neighbouring records: E|D_k|^2 = q + 2 r, E Re(D_k conj D_(k-1)) = -r.
"""

import numpy as np

from core.condition.filter.state import BUS, I0, V0, V2, SideState
from core.condition.measuring.measurement import Measurement
from core.machines.compiled import compiled_as_written as compiled

FIRST_SPREAD = 0.1
"""Standard deviation of a level before the first record."""
FIRST_SLOPES = (0.5, 0.02, 0.0, 0.02)
"""The same of the slopes of V0, I0, v2 and the bus difference: a zero sequence of the supply may be as
large as V2, but what makes I0 follow I2 is errors of the channels."""
FIRST_NOISE = 1e-3**2
"""Variance of the noise to start from."""
FIRST_COUNT = 4.0
"""Number of records that it counts for."""
SLOWEST = 0.01
CLIP = 3.0
"""Differences beyond so many of their root mean square count as many: jumps teach little."""
LEAST_NOISE_SHARE, LEAST_WANDER = 0.02, 1e-5**2
OUTLIER = 9.0
"""Largest squared innovation over its variance: a record counts 9 nats at most."""
USUAL_CURRENT = 0.15
"""|j1| at which the noise of I0/I1 counts as it is; of a smaller current it is a larger share."""


@compiled
def begin(side: SideState, kind: int) -> None:
    """Forget a side channel.

    Parameters
    ----------
    side : SideState
        The side channel.
    kind : int
        V0, I0, V2 or BUS.
    """
    side.x[0] = side.x[1] = 0.0
    side.P[0, 0], side.P[1, 1] = FIRST_SPREAD**2, FIRST_SLOPES[kind] ** 2
    side.P[0, 1] = side.P[1, 0] = 0.0
    side.records, side.S = 0.0, 0.0
    side.square, side.product = 2.0 * FIRST_NOISE, -FIRST_NOISE
    side.q, side.r = LEAST_WANDER, FIRST_NOISE
    side.before = side.difference = 0.0


@compiled
def fold_side(side: SideState, kind: int, record: Measurement) -> None:
    """Take one record into a side channel; leave gain, innovation and its variance in it.

    Parameters
    ----------
    side : SideState
        The side channel.
    kind : int
        V0, I0, V2 or BUS.
    record : Measurement
        The record.
    """
    side.S = 0.0
    spread = 1.0
    if kind == V0:
        if not record.has_v0:
            return
        z, w = record.v0, record.v2
    elif kind == I0:
        z, w = record.i0, record.i2
        spread = USUAL_CURRENT**2 / (record.j1.real**2 + record.j1.imag**2)
    elif kind == V2:
        z, w = record.v2, 0.0j
    else:
        if not record.has_bus:
            return
        z, w = record.bus, record.v2
    x, P, K = side.x, side.P, side.K
    P[0, 0] += side.q
    side.regressor = w
    side.nu = z - x[0] - w * x[1]
    # P H^H with H = (1, w)
    a = P[0, 0] + P[0, 1] * w.conjugate()
    b = P[1, 0] + P[1, 1] * w.conjugate()
    predicted = (a + w * b).real
    square = side.nu.real**2 + side.nu.imag**2
    S = max(predicted + side.r * spread, square / OUTLIER)
    side.S = S
    K[0], K[1] = a / S, b / S
    x[0] += K[0] * side.nu
    x[1] += K[1] * side.nu
    P00 = (P[0, 0] - K[0] * a.conjugate()).real
    P11 = (P[1, 1] - K[1] * b.conjugate()).real
    P01 = P[0, 1] - K[0] * b.conjugate()
    P[0, 0], P[1, 1], P[0, 1], P[1, 0] = max(P00, 0.0), max(P11, 0.0), P01, P01.conjugate()
    _learn(side, z - x[1] * w, spread)


@compiled
def noise_share_of_currents(V0_side: SideState, I0_side: SideState, s2: float) -> float:
    """Return the share of y's noise that the currents make.

    I0 has little but the currents' noise, as large in j2, and V0 that of the voltages beside what wanders.

    Parameters
    ----------
    V0_side, I0_side : SideState
        The side channels V0/V1 and I0/I1.
    s2 : float
        Variance of y's noise, which tells that of the voltages where V0 is not measured.

    Returns
    -------
    float
        Share, 0 to 1.
    """
    currents = 0.5 * I0_side.square * USUAL_CURRENT**2
    voltages = V0_side.r if V0_side.S > 0.0 else max(s2 - currents, 0.0)
    return currents / (currents + voltages)


@compiled
def _learn(side: SideState, value: complex, spread: float) -> None:
    """Learn q and r from the difference to the record before."""
    if side.records > 0.0:
        difference = (value - side.before) / np.sqrt(spread)
        size = np.sqrt(difference.real**2 + difference.imag**2)
        limit = CLIP * np.sqrt(side.square)
        if size > limit:
            difference *= limit / size
            size = limit
        gain = max(1.0 / (side.records + FIRST_COUNT), SLOWEST)
        side.square += gain * (size * size - side.square)
        if side.records > 1.0:
            product = (difference * side.difference.conjugate()).real
            side.product += gain * (product - side.product)
        side.difference = difference
        side.r = max(-side.product, LEAST_NOISE_SHARE * side.square)
        side.q = max(side.square - 2.0 * side.r, LEAST_WANDER)
    side.before = value
    side.records += 1.0


__all__ = ["BUS", "I0", "V0", "V2", "begin", "fold_side"]
