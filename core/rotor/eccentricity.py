"""Indicator of a rotor out of the middle of its bore: the ripple of the air gap's permeance, once a turn.

Static and dynamic eccentricity together, d_s and d_d as shares of the gap, make a ripple of about d_s d_d and
currents at f +- f_r. A load that swings once a turn makes lines at the same places; both are told apart by
`core.rotor.ripples`. An eccentricity that is only static, or only dynamic, makes no such lines. Around the
slots' lines more would show; they are not looked at, for few nameplates tell the number of slots.

Reference: Nandi, Toliyat and Li, doi:10.1109/TEC.2005.847955.
"""

from dataclasses import dataclass
from math import ceil, hypot, log, pi, sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.normal_distribution import NINE_IN_TEN, NORMAL_95
from core.rotor.baseband import Baseband
from core.rotor.finding import decibels
from core.rotor.ripples import Ripples, ripples
from core.rotor.running_point import RunningPoint, errors, running_point, slip_course
from core.rotor.sidebands import Lines, fit_lines
from core.rotor.swing_findings import EccentricityFinding

LEAST_SLIP_SHARE, MOST_SLIP_SHARE = 0.5, 2.0
"""Where the lines are looked for: at so many times the model's slip, for the rotor may be warm."""
POINTS_A_TURN = 4.0
"""Fineness of the search; a line half a step off keeps 97 % of its amplitude."""
GUARD_TURNS, REFERENCE_TURNS = 2.0, 24
"""Distance from the line at which noise is taken from, and how far off, in cycles over the record."""
FEWEST_TURNS = 4.0
"""Turns of the shaft that a record must have."""
FEWEST_POLE_PAIRS = 2
"""With one pole pair the lines fall on the offset and on the second harmonic."""
FALSE_ALARM = 1e-4
"""Chance that noise alone passes for a line."""
"""Quantiles of the normal distribution."""


def examine_eccentricity(baseband: Baseband, motor: Motor) -> EccentricityFinding:
    """Tell from one record how much the permeance of the air gap ripples once a turn.

    Parameters
    ----------
    baseband : Baseband
        Steady running, currents in step with the voltages.
    motor : Motor
        Nameplate, parameters and their tolerances, and sensors.

    Returns
    -------
    EccentricityFinding
        The indicator with its detection limit.
    """
    pole_pairs = motor.nameplate.pole_pairs
    if pole_pairs < FEWEST_POLE_PAIRS:
        return EccentricityFinding.untold(
            "with one pole pair the lines of an eccentric rotor fall on the offset and the second harmonic"
        )
    point = running_point(baseband, motor)
    slip = point.slip(motor)
    angle = _rotor_angle(baseband, slip_course(baseband, motor, slip), pole_pairs)
    turns = float(angle[-1] - angle[0]) / (2.0 * pi)
    if turns < FEWEST_TURNS:
        return EccentricityFinding.untold(f"the record holds {turns:.1f} turns of the shaft: too few")
    first, last = ((1.0 - share * slip) / (1.0 - slip) for share in (MOST_SLIP_SHARE, LEAST_SLIP_SHARE))
    kappa = np.linspace(first, last, max(2, ceil((last - first) * turns * POINTS_A_TURN) + 1))
    lines = fit_lines(baseband, angle, kappa)
    strongest = int(np.argmax(np.abs(lines.upper[:, 1]) + np.abs(lines.lower[:, 1])))
    record = _Record(baseband, angle, motor, kappa[strongest : strongest + 1])
    return record.finding(lines.at(strongest), point, chances=max(1.0, (last - first) * turns))


@dataclass(frozen=True, slots=True)
class _Record:
    """A record with the place of a pair of lines, as a multiple of the rotor's angle."""

    baseband: Baseband
    angle: Array
    motor: Motor
    kappa: Array

    def finding(self, line: Lines, point: RunningPoint, *, chances: float) -> EccentricityFinding:
        """Return what the lines mean, beside noise and errors of the parameters."""
        found = self._meaning(line, self.kappa, point, self.motor)
        value, torque = complex(found.permeance[0]), complex(found.load_torque[0])
        around = self._around()
        beside = self._meaning(fit_lines(self.baseband, self.angle, around), around, point, self.motor)
        noise = float(np.median(np.abs(beside.permeance) ** 2)) / log(2.0)
        torque_noise = float(np.median(np.abs(beside.load_torque) ** 2)) / log(2.0)
        wrong, torque_wrong = 0.0, 0.0
        for motor, baseband, deviations in errors(self.baseband, self.motor):
            other = self._meaning(line, self.kappa, running_point(baseband, motor), motor)
            wrong = hypot(wrong, deviations * abs(complex(other.permeance[0]) - value))
            torque_wrong = hypot(torque_wrong, deviations * abs(complex(other.load_torque[0]) - torque))
        deviation = hypot(sqrt(noise / 2.0), wrong)
        by_chance = sqrt(noise * log(chances / FALSE_ALARM))
        current = abs(point.current)
        return EccentricityFinding(
            permeance_ripple=abs(value),
            standard_deviation=deviation,
            detection_limit=hypot(by_chance, NORMAL_95 * wrong) + NINE_IN_TEN * deviation,
            lower_sideband_dB=decibels(float(abs(line.lower[0, 1])) / current),
            upper_sideband_dB=decibels(float(abs(line.upper[0, 1])) / current),
            load_torque=abs(torque),
            load_torque_deviation=hypot(sqrt(torque_noise / 2.0), torque_wrong),
            rotation_frequency_hz=float(self._distance(self.kappa)[0]) / (2.0 * pi),
            reasons=(),
        )

    def _distance(self, kappa: Array) -> Array:
        """Return the distance of lines from the fundamental, its mean over the record [rad/s]."""
        return np.asarray(kappa * float(self.angle[-1] - self.angle[0]) / self.baseband.span_s)

    def _meaning(self, line: Lines, kappa: Array, point: RunningPoint, motor: Motor) -> Ripples:
        return ripples(line, self._distance(kappa), point, motor)

    def _around(self) -> Array:
        """Return places beside the lines where nothing but noise is, shape (references,)."""
        turns = float(self.angle[-1] - self.angle[0]) / (2.0 * pi)
        off = np.arange(GUARD_TURNS, GUARD_TURNS + REFERENCE_TURNS / 2)
        places = np.concatenate([-off, off]) / turns + self.kappa[0]
        return np.asarray(places[places > GUARD_TURNS / turns])


def _rotor_angle(baseband: Baseband, slip: Array, pole_pairs: int) -> Array:
    """Return the angle of the shaft, zero in the middle [rad], shape (n,)."""
    rate = (1.0 - slip) * baseband.angular_frequency / pole_pairs
    step_s = float(baseband.time_s[1] - baseband.time_s[0])
    angle = np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) * (step_s / 2.0))])
    return np.asarray(angle - angle[angle.size // 2])
