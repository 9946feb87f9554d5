"""The steady running about which the sidebands are small: the rotor's flux, current and slip.

The slip is that of the model at the torque that crosses the air gap; no search for lines is needed:

    Psi_s = (V - R_s I_s) / (j w_s),   T_e = p Im(I_s conj(Psi_s)),   Psi_m = Psi_s - L_ls I_s,
    I_r = -j lambda Psi_r,   Psi_r = Psi_m / (1 + j lambda L_lr),   lambda = s w_s / R_r,
    T_e = p lambda |Psi_m|^2 / (1 + (lambda L_lr)^2), of whose two solutions the smaller one runs
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import hypot, sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import MachineParameters, Motor
from core.rotor.baseband import Baseband, slow

OFFSET_BEYOND = 2.0
"""Standard deviations of what wrong parameters explain from which on currents are taken to be delayed."""
UNIFORM = 1.0 / sqrt(3.0)
"""Standard deviation of an error that is anywhere within its span, over the span."""


@dataclass(frozen=True, slots=True)
class RunningPoint:
    """Steady running as one set of parameters sees it.

    Parameters
    ----------
    angular_frequency : float
        Angular frequency w_s of the supply [rad/s].
    current : complex
        Stator current, peak [A].
    stator_flux, rotor_flux : complex
        Psi_s and Psi_r, peak [V s].
    rotor_current : complex
        I_r, peak [A].
    slip_over_resistance : float
        Slip over the rotor resistance, lambda = s w_s / R_r [1/H].
    torque_Nm : float
        T_e, the mean over the record [N m].
    """

    angular_frequency: float
    current: complex
    stator_flux: complex
    rotor_flux: complex
    rotor_current: complex
    slip_over_resistance: float
    torque_Nm: float

    def slip(self, motor: Motor) -> float:
        """Return the slip.

        Parameters
        ----------
        motor : Motor
            The motor with its rotor resistance.

        Returns
        -------
        float
            Slip.
        """
        return self.slip_over_resistance * motor.parameters.rotor_resistance_ohm / self.angular_frequency


def running_point(baseband: Baseband, motor: Motor) -> RunningPoint:
    """Find flux, current and slip of the rotor from the means of voltage and current.

    Parameters
    ----------
    baseband : Baseband
        The record.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    RunningPoint
        The operating point. Where the torque is beyond what the machine can make, it is the point of the
        greatest torque.
    """
    machine = motor.parameters
    w_s = float(baseband.angular_frequency.mean())
    V, I_s = complex(baseband.voltage.mean()), complex(baseband.current.mean())
    L_lr = machine.rotor_leakage_H
    Psi_s = (V - machine.stator_resistance_ohm * I_s) / (1j * w_s)
    Psi_m = Psi_s - machine.stator_leakage_H * I_s
    torque = (I_s * Psi_s.conjugate()).imag
    square, twice = abs(Psi_m) ** 2, 2.0 * torque * L_lr
    # The smaller root, written so that no load at all gives none.
    lam = 2.0 * torque / (square + sqrt(max(square**2 - twice**2, 0.0)))
    Psi_r = Psi_m / (1.0 + 1j * lam * L_lr)
    return RunningPoint(w_s, I_s, Psi_s, Psi_r, -1j * lam * Psi_r, lam, motor.nameplate.pole_pairs * torque)


def slip_course(baseband: Baseband, motor: Motor, slip: float) -> Array:
    """Return the slip over a record: it follows the slow part of the torque.

    Parameters
    ----------
    baseband : Baseband
        The record.
    motor : Motor
        Parameters of the motor.
    slip : float
        Mean slip.

    Returns
    -------
    ndarray, shape (n,)
        Slip.
    """
    current = baseband.current
    across = baseband.voltage - motor.parameters.stator_resistance_ohm * current
    torque = (across * current.conj()).real / baseband.angular_frequency
    return np.asarray(slip * slow(baseband.time_s, torque) / torque.mean())


def without_delay(
    baseband: Baseband, motor: Motor, time_offset_s: float | None, *, assumed: bool
) -> Baseband | None:
    """Take the delay of the currents off that the diagnosis found, where there has to be one.

    The diagnosis fits a delay freely, and gives it what wrong parameters do to the reactive current. One that
    they explain is none.

    Parameters
    ----------
    baseband : Baseband
        The record.
    motor : Motor
        Parameters of the motor and their tolerances.
    time_offset_s : float or None
        Delay of the currents against the voltages that the diagnosis fitted [s]; None where it did not
        recognise the motor.
    assumed : bool
        Whether no voltages were recorded; the delay then tells the direction of those that are assumed.

    Returns
    -------
    Baseband or None
        The record, its currents in step with the voltages; None where neither tolerances nor a delay
        explain the currents.
    """
    drawn = _drawn_beside_model(baseband, motor)
    explained = 0.0
    for other, wrong, deviations in errors(baseband, motor):
        explained = hypot(explained, deviations * abs(_drawn_beside_model(wrong, other) - drawn))
    if not assumed and abs(drawn) <= OFFSET_BEYOND * explained:
        return baseband
    if time_offset_s is None:
        return None
    return _turned(baseband, float(baseband.angular_frequency.mean()) * time_offset_s)


def errors(baseband: Baseband, motor: Motor) -> Iterator[tuple[Motor, Baseband, float]]:
    """Yield motor and record with one figure wrong by its tolerance, each with its standard deviations.

    Parameters
    ----------
    baseband : Baseband
        The record.
    motor : Motor
        Parameters of the motor, their tolerances, and its sensors.

    Yields
    ------
    Motor
        The motor.
    Baseband
        The record.
    float
        Standard deviation of the error over its span.
    """
    for name in ("stator_resistance_ohm", "stator_leakage_H", "rotor_leakage_H", "stator_self_inductance_H"):
        factor = 1.0 + getattr(motor.tolerances, name)
        wrong = replace(motor.parameters, **{name: factor * getattr(motor.parameters, name)})
        yield replace(motor, parameters=wrong), baseband, UNIFORM
    sensors, w_s = motor.sensors, float(baseband.angular_frequency.mean())
    gain = hypot(sensors.voltage_gain, sensors.current_gain)
    yield motor, replace(baseband, current=baseband.current * (1.0 + gain)), UNIFORM
    yield motor, _turned(baseband, w_s * hypot(sensors.voltage_delay_s, sensors.current_delay_s)), UNIFORM


def _turned(baseband: Baseband, angle: float) -> Baseband:
    return replace(baseband, current=baseband.current * np.exp(1j * angle))


def _drawn_beside_model(baseband: Baseband, motor: Motor) -> complex:
    """Return what the stator draws beside the current of the model at this torque, over it."""
    point = running_point(baseband, motor)
    expected = _admittance(point, motor.parameters) * complex(baseband.voltage.mean())
    return point.current / expected - 1.0


def _admittance(point: RunningPoint, machine: MachineParameters) -> complex:
    """Return the admittance of the T circuit, with R_r / s = w_s / lambda."""
    w_s = point.angular_frequency
    magnetising = 1.0 / (1j * w_s * machine.magnetising_inductance_H)
    rotor = point.slip_over_resistance / (
        w_s * (1.0 + 1j * point.slip_over_resistance * machine.rotor_leakage_H)
    )
    stator = machine.stator_resistance_ohm + 1j * w_s * machine.stator_leakage_H
    return 1.0 / (stator + 1.0 / (magnetising + rotor))
