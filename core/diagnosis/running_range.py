"""The slips at which a motor can run, and the load that each means."""

from math import hypot
from typing import NamedTuple

from core.diagnosis.coil_likelihood import MachineNumbers, ShortedTurns, air_gap_torque
from core.machines.base import Array
from core.machines.parameters import Nameplate

GENERATING_SHARE, ROUNDS = 0.3, 50
HEALTHY = ShortedTurns(0.0, 1.0, 1.0 + 0.0j, 0)


class SlipRange(NamedTuple):
    """Slips that are searched.

    Parameters
    ----------
    rated : float
        Slip at rated torque on rated voltage; that of the greatest torque where a machine does not reach it.
    lowest, highest : float
        The range.
    """

    rated: float
    lowest: float
    highest: float


class RunningPoint(NamedTuple):
    """Where a motor ran, whatever its asymmetry.

    Parameters
    ----------
    slip, offset_s : float
        Slip, and delay of the currents [s].
    covariance : ndarray
        Of the errors of a healthy machine's figures there.
    """

    slip: float
    offset_s: float
    covariance: Array


class HealthyFit(NamedTuple):
    """The healthy machine that comes nearest to a record.

    Parameters
    ----------
    log_likelihood : float
        Log of its likelihood.
    slip, offset_s : float
        Its slip, and the delay of the currents [s].
    """

    log_likelihood: float
    slip: float
    offset_s: float


def slip_range(machine: MachineNumbers, nameplate: Nameplate, angular_frequency: float) -> SlipRange:
    """Return the slips at which a motor can run."""
    leakage = angular_frequency * (machine.L_ls + machine.L_lr)
    pull_out = min(1.0, machine.R_r / hypot(machine.R_s, leakage))
    # The forward phasor of the power-invariant space vector is sqrt 3 times the voltage of a winding, rms.
    wanted = nameplate.rated_torque_Nm * angular_frequency / nameplate.pole_pairs
    volts = 3.0 * nameplate.winding_voltage_V**2
    low, high = 0.0, pull_out
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        if air_gap_torque(machine, HEALTHY, angular_frequency, 0j, middle) * volts < wanted:
            low = middle
        else:
            high = middle
    return SlipRange(high, -GENERATING_SHARE * high, pull_out)
