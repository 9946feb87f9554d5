"""Asymmetry that sensors within their class and parameters within their tolerance can cause.

Noise averages out over a record; a ratio error of a sensor or a wrong parameter does not. Each leaves
a backward-turning current that a fault would explain as well, so its size, not the noise, decides how small a
fault can be believed. The contributions are independent and add in squares.
"""

from dataclasses import dataclass
from math import hypot, sqrt
from statistics import NormalDist

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.propagation import CONFIDENCE_QUANTILE, Known
from core.diagnosis.refinement import FAULT_LEVEL, Fit
from core.machines.candidates import Candidates
from core.machines.parameters import Motor, ParameterTolerances
from core.machines.playback import Playback

PARAMETERS = 0.06
"""Standard deviation of the negative-sequence impedance of a machine whose parameters are within the usual
tolerance of 10 %, uniformly. Windings warm up, data sheets round off."""

FALSE_ALARM_QUANTILE = NormalDist().inv_cdf(1.0 - 0.001 / 3.0)
"""Standard errors that none of three windings' levels exceeds in 999 of 1,000 healthy records."""
DETECTION_QUANTILE = NormalDist().inv_cdf(0.9)
"""Standard errors above the least that is called a fault, at which nine of ten records call it one."""
PROBE_LEVEL = 0.005


@dataclass(frozen=True, slots=True)
class Systematic:
    """Standard deviations that no averaging reduces, of a healthy motor in the record's operating point.

    They decide what is called a fault. What a fitted level may be off by is in `core.diagnosis.propagation`.

    Parameters
    ----------
    backward : float
        Of the backward-turning current, as a fraction of the forward-turning one (complex magnitude).
    level : float
        Of the fault level, a fraction of the phase turns.
    """

    backward: float
    level: float

    def least_fault(self, fit: Fit, limit: float) -> float:
        """Return the least level called a fault: above the motor's limit, and no false alarm.

        Parameters
        ----------
        fit : Fit
            The fit of the fault.
        limit : float
            Fault level above which the motor counts as faulty.

        Returns
        -------
        float
            Level, a fraction of the phase turns.
        """
        total = self._total(fit)
        return max(limit + CONFIDENCE_QUANTILE * total, FALSE_ALARM_QUANTILE * total)

    def detection_limit(self, fit: Fit, limit: float) -> float:
        """Return the level that nine of ten such records would have shown to lie above the motor's limit.

        Parameters
        ----------
        fit : Fit
            The fit of the fault.
        limit : float
            Fault level above which the motor counts as faulty.

        Returns
        -------
        float
            Level, a fraction of the phase turns.
        """
        return self.least_fault(fit, limit) + DETECTION_QUANTILE * self._total(fit)

    def _total(self, fit: Fit) -> float:
        return hypot(self.level, fit.standard_error.get(FAULT_LEVEL, 0.0))


def systematic(case: Case, playback: Playback, fit: Fit, known: Known) -> Systematic:
    """Compute the tolerances of one record from its voltages, its currents and the fitted operating point.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    playback : Playback
        The record's voltages, for any candidate.
    fit : Fit
        The fit of the fault.
    known : Known
        What a baseline has taken off, and how balanced an assumed supply is.

    Returns
    -------
    Systematic
        The tolerances.
    """
    candidate = fit.candidate
    probes = Candidates(
        fault_level=np.array([0.0, PROBE_LEVEL]),
        winding=np.repeat(candidate.winding, 2),
        load_level=np.repeat(candidate.load_level, 2),
        time_offset_s=np.repeat(candidate.time_offset_s, 2),
        path_ratio=np.zeros(2),
    )
    alpha, beta = playback.steady_state(probes).current
    backward_current = (alpha - 1j * beta) / 2.0
    forward = abs(complex(alpha[0] + 1j * beta[0])) / 2.0
    per_level = abs(complex(backward_current[1] - backward_current[0])) / PROBE_LEVEL / forward

    V_alpha, V_beta = (complex(value) for value in case.supply.phasor)
    V_forward = abs(V_alpha + 1j * V_beta) / 2.0
    V_unknown = backward_voltage(V_alpha + 1j * V_beta, (V_alpha - 1j * V_beta).conjugate()) / 2.0
    V_unknown -= known.unbalance_V
    impedance = _negative_sequence_impedance(case)
    per_volt = 1.0 / (impedance * forward)
    voltage_ratio = case.motor.sensors.voltage_deviation(case.frequency_hz)
    current_ratio = case.motor.sensors.current_deviation(case.frequency_hz)
    sensors = hypot(current_ratio, voltage_ratio * V_forward * per_volt) / sqrt(3.0)
    backward = hypot(
        (1.0 - known.share) * sensors,
        negative_impedance_deviation(case.motor) * abs(V_unknown) * per_volt,
        known.supply_unbalance * V_forward * per_volt,
        known.error_A / forward,
    )
    # Only the part of a complex error that lies along the fault's own current looks like a fault.
    return Systematic(backward=backward, level=backward / sqrt(2.0) / per_level)


def negative_impedance_deviation(motor: Motor) -> float:
    """Return the standard deviation of a machine's negative-sequence impedance.

    Parameters
    ----------
    motor : Motor
        The motor, with the tolerances of its parameters.

    Returns
    -------
    float
        Relative deviation: `PARAMETERS` where all tolerances are the usual ones.
    """
    return PARAMETERS * (_weighted(motor, motor.tolerances) / _weighted(motor, ParameterTolerances()))


def backward_voltage(forward: complex, backward: complex) -> complex:
    """Return the backward-turning voltage seen from the forward-turning one, wherever a record begins.

    Parameters
    ----------
    forward, backward : complex
        Phasors of the voltage [V].

    Returns
    -------
    complex
        The phasor so seen [V].
    """
    return backward * forward / abs(forward)


def _weighted(motor: Motor, tolerances: ParameterTolerances) -> float:
    """Root of the sum of squares of the tolerances, each weighed by its part in the impedance [ohm]."""
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    return hypot(
        tolerances.stator_resistance_ohm * machine.stator_resistance_ohm,
        tolerances.rotor_resistance_ohm * machine.rotor_resistance_ohm / 2.0,
        tolerances.stator_leakage_H * w * machine.stator_leakage_H,
        tolerances.rotor_leakage_H * w * machine.rotor_leakage_H,
    )


def _negative_sequence_impedance(case: Case) -> float:
    """|Z2| at a slip near 2 [ohm, winding]: resistances R_s and R_r' / 2, both leakages."""
    machine = case.motor.parameters
    reactance = case.supply.angular_frequency * (machine.stator_leakage_H + machine.rotor_leakage_H)
    return hypot(machine.stator_resistance_ohm + machine.rotor_resistance_ohm / 2.0, reactance)
