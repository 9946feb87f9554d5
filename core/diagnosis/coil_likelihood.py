"""How well shorted turns of every phase, axis, leakage and level fit a record: the evidence's inner loop.

The residual is that of I1/V1 and I2/V1, each dimensionless, what the zero sequences tell of the channels
taken off and whitened by the covariance of all errors (`core.diagnosis.record_errors`). Slip and offset are
unknowns of every point: Gauss and Newton find their likeliest, Laplace's method integrates over them:

    ln L = -Q / 2 - ln det(H) / 2,    Q = min (r' r + priors),    H half of its curvature
"""

from cmath import exp as cexp
from math import exp, log, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.priors import GENERATING, LONG_OFFSET_S, LONG_OFFSETS, OFFSET_S
from core.machines.base import Array
from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents
from core.machines.compiled import compiled_as_written as compiled
from core.machines.steady_state import ComplexArray

SLIP_STEP = 1e-6
MOST_ROUNDS = 8
NEGLIGIBLE = 0.05
"""Fall of the misfit that another round promises, below which it is not made."""
LONGEST_STEP = 0.7
"""Longest step of the slip, in rated slips: the current's locus is a circle."""

NOTHING = -1e300
TURN = 6.283185307179586
SLOPE_EVERY = 4
"""Levels of which one has its slopes by slip computed."""
USUAL_DENSITY = (1.0 - LONG_OFFSETS) / OFFSET_S
LONG_DENSITY = LONG_OFFSETS / LONG_OFFSET_S


class MachineNumbers(NamedTuple):
    """Parameters of a machine, for compiled functions.

    Parameters
    ----------
    R_s, R_r, L_ls, L_lr, L_m : float
        Resistances [ohm] and inductances [H] of a winding, referred to the stator.
    circulating : float
        Share of the stator's impedance that a fault's zero sequence sees: 0 in star, 1/3 in delta.
    shared : float
        Share of that impedance that shorted turns have in common with their phase: 1, or 0 of the thesis's
        additional winding.
    resistance_ratio, leakage_share : float
        Rotor's resistance and leakage as the negative sequence sees them, over R_r and L_lr.
    """

    R_s: float
    R_r: float
    L_ls: float
    L_lr: float
    L_m: float
    circulating: float
    shared: float
    resistance_ratio: float
    leakage_share: float


class ShortedTurns(NamedTuple):
    """Shorted turns in one coil.

    Parameters
    ----------
    level : float
        Equivalent level m; zero is a healthy machine.
    leakage : float
        psi.
    ahead : complex
        exp(j delta) / k_d.
    winding : int
        0, 1 or 2 in the frame of the windings.
    """

    level: float
    leakage: float
    ahead: complex
    winding: int


class ComparedRecord(NamedTuple):
    """What of a record is compared, and how it is weighed.

    Parameters
    ----------
    angular_frequency : float
        w_s [rad/s].
    admittance, negative_current, negative_voltage : complex
        I1/V1 and I2/V1 [S], V2/V1.
    admittance_scale, negative_scale : float
        Factors that make residuals of I1/V1 and I2/V1 dimensionless [ohm].
    whitening : ndarray, shape (4, 4)
        Whitens the residual.
    expected : ndarray, shape (4,)
        What the zero sequences make expect of the residual.
    rated_slip, lowest_slip, highest_slip : float
        Slip at rated load, and the range that is searched.
    """

    angular_frequency: float
    admittance: complex
    negative_current: complex
    negative_voltage: complex
    admittance_scale: float
    negative_scale: float
    whitening: Array
    expected: Array
    rated_slip: float
    lowest_slip: float
    highest_slip: float


class Weighed(NamedTuple):
    """What the points of a grid are worth; arrays of shape (axes, leakages, levels).

    Parameters
    ----------
    log_likelihood : ndarray
        Log of the likelihood, slip and offset integrated over.
    slip, offset_s : ndarray
        Their likeliest values [1, s].
    """

    log_likelihood: Array
    slip: Array
    offset_s: Array


@compiled
def _gap(machine: MachineNumbers, z: complex, w: float, slip: float) -> AirGap:
    resistance, leakage = machine.resistance_ratio, machine.leakage_share
    return air_gap(z, w * machine.L_m, machine.R_r, w * machine.L_lr, slip, resistance, leakage)


@compiled
def ratios(
    machine: MachineNumbers, turns: ShortedTurns, w: float, negative_voltage: complex, slip: float
) -> SequencePair:
    """Return I1/V1 and I2/V1 of a machine."""
    z = complex(machine.R_s, w * machine.L_ls)
    gap = air_gap(
        z,
        w * machine.L_m,
        machine.R_r,
        w * machine.L_lr,
        slip,
        machine.resistance_ratio,
        machine.leakage_share,
    )
    if turns.level <= 0.0:
        return SequencePair(1.0 / (z + gap.forward), negative_voltage / (z + gap.backward))
    own = turns.leakage if machine.shared > 0.0 else turns.level
    branch = complex(machine.R_s, own * w * machine.L_ls) / turns.level
    voltage = SequencePair(1.0 + 0.0j, negative_voltage)
    behind = turns.ahead.conjugate()
    return faulty_currents(
        gap, voltage, branch, turns.ahead, behind, machine.circulating, turns.winding, machine.shared
    )


@compiled
def air_gap_torque(
    machine: MachineNumbers, turns: ShortedTurns, w: float, negative_voltage: complex, slip: float
) -> float:
    """Return the torque of a machine: T w / p over |V1|^2 of the space vector's forward phasor [S]."""
    z = complex(machine.R_s, w * machine.L_ls)
    gap = air_gap(
        z,
        w * machine.L_m,
        machine.R_r,
        w * machine.L_lr,
        slip,
        machine.resistance_ratio,
        machine.leakage_share,
    )
    currents = ratios(machine, turns, w, negative_voltage, slip)
    # What drives the field: the stator's current less that of the shorted turns, on their own axis.
    forward = (1.0 - z * currents.positive) / gap.forward
    backward = (negative_voltage - z * currents.negative) / gap.backward
    if turns.level > 0.0:
        forward, backward = _field_currents(gap, currents, turns, machine.shared)
    return (abs(forward) ** 2) * gap.forward.real - (abs(backward) ** 2) * gap.backward.real


@compiled
def _field_currents(
    gap: AirGap, currents: SequencePair, turns: ShortedTurns, shared: float
) -> tuple[complex, complex]:
    """Return the currents of the field: I1 = (V1 + (z + A1 e+) j/3)/Z1 gives j, and the field I1 - e+ j/3."""
    z, A1, _ = gap
    forward = (currents.positive * (z + A1) - 1.0) / (shared * z + A1 * turns.ahead)  # j a^x / 3
    turn = cexp(2j * 3.141592653589793 / 3.0 * turns.winding)
    backward = forward * turn.conjugate() * turn.conjugate()
    return currents.positive - turns.ahead * forward, currents.negative - turns.ahead.conjugate() * backward


@compiled
def offset_prior(offset_s: float) -> tuple[float, float, float]:
    """Return what is known of the offset between a relay's currents and voltages.

    That is minus twice the log of its density over the greatest, the row of a least-squares fit whose square
    has the slope of that, and the row's own slope [1/s].
    """
    usual = USUAL_DENSITY * exp(-0.5 * (offset_s / OFFSET_S) ** 2)
    long = LONG_DENSITY * exp(-0.5 * (offset_s / LONG_OFFSET_S) ** 2)
    density = max(usual + long, 1e-300)
    slope = sqrt(usual / OFFSET_S**2 + long / LONG_OFFSET_S**2) / sqrt(density)
    return 2.0 * (log(USUAL_DENSITY + LONG_DENSITY) - log(density)), slope * offset_s, slope


@compiled
def residual(
    record: ComparedRecord, machine: MachineNumbers, turns: ShortedTurns, slip: float, turn: complex,
    raw: Array, out: Array,
) -> None:  # fmt: skip
    """Fill the whitened residual of one hypothesis."""
    found = ratios(machine, turns, record.angular_frequency, record.negative_voltage, slip)
    first = (record.admittance * turn - found.positive) * record.admittance_scale
    second = (record.negative_current * turn - found.negative) * record.negative_scale
    raw[0], raw[1], raw[2], raw[3] = first.real, first.imag, second.real, second.imag
    for k in range(4):
        raw[k] -= record.expected[k]
    _whiten(record.whitening, raw, out)


@compiled
def _whiten(whitening: Array, raw: Array, out: Array) -> None:
    for k in range(4):
        total = 0.0
        for n in range(k + 1):  # the inverse of Cholesky's factor is lower triangular
            total += whitening[k, n] * raw[n]
        out[k] = total


@compiled
def fit(
    record: ComparedRecord, machine: MachineNumbers, turns: ShortedTurns, slip: float, offset_s: float,
    work: Array, has_slope: bool = False,
) -> tuple[float, float, float]:  # fmt: skip
    """Return the log of the likelihood of one hypothesis, and its likeliest slip and offset [s].

    `work` is of shape (5, 4). Its last row keeps the slopes by slip; with `has_slope` they are those of a
    neighbouring hypothesis, which are good enough to begin with.
    """
    w = record.angular_frequency
    raw, here, ahead, by_offset, by_slip = work[0], work[1], work[2], work[3], work[4]
    misfit, logdet = 0.0, 0.0
    longest = LONGEST_STEP * record.rated_slip
    for k in range(MOST_ROUNDS):
        turn = cexp(1j * w * offset_s)
        residual(record, machine, turns, slip, turn, raw, here)
        if k > 1 or not has_slope:
            residual(record, machine, turns, slip + SLIP_STEP, turn, raw, ahead)
            for n in range(4):
                by_slip[n] = (ahead[n] - here[n]) / SLIP_STEP
        first = 1j * w * record.admittance * turn * record.admittance_scale
        second = 1j * w * record.negative_current * turn * record.negative_scale
        raw[0], raw[1], raw[2], raw[3] = first.real, first.imag, second.real, second.imag
        _whiten(record.whitening, raw, by_offset)
        prior, row, slope = offset_prior(offset_s)
        # A motor drives; how far a load may come out below zero is in rated loads.
        brake = 1.0 / (GENERATING * record.rated_slip) if slip < 0.0 else 0.0
        misfit = prior + (brake * slip) ** 2
        a, b, c = brake**2, 0.0, slope**2
        g0, g1 = brake**2 * slip, slope * row
        for n in range(4):
            misfit += here[n] ** 2
            a += by_slip[n] ** 2
            b += by_slip[n] * by_offset[n]
            c += by_offset[n] ** 2
            g0 += by_slip[n] * here[n]
            g1 += by_offset[n] * here[n]
        determinant = a * c - b * b
        if not determinant > 0.0:
            return NOTHING, slip, offset_s
        # Both unknowns in their own units: rated slips, and usual offsets.
        logdet = log(determinant) + 2.0 * log(record.rated_slip * OFFSET_S)
        step = -(c * g0 - b * g1) / determinant
        late = -(a * g1 - b * g0) / determinant
        promised = -(g0 * step + g1 * late)
        if promised < NEGLIGIBLE:
            misfit -= promised
            slip += step
            offset_s += late
            break
        shorter = min(1.0, longest / max(abs(step), 1e-30))
        slip = min(max(slip + shorter * step, record.lowest_slip), record.highest_slip)
        # An offset is known but for whole cycles.
        offset_s -= round((offset_s + shorter * late) * w / TURN) * TURN / w - shorter * late
    return -0.5 * (misfit + logdet), slip, offset_s


@compiled
def weigh_turns(
    record: ComparedRecord, machine: MachineNumbers, levels: Array, leakages: Array, axes: ComplexArray,
    possible: NDArray[np.bool_], winding: int, slip: float, offset_s: float, out: Weighed,
) -> None:  # fmt: skip
    """Weigh shorted turns of one phase at every axis, leakage and level, in ascending order.

    Axes are exp(j delta) / k_d; `possible` (axes, leakages) says which are looked at.
    """
    work = np.empty((5, 4))
    for a in range(axes.size):
        for p in range(leakages.size):
            s, T = slip, offset_s
            out.log_likelihood[a, p], out.slip[a, p], out.offset_s[a, p] = NOTHING, s, T
            if not possible[a, p]:
                continue
            for k in range(levels.size):
                turns = ShortedTurns(levels[k], leakages[p], axes[a], winding)
                # The slopes change little from one level to the next.
                found, s, T = fit(record, machine, turns, s, T, work, k % SLOPE_EVERY > 0)
                out.log_likelihood[a, p, k], out.slip[a, p, k], out.offset_s[a, p, k] = found, s, T
