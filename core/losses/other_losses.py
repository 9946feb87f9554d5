"""Losses that no current of a record tells: in the core, at the shaft, and stray load losses.

They are a share of the rated losses, as catalogues of cage motors have it. IEC 60034-2-1 assigns the stray
load losses by the rated power; of the rest more is lost in the core than at the shaft.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import exp, log10

from core.machines.load_point import LoadPoint, load_point
from core.machines.parameters import Motor

OTHER_SHARE = 0.45
"""Of the rated losses, what is not of the windings (0.8 kW to 2 MW)."""
OTHER_DEVIATION = 0.3
"""Standard deviation of the logarithm of those losses."""
SHARE_OF_CORE = 0.6
"""Of what is neither of the windings nor stray."""
MOST_STRAY = 0.6
"""Of what is not of the windings: some always stays for core and shaft."""


@dataclass(frozen=True, slots=True)
class OtherLosses:
    """What is not of the windings, at rated voltage and load.

    Parameters
    ----------
    iron_W, friction_W, stray_W : float
        In the core, by friction and windage, and stray load losses [W].
    rated_current_A, no_load_current_A : float
        Currents of a winding at rated load and without any, rms [A].
    """

    iron_W: float
    friction_W: float
    stray_W: float
    rated_current_A: float
    no_load_current_A: float

    def stray_at(self, current_A: float) -> float:
        """Return the stray load losses at a current of the windings, after IEC 60034-2-1 [W]."""
        load = current_A**2 - self.no_load_current_A**2
        return self.stray_W * max(0.0, load / (self.rated_current_A**2 - self.no_load_current_A**2))


def copper_W(motor: Motor, at: LoadPoint) -> float:
    """Return the losses of the windings and of the rotor of a sound motor at a load [W]."""
    machine = motor.parameters
    return 3.0 * (
        machine.stator_resistance_ohm * abs(at.current_A) ** 2
        + machine.rotor_resistance_ohm * abs(at.rotor_current_A) ** 2
    )


def assigned_stray_W(rated_power_W: float, rated_input_W: float) -> float:
    """Return the stray load losses that IEC 60034-2-1 assigns to a rated power (6.1.3.2.6).

    Parameters
    ----------
    rated_power_W : float
        Power at the shaft [W].
    rated_input_W : float
        Power drawn [W].

    Returns
    -------
    float
        2.5 % of the input up to 1 kW, 0.5 % from 10 MW on, between them by the logarithm [W].
    """
    decades = min(max(log10(rated_power_W / 1e3), 0.0), 4.0)
    return rated_input_W * (0.025 - 0.005 * decades)


@lru_cache(maxsize=1024)
def other_losses(motor: Motor, deviations: float = 0.0) -> OtherLosses:
    """Return what is not of the windings.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    deviations : float, default 0.0
        By how many standard deviations they are above what is usual.

    Returns
    -------
    OtherLosses
        The losses.
    """
    plate = motor.nameplate
    voltage_V, hertz, power_W = plate.winding_voltage_V, plate.rated_frequency_Hz, plate.rated_power_W
    rated, idle = (load_point(motor, voltage_V, hertz, load_W) for load_W in (power_W, 0.0))
    rated_copper_W = copper_W(motor, rated)
    other_W = rated_copper_W * OTHER_SHARE / (1.0 - OTHER_SHARE) * exp(deviations * OTHER_DEVIATION)
    stray_W = min(assigned_stray_W(power_W, power_W + rated_copper_W + other_W), MOST_STRAY * other_W)
    steady_W = other_W - stray_W
    return OtherLosses(
        iron_W=SHARE_OF_CORE * steady_W,
        friction_W=(1.0 - SHARE_OF_CORE) * steady_W,
        stray_W=stray_W,
        rated_current_A=abs(rated.current_A),
        no_load_current_A=abs(idle.current_A),
    )
