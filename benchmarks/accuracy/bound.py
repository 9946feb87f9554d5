"""The Cramér-Rao bound: how well any unbiased estimator could do on records with white noise.

From the derivatives of an independent model's currents (accuracy_phasors), taken numerically. A record of
n samples over whole cycles, channel k with the rms phasor X_k and noise of standard deviation sigma_k, holds
the information F = n sum over k of Re(conj(dX_k) dX_k') / sigma_k^2 on the unknowns.
"""

from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from testing.machines.steady_faults import Condition, FaultModel, steady

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
STEP = 1e-5
"""Of the difference quotients; levels, loads and relative voltages are all of order 1."""


@dataclass(frozen=True, slots=True)
class Bound:
    """What a record can tell of mu_f.

    standard_deviation: of mu_f, the bound.  weights: phasors of the six channels, shape (6,), by which the
    noise enters the efficient estimator's error to first order.
    """

    standard_deviation: float
    weights: Complex
    frequency_hz: float
    sample_rate_hz: float

    def first_order_error(self, noise: Array) -> float:
        """Error of mu_f the efficient estimator would make with this noise, shape (6, n)."""
        turned = sqrt(2.0) * np.exp(
            -2j * pi * self.frequency_hz / self.sample_rate_hz * np.arange(noise.shape[1])
        )
        return float((self.weights.conj() * (noise @ turned)).real.sum())


def bound(
    motor: Motor,
    model: FaultModel,
    condition: Condition,
    *,
    noise: Array,
    samples: int,
    sample_rate_hz: float,
) -> Bound:
    """The bound with mu_f, LL and T_d unknown.

    noise: standard deviation on each of IA IB IC VA VB VC, shape (6,). Where it is zero on the voltages
    they are known; else both of their sequences are unknown beside the rest.
    """
    w = motor.nameplate.rated_angular_frequency
    voltages_known = not noise[3:].any()

    def phasors(level: float, load: float, v1: complex, v2: complex) -> Complex:
        moved = replace(
            condition,
            level=level,
            load_level=load,
            relative_voltage=condition.relative_voltage + v1,
            unbalance=(condition.unbalance + v2) / (1.0 + v1),
        )
        operation = steady(motor, model, moved)
        return np.concatenate([operation.line_current, operation.phase_voltage])

    level, load = condition.level, condition.load_level

    def slope(d_level: float = 0.0, d_load: float = 0.0, v1: complex = 0.0, v2: complex = 0.0) -> Complex:
        up = phasors(level + STEP * d_level, load + STEP * d_load, STEP * v1, STEP * v2)
        down = phasors(level - STEP * d_level, load - STEP * d_load, -STEP * v1, -STEP * v2)
        return np.asarray((up - down) / (2.0 * STEP))

    delay = -1j * w * phasors(level, load, 0.0, 0.0)
    delay[3:] = 0.0
    columns = [slope(d_level=1.0), slope(d_load=1.0), delay]
    if not voltages_known:
        columns += [slope(v1=1.0), slope(v1=1j), slope(v2=1.0), slope(v2=1j)]
    counted = slice(0, 3) if voltages_known else slice(0, 6)
    scaled = np.zeros((6, len(columns)), dtype=np.complex128)
    scaled[counted] = np.stack(columns, axis=1)[counted] / noise[counted, np.newaxis]
    covariance = np.linalg.inv(samples * (scaled.conj().T @ scaled).real)
    weights = np.zeros(6, dtype=np.complex128)
    weights[counted] = (scaled @ covariance[0])[counted] / noise[counted]
    return Bound(float(np.sqrt(covariance[0, 0])), weights, w / (2.0 * pi), sample_rate_hz)
