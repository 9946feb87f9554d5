"""A load that swings: the strongest line of its torque.

Strokes of a compressor, a belt or a gear make the torque swing at frequencies of their own. What stands once
a turn is told by `core.rotor.eccentricity`, and near twice the slip of a rotor that is not even by
`core.rotor.asymmetry`: both know what else swings there. The line is looked for in the torque that crosses
the air gap, where a wrong inertia does no harm; its meaning for the load follows from `core.rotor.ripples`,
with the inertia of the motor's file.
"""

from math import hypot, log, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Motor
from core.normal_distribution import NINE_IN_TEN
from core.rotor.baseband import Baseband
from core.rotor.ripples import ripples
from core.rotor.running_point import RunningPoint, errors, running_point
from core.rotor.sidebands import fit_lines
from core.rotor.swing_findings import NOISE_RMS, PulsationFinding

FEWEST_TURNS = 4.0
"""Least cycles of a swing over the record: what is slower is a load that changes."""
HIGHEST_OVER_SUPPLY = 0.6
"""Highest swing over the supply's frequency; near 1 the means over a cycle leave nothing."""
AROUND_TWICE_SLIP = (0.7, 1.5)
"""Places about twice the slip that are left out where the rotor may be uneven, over it."""
AROUND_A_TURN = 0.05
"""The same about once a turn, over it, to either side."""
FINER = 4
"""Fineness of the search over the resolution of the record."""


def examine_pulsation(baseband: Baseband, motor: Motor, *, even_rotor: bool) -> PulsationFinding:
    """Find the strongest swing of the load's torque in one record.

    Parameters
    ----------
    baseband : Baseband
        Steady running, currents in step with the voltages.
    motor : Motor
        Nameplate and parameters of the motor.
    even_rotor : bool
        Whether the rotor is known to be even: then all that swings at twice the slip is the load's.

    Returns
    -------
    PulsationFinding
        The swing with its noise.
    """
    point = running_point(baseband, motor)
    hertz, torque = _torque_spectrum(baseband, motor)
    looked_at = _elsewhere(hertz, baseband, point, motor)
    if not even_rotor:
        looked_at &= _beside_twice_slip(hertz, baseband, point, motor)
    if not looked_at.any():
        return PulsationFinding.untold("the record is too short to show a load that swings")
    strongest = int(np.argmax(np.where(looked_at, torque, 0.0)))
    found_hz = _peak_hz(hertz, torque, strongest)
    line = fit_lines(baseband, 2.0 * pi * baseband.time_s, np.array([found_hz]))
    distance = np.array([2.0 * pi * found_hz])
    found = complex(ripples(line, distance, point, motor, even_gap=True).load_torque[0])
    swing = abs(found)
    noise = sqrt(float(np.median(torque[looked_at] ** 2)) / log(2.0))
    # What inertia takes of a swing it takes of the noise beside it as well.
    noise *= max(1.0, swing / float(torque[strongest]))
    wrong = 0.0
    for other, record, deviations in errors(baseband, motor):
        told = ripples(line, distance, running_point(record, other), other, even_gap=True).load_torque[0]
        wrong = hypot(wrong, deviations * abs(complex(told) - found))
    by_noise = noise / sqrt(2.0)
    return PulsationFinding(
        swing,
        noise,
        found_hz,
        load_torque_deviation=hypot(by_noise, wrong),
        detection_limit=NOISE_RMS * noise + NINE_IN_TEN * by_noise,
        reasons=(),
    )


def _torque_spectrum(baseband: Baseband, motor: Motor) -> tuple[Array, Array]:
    """Return frequencies [Hz] and amplitudes of the air gap's torque over the rated one, Hann-weighed."""
    current = baseband.current
    across = baseband.voltage - motor.parameters.stator_resistance_ohm * current
    power = (across * current.conj()).real
    torque = motor.nameplate.pole_pairs * power / baseband.angular_frequency
    torque /= motor.nameplate.rated_torque_Nm
    time = np.linspace(-1.0, 1.0, torque.size)
    torque -= np.polynomial.legendre.legval(time, np.polynomial.legendre.legfit(time, torque, 3))
    weight = np.hanning(torque.size + 2)[1:-1]
    size = FINER * torque.size
    lines = 2.0 * np.abs(np.fft.rfft(torque * weight, size)) / weight.sum()
    step_s = float(baseband.time_s[1] - baseband.time_s[0])
    hertz: Array = np.fft.rfftfreq(size, step_s).astype(np.float64)
    gain = np.maximum(baseband.gain(hertz), 1e-3)
    return hertz, np.asarray(lines / gain)


def _peak_hz(hertz: Array, torque: Array, strongest: int) -> float:
    """Return where a parabola through the logarithms about the strongest line has its peak [Hz].

    Half a step off, a line fitted to the record would lose 3 % of its amplitude.
    """
    if not 0 < strongest < torque.size - 1:
        return float(hertz[strongest])
    before, here, after = np.log(np.maximum(torque[strongest - 1 : strongest + 2], np.finfo(float).tiny))
    bend = before - 2.0 * here + after
    offset = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    step_hz = float(hertz[1] - hertz[0])
    return float(hertz[strongest]) + step_hz * float(np.clip(offset, -0.5, 0.5))


def _elsewhere(hertz: Array, baseband: Baseband, point: RunningPoint, motor: Motor) -> NDArray[np.bool_]:
    """Return at which frequencies a swing may be told, but not once a turn, shape (n,)."""
    supply_hz = point.angular_frequency / (2.0 * pi)
    turn_hz = (1.0 - point.slip(motor)) * supply_hz / motor.nameplate.pole_pairs
    looked_at = (hertz > FEWEST_TURNS / baseband.span_s) & (hertz < HIGHEST_OVER_SUPPLY * supply_hz)
    return np.asarray(looked_at & (np.abs(hertz - turn_hz) > AROUND_A_TURN * turn_hz + 2.0 / baseband.span_s))


def _beside_twice_slip(
    hertz: Array, baseband: Baseband, point: RunningPoint, motor: Motor
) -> NDArray[np.bool_]:
    """Return which frequencies are away from twice the slip, shape (n,)."""
    twice_slip_hz = point.slip(motor) * point.angular_frequency / pi
    low, high = (share * twice_slip_hz for share in AROUND_TWICE_SLIP)
    resolution_hz = 2.0 / baseband.span_s
    return np.asarray((hertz < low - resolution_hz) | (hertz > high + resolution_hz))
