"""The temperature of a stator winding from its resistance, over the records of a motor that runs.

A running motor shows the impedance Z1 = V1/I1 of its circuit. With X_m and the leakages known, its imaginary
part tells R_r/s in closed form, whatever the rotor's temperature, and its real part then tells R_s. An error
of a few per cent of a parameter, or of a transformer's ratio, is as large as R_s itself. So one record tells
no temperature; the change from one record to another at a like load does, since such errors stand in both.
What is left of them makes the interval.
"""

from dataclasses import dataclass, fields, replace
from math import hypot, pi, sqrt

from core.condition.measuring.impedance import negative_impedance
from core.condition.observation import Observation
from core.machines.parameters import MachineParameters, Motor, ParameterTolerances
from core.normal_distribution import NORMAL_95

COPPER_ZERO_C = 234.5
"""Minus the temperature at which the resistance of copper would be zero (IEC 60034-1, 8.6.2) [degree C]."""
WIDEST_K = 30.0
"""Half the interval above which a temperature is not told: more than a class of insulation."""
SENSORS_WANDER = 0.05
"""Share of the sensors' class by which a transformer's ratio changes between records."""
_STEP = 1e-4
"""Relative step of the numerical derivatives."""


@dataclass(frozen=True, slots=True)
class WindingTemperature:
    """How much hotter a stator winding is than in the reference record.

    Parameters
    ----------
    rise_K : float or None
        Its temperature above that in the reference record [K]; None where the records cannot tell.
    rise_K_ci95 : tuple of float or None
        Its 95 % interval from noise, parameters and sensors [K].
    reasons : tuple of str
        Why it is not told.
    """

    rise_K: float | None
    rise_K_ci95: tuple[float, float] | None
    reasons: tuple[str, ...] = ()


def stator_resistance_ohm(
    impedance: complex, frequency_hz: float, machine: MachineParameters
) -> float | None:
    """Return the stator resistance that an impedance in positive sequence tells.

    Parameters
    ----------
    impedance : complex
        Z1 = V1/I1 of a winding [ohm].
    frequency_hz : float
        Supply frequency [Hz].
    machine : MachineParameters
        Inductances of the machine; its resistances are not used.

    Returns
    -------
    float or None
        R_s [ohm]; None where no slip explains the imaginary part.
    """
    w = 2.0 * pi * frequency_hz
    X_m, X_lr = w * machine.magnetising_inductance_H, w * machine.rotor_leakage_H
    X_r = X_m + X_lr
    # Im Z_p = X_m (r^2 + X_lr X_r) / (r^2 + X_r^2) of the parallel branches, with r = R_r/s.
    parallel = impedance.imag - w * machine.stator_leakage_H
    if not X_m * X_lr / X_r < parallel < X_m:
        return None
    r = sqrt(X_r * (parallel * X_r - X_m * X_lr) / (X_m - parallel))
    return impedance.real - X_m**2 * r / (r**2 + X_r**2)


def winding_temperature(
    observation: Observation, reference: Observation, motor: Motor, *, reference_C: float = 25.0
) -> WindingTemperature:
    """Tell how much hotter the winding is than in another record of the same sensors.

    Parameters
    ----------
    observation : Observation
        The record.
    reference : Observation
        The record that it is compared with.
    motor : Motor
        Parameters with their tolerances, and the class of the sensors.
    reference_C : float, default 25.0
        Temperature at which the motor's parameter R_s holds [degree C].

    Returns
    -------
    WindingTemperature
        The rise, or why it cannot be told.
    """
    if observation.recorder != reference.recorder:
        return _untold("other sensors recorded the reference: their errors do not cancel")
    change = _change(observation, reference, motor.parameters)
    variance = None if change is None else _variance(observation, reference, motor)
    if change is None or variance is None:
        return _untold("no slip explains the impedance: the inductances are not the motor's")
    kelvin_per_ohm = (COPPER_ZERO_C + reference_C) / motor.parameters.stator_resistance_ohm
    rise_K = kelvin_per_ohm * change
    scale = motor.tolerances.stator_resistance_ohm * rise_K
    half_K = NORMAL_95 * hypot(kelvin_per_ohm * sqrt(variance), scale)
    if half_K > WIDEST_K:
        return _untold(
            f"the rise is uncertain by {half_K:.0f} K, more than {WIDEST_K:.0f} K: "
            "compare records at a like load"
        )
    return WindingTemperature(rise_K, (rise_K - half_K, rise_K + half_K))


def _untold(reason: str) -> WindingTemperature:
    return WindingTemperature(None, None, (reason,))


def _impedance(observation: Observation) -> complex:
    return observation.positive_voltage_V / observation.positive_current_A


def _change(
    observation: Observation,
    reference: Observation,
    machine: MachineParameters,
    wrong: complex = 1.0,
    wandered: complex = 1.0,
) -> float | None:
    """Return R_s less that of the reference.

    wrong: error of both impedances. wandered: of the reference alone.
    """
    now = stator_resistance_ohm(wrong * _impedance(observation), observation.frequency_hz, machine)
    before = stator_resistance_ohm(wrong * wandered * _impedance(reference), reference.frequency_hz, machine)
    return None if now is None or before is None else now - before


def _variance(observation: Observation, reference: Observation, motor: Motor) -> float | None:
    """Return the variance of the change; None where a neighbour of the parameters has no solution."""
    machine, frequency_hz = motor.parameters, observation.frequency_hz
    here = _change(observation, reference, machine)
    if here is None:
        return None
    sensor = hypot(
        motor.sensors.voltage_deviation(frequency_hz), motor.sensors.current_deviation(frequency_hz)
    ) / sqrt(3.0)  # of the mean of three channels
    noise = sqrt(_noise(observation, motor) + _noise(reference, motor))
    wander = hypot(SENSORS_WANDER * sensor, noise)
    # Each: what a relative step of one cause makes, and the deviation of the cause.
    stepped: list[tuple[float | None, float]] = []
    for field in fields(ParameterTolerances):
        changed = replace(machine, **{field.name: getattr(machine, field.name) * (1.0 + _STEP)})
        deviation = getattr(motor.tolerances, field.name) / NORMAL_95
        stepped.append((_change(observation, reference, changed), deviation))
    for turn in (1.0, 1j):  # magnitude and angle, half of the variance each
        wrong = 1.0 + _STEP * turn
        stepped.append((_change(observation, reference, machine, wrong), sensor / sqrt(2.0)))
        stepped.append((_change(observation, reference, machine, 1.0, wrong), wander / sqrt(2.0)))
    total = 0.0
    for value, deviation in stepped:
        if value is None:
            return None
        total += ((value - here) / _STEP * deviation) ** 2
    return total


def _noise(observation: Observation, motor: Motor) -> float:
    """Return an upper bound of the relative variance of Z1 from the record's own noise.

    The scatter of y = V2/V1 - Z2 I2/V1 is that of both voltages and currents, over V1.
    """
    Z2 = negative_impedance(motor, observation.frequency_hz)
    return observation.scatter * (1.0 + abs(_impedance(observation) / Z2) ** 2)
