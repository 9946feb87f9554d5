"""The rotor's asymmetry from a start: the lower sideband's path, which needs no load.

An asymmetry of the rotor's resistance turns with the rotor and throws its current back. The stator sees that
at (1 - 2s) f: at -f when the motor is switched on, at 0 at half speed, at +f in the end. The model's slip
tells this path, and the model what an asymmetry of one would draw along it:

    e = -(R_r - j s w L_lr) conj(i_r) exp(j 2 theta)         i_s = H(s) e,   theta the rotor's angle

Each stretch of a few cycles is a joint least squares of supply (both sequences, with drift), direct current
and this path. Stretches are combined without their phases, for the slip is not known so well that the
rotor's angle is right over a whole start. Paths beside the right one, in what is left, tell the noise.
"""

from math import log10, pi, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.machines.air_gap import UNSETTLED_CYCLES, AirGap, positive_sequence
from core.machines.base import Array
from core.machines.parameters import MachineParameters
from core.normal_distribution import NORMAL_95
from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband

Complex = NDArray[np.complex128]

STRETCH_CYCLES: Final = 4
PATH_SLIPS: Final = (0.08, 0.4)
"""Slips between which the path keeps away from the supply's frequency, and the model holds.

Above a slip of a half a broken bar makes more than the model says: the field of its neighbours has other
numbers of poles, too.
"""
BESIDE: Final = (-3.5, -3.0, -2.5, -2.0, 2.0, 2.5, 3.0, 3.5)
"""Paths beside the right one: frequencies off, over one by the length of a stretch."""
FEWEST_STRETCHES: Final = 4
ABOVE_NOISE: Final = 3.0
"""Power of the path over that of the strongest one beside it from which on an asymmetry is seen."""
OVERLAPPING: Final = 0.25
"""Stretches that count, of those there are: each one shares three quarters of its samples with the next."""
READS_HIGH_dB: Final = 10.0
READS_LOW_dB: Final = 3.0
"""By so much the model may scale the asymmetry wrong, at 95 % [dB]: a bar that is broken changes the leakage
of a cage more than its resistance, and how much, no nameplate tells."""
FAULT_dB: Final = -38.0
"""Asymmetry above which the cage counts as faulty; cages without a fault have some 10 dB less."""
BAR_dB: Final = -29.0
"""Asymmetry of one broken bar of 28. A start that would not show it tells of no healthy cage."""


def start_sideband(gap: AirGap, machine: MachineParameters, run_up_s: float) -> StartSideband:
    """Follow the lower sideband through a start.

    Parameters
    ----------
    gap : AirGap
        Torque and slip of the start.
    machine : MachineParameters
        Parameters of the motor.
    run_up_s : float
        Length of the run-up, or of as much of it as the record has [s].

    Returns
    -------
    StartSideband
        What the start tells of the cage.
    """
    end = min(gap.slip.size, round(run_up_s * gap.sample_rate_hz) + gap.cycle)
    slip = np.clip(gap.slip[:end], 0.0, 1.0)
    current, path = _path(gap, machine, slip)
    length = STRETCH_CYCLES * gap.cycle
    least, most = PATH_SLIPS
    fits = [
        _fit(current[k : k + length], path[k : k + length], gap)
        for k in range(UNSETTLED_CYCLES * gap.cycle, end - length + 1, length // 4)
        if least < slip[k : k + length].min() and slip[k : k + length].max() < most
    ]
    if len(fits) < FEWEST_STRETCHES:
        reason = f"the run-up is too short to follow the sideband: {len(fits)} stretches of "
        return _unsupported(len(fits), f"{reason}{FEWEST_STRETCHES} and more that are needed")
    explained, squares = (np.sum(one, axis=0) for one in zip(*fits, strict=True))
    power = explained / squares
    noise, strongest = float(power[1:].mean()), float(power[1:].max())
    limit_dB = 10.0 * log10(ABOVE_NOISE * strongest)
    asymmetry = max(float(power[0]) - noise, 0.0)
    scatter = (2.0 * asymmetry * noise + noise**2) / (OVERLAPPING * len(fits))
    error = NORMAL_95 * sqrt(scatter)
    is_seen = float(power[0]) >= ABOVE_NOISE * strongest
    low_dB = _decibels(asymmetry - error) if is_seen else None
    least_dB = None if low_dB is None else low_dB - READS_HIGH_dB
    state, reason = _judged(least_dB, _decibels(asymmetry), limit_dB)
    return StartSideband(
        state=state,
        severity_dB=_decibels(asymmetry),
        severity_dB_ci95=(least_dB, 10.0 * log10(asymmetry + error) + READS_LOW_dB),
        detection_limit_dB=limit_dB,
        stretches=len(fits),
        reasons=(reason,),
    )


def _judged(least_dB: float | None, severity_dB: float | None, limit_dB: float) -> tuple[RotorState, str]:
    """Return state and reason. least_dB: lower end of the interval, None where nothing is seen."""
    if least_dB is None or severity_dB is None:
        if limit_dB > BAR_dB:
            return RotorState.UNSUPPORTED, f"the start shows an asymmetry above {limit_dB:.0f} dB only"
        return RotorState.HEALTHY, f"no asymmetry of the rotor above {limit_dB:.0f} dB"
    told = f"an asymmetry of the rotor of {severity_dB:.0f} dB follows the slip through the start"
    if least_dB > FAULT_dB:
        return RotorState.FAULT, told
    if severity_dB > FAULT_dB:
        return RotorState.WATCH, f"{told}; its interval reaches below {FAULT_dB:.0f} dB"
    return RotorState.HEALTHY, f"{told}, as small as healthy rotors have it"


def _unsupported(stretches: int, reason: str) -> StartSideband:
    return StartSideband(RotorState.UNSUPPORTED, None, None, None, stretches, (reason,))


def _path(gap: AirGap, machine: MachineParameters, s: Array) -> tuple[Complex, Complex]:
    """Return the current, and what an asymmetry of one would add to it, both as space vectors [A]."""
    w, end = 2.0 * pi * gap.frequency_hz, s.size
    turn = np.exp(-1j * w / gap.sample_rate_hz * np.arange(end))
    i, v = (x[0, :end] + 1j * x[1, :end] for x in (gap.current_ab, gap.voltage_ab))
    theta = np.cumsum((1.0 - s) * w) / gap.sample_rate_hz
    R_s, R_r, L_m = (
        machine.stator_resistance_ohm,
        machine.rotor_resistance_ohm,
        machine.magnetising_inductance_H,
    )
    L_s, L_r = L_m + machine.stator_leakage_H, L_m + machine.rotor_leakage_H
    i_1, v_1 = (positive_sequence(x * turn, gap.cycle) for x in (i, v))
    i_r = ((v_1 - R_s * i_1) / (1j * w) - L_s * i_1) / L_m
    w_2 = (1.0 - 2.0 * s) * w
    # The stator is shorted by its supply at this frequency: i_s over i_r, and the rotor's impedance with it.
    share = -1j * w_2 * L_m / (R_s + 1j * w_2 * L_s)
    Z_r = R_r - 1j * s * w * (L_r + L_m * share)
    Z_bars = R_r - 1j * s * w * machine.rotor_leakage_H
    return i, -share * Z_bars / Z_r * np.conj(i_r) * np.exp(2j * theta) * turn


def _fit(current: Complex, path: Complex, gap: AirGap) -> tuple[Array, Array]:
    """Fit one stretch.

    Returns
    -------
    explained, squares : ndarray, shape (1 + beside,)
        Power that the path explains times its own, and its own: of the right path, and of those beside it in
        what the right one leaves, its drift within the stretch taken out too.
    """
    n = current.size
    window = np.hanning(n + 2)[1:-1]
    t = np.arange(n) / gap.sample_rate_hz
    ramp = np.linspace(-1.0, 1.0, n)
    turn, one = np.exp(2j * pi * gap.frequency_hz * t), np.ones(n)
    known = [turn, turn * ramp, turn * ramp**2, turn.conj(), turn.conj() * ramp, one, one * ramp]
    basis, _ = np.linalg.qr(np.stack(known, axis=1) * window[:, np.newaxis])

    def left(x: Complex) -> Complex:
        y: Complex = x * window
        return y - basis @ (basis.conj().T @ y)

    y, along = left(current), left(path)
    squares = [float(np.vdot(along, along).real)]
    explained = [abs(np.vdot(along, y)) ** 2 / squares[0]]
    drifting, _ = np.linalg.qr(np.stack([along, left(path * ramp)], axis=1))
    y = y - drifting @ (drifting.conj().T @ y)
    for cycles in BESIDE:
        beside = left(path * np.exp(2j * pi * cycles * t * gap.sample_rate_hz / n))
        squares.append(float(np.vdot(beside, beside).real))
        explained.append(abs(np.vdot(beside, y)) ** 2 / squares[-1])
    return np.array(explained), np.array(squares)


def _decibels(power: float) -> float | None:
    return 10.0 * log10(power) if power > 0.0 else None
