"""Whether a record's current is one that the motor of the file draws at any load.

A fit of load and offset makes nearly every forward-turning current its own: a wrong parameter ends up as a
long offset, a wrong load or a level below zero. The current of a motor lies on a circle, whatever the load
(`core.machines.current_locus`). How far a record's lies beside it is compared with what the relay's channels,
its usual offset and parameters within their tolerances make up.
"""

from cmath import exp as cexp
from dataclasses import dataclass, replace
from math import exp, hypot, sqrt

import numpy as np

from core.diagnosis.fundamental import Fundamental
from core.diagnosis.priors import OFFSET_S
from core.machines.base import Array
from core.machines.current_locus import CurrentLocus, current_locus
from core.machines.parameters import Connection, MachineParameters, Motor, ParameterTolerances
from core.machines.sensors import SensorClass

TOGETHER = 0.7
"""Share of the tolerances' sum that counts: parameters are rarely all wrong in the same direction."""
CHANCE = 1.96
"""Standard deviations of the channels' errors and the relay's offset that count beside it."""
SATURATION = 1.0
"""Relative loss of magnetising inductance per relative rise of the voltage above the rated one."""
OF_THE_CIRCLE = (
    ("stator_resistance_ohm",),
    ("stator_leakage_H", "rotor_leakage_H"),
    ("stator_self_inductance_H",),
)
"""Parameters that the circle depends on; the two leakages do nearly the same to it."""
STEP, GAIN_STEP, OFFSET_STEP_S = 0.01, 1e-3, 1e-6
"""Steps of the difference quotients."""


@dataclass(frozen=True, slots=True)
class ParameterCheck:
    """How far a record's forward-turning current lies beside the circle of its motor.

    All are shares of that current.

    Parameters
    ----------
    distance : float
        Outside the circle; below zero inside it.
    parameters : float
        What parameters within their tolerances make up.
    channels : float
        Standard deviation of what channels of the class, the relay's usual offset and noise make up.
    """

    distance: float
    parameters: float
    channels: float

    @property
    def contradicts(self) -> bool:
        """Whether parameters of this motor, in their tolerances, hardly make up the distance."""
        return abs(self.distance) > TOGETHER * self.parameters + CHANCE * self.channels

    @property
    def needs_offset(self) -> bool:
        """Whether the figures of the file, taken as exact, need more offset than relays have."""
        return abs(self.distance) > CHANCE * self.channels

    @property
    def reason(self) -> str:
        """What it says, in words."""
        made_up = TOGETHER * self.parameters + CHANCE * self.channels
        return (
            f"the current lies {abs(self.distance):.1%} beside what this motor draws at any load; parameters "
            f"in their tolerances, channels of this class and a relay's usual offset make up {made_up:.1%}"
        )


def check_parameters(record: Fundamental, motor: Motor) -> ParameterCheck:
    """Compare a record's forward-turning current with the circle of its motor.

    Parameters
    ----------
    record : Fundamental
        Phasors of the record.
    motor : Motor
        Parameters, their tolerances, and the class of the sensors.

    Returns
    -------
    ParameterCheck
        What the record tells.
    """
    current, voltage = record.current, record.voltage
    noise = sqrt(float(np.trace(current.covariance[:2, :2])) / 2.0) / abs(current.forward)
    # A power-invariant space vector is as long as the rms voltage of the line; in delta sqrt 3 times that.
    delta = motor.nameplate.connection is Connection.DELTA
    rated_V = motor.nameplate.rated_voltage_V * (sqrt(3.0) if delta else 1.0)
    admittance = current.forward / voltage.forward
    return check_admittance(
        admittance, abs(voltage.forward) / rated_V, record.angular_frequency, motor, noise=noise
    )


def check_admittance(
    admittance: complex,
    relative_voltage: float,
    angular_frequency: float,
    motor: Motor,
    *,
    noise: float = 0.0,
) -> ParameterCheck:
    """Compare an admittance with the circle of its motor.

    Parameters
    ----------
    admittance : complex
        I1 / V1 of the windings [S].
    relative_voltage : float
        Voltage over the rated one.
    angular_frequency : float
        Angular frequency of the supply [rad/s].
    motor : Motor
        Parameters, their tolerances, and the class of the sensors.
    noise : float, default 0.0
        Standard deviation of the current's noise, a share of it.

    Returns
    -------
    ParameterCheck
        What the admittance tells.
    """
    w, machine, size = angular_frequency, motor.parameters, abs(admittance)
    locus = current_locus(machine, w)
    distance = locus.distance(admittance)
    saturated = SATURATION * abs(relative_voltage - 1.0)
    by_parameters = 0.0
    for name in ParameterTolerances.names():
        within = getattr(motor.tolerances, name)
        within += saturated if name == "stator_self_inductance_H" else 0.0
        by_parameters += max(
            abs(current_locus(_scaled(machine, exp(off), name), w).distance(admittance) - distance)
            for off in (within, -within)
        )
    gain, offset = slopes_of_sensors(locus, admittance, w)
    return ParameterCheck(
        distance=distance / size,
        parameters=by_parameters / size,
        channels=hypot(
            gain * gain_deviation(motor.sensors), offset * offset_deviation_s(motor.sensors), noise
        ),
    )


def slopes_of_sensors(
    locus: CurrentLocus, admittance: complex, angular_frequency: float
) -> tuple[float, float]:
    """Return how the distance follows errors that all three channels have in common.

    Parameters
    ----------
    locus : CurrentLocus
        The motor's circle.
    admittance : complex
        I1 / V1 of the windings [S].
    angular_frequency : float
        Angular frequency of the supply [rad/s].

    Returns
    -------
    gain : float
        Per relative error of the currents' ratio, as a share of the current.
    offset : float
        Per second of delay of the currents, as a share of the current [1/s].
    """
    here, size = locus.distance(admittance), abs(admittance)
    grown = locus.distance(admittance * (1.0 + GAIN_STEP))
    delayed = locus.distance(admittance * cexp(-1j * angular_frequency * OFFSET_STEP_S))
    return (grown - here) / GAIN_STEP / size, (delayed - here) / OFFSET_STEP_S / size


def slopes_of_parameters(
    machine: MachineParameters, locus: CurrentLocus, admittance: complex, angular_frequency: float
) -> Array:
    """Return how the distance follows the parameters of the circle.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    locus : CurrentLocus
        Its circle.
    admittance : complex
        I1 / V1 of the windings [S].
    angular_frequency : float
        Angular frequency of the supply [rad/s].

    Returns
    -------
    ndarray, shape (3,)
        Per relative error of R_s, of both leakages, and of L_s in the file, as shares of the current.
    """
    here, size = locus.distance(admittance), abs(admittance)
    changed = [
        current_locus(_scaled(machine, 1.0 + STEP, *names), angular_frequency).distance(admittance)
        for names in OF_THE_CIRCLE
    ]
    return (np.array(changed) - here) / (STEP * size)


def gain_deviation(sensors: SensorClass) -> float:
    """Return the standard deviation of the mean of three currents' ratios over that of three voltages'.

    Parameters
    ----------
    sensors : SensorClass
        Spans of the channels' errors.

    Returns
    -------
    float
        Relative deviation.
    """
    return hypot(sensors.current_gain, sensors.voltage_gain) / 3.0


def offset_deviation_s(sensors: SensorClass) -> float:
    """Return the standard deviation of the offset between currents and voltages.

    Parameters
    ----------
    sensors : SensorClass
        Spans of the channels' errors.

    Returns
    -------
    float
        Of a relay's usual offset and the mean of its channels' delays [s].
    """
    return hypot(OFFSET_S, sensors.current_delay_s / 3.0, sensors.voltage_delay_s / 3.0)


def _scaled(machine: MachineParameters, factor: float, *names: str) -> MachineParameters:
    return replace(machine, **{name: factor * getattr(machine, name) for name in names})
