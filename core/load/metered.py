"""What a relay's metering tells of a motor: whether it runs, its load, and how uneven its supply is."""

from dataclasses import dataclass
from math import pi

from core.load.course import LoadPoint
from core.machines.parameters import Connection, Motor
from core.operation import Operation
from core.quality import rated_current_A

LEAST_CURRENT = 0.02
"""Share of the rated current below which a motor stands. One that runs idle draws ten times as much."""


@dataclass(frozen=True, slots=True)
class Metered:
    """Values of a relay's metering, or means of them. Each is None where the relay has none.

    Parameters
    ----------
    time_ns : int
        Time, or begin of the time of a mean, UTC [ns].
    currents_A : tuple of float or None
        Rms line currents [A].
    line_voltages_V : tuple of float or None
        Rms line voltages [V].
    active_power_W : float or None
        Power taken from the supply [W].
    frequency_hz : float or None
        Frequency of the supply [Hz].
    """

    time_ns: int
    currents_A: tuple[float, float, float] | None
    line_voltages_V: tuple[float, float, float] | None
    active_power_W: float | None
    frequency_hz: float | None


def load_point(metered: Metered, motor: Motor) -> LoadPoint:
    """Tell what a motor does, and its load: the torque that crosses its air gap.

    T_e = p (P - R_s (sum of the windings' squared currents)) / w_s. A wrong sign of the power, which is a
    matter of how its transformers are wired, does not count.

    Parameters
    ----------
    metered : Metered
        What its relay measured.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    LoadPoint
        What the motor does from then on.
    """
    amps = metered.currents_A
    if amps is None:
        return LoadPoint(metered.time_ns, None)
    if max(amps) < LEAST_CURRENT * rated_current_A(motor.nameplate):
        return LoadPoint(metered.time_ns, Operation.NOT_RUNNING, active_power_W=0.0)
    if metered.active_power_W is None:
        return LoadPoint(metered.time_ns, Operation.RUNNING)
    power_W = abs(metered.active_power_W)
    plate = motor.nameplate
    windings = 1.0 / 3.0 if plate.connection is Connection.DELTA else 1.0
    lost_W = motor.parameters.stator_resistance_ohm * windings * sum(one**2 for one in amps)
    angular_frequency = 2.0 * pi * (metered.frequency_hz or plate.rated_frequency_Hz)
    torque_Nm = plate.pole_pairs * (power_W - lost_W) / angular_frequency
    return LoadPoint(metered.time_ns, Operation.RUNNING, torque_Nm / plate.rated_torque_Nm, power_W)
