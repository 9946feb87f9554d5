"""What each kind of change looks like in the measurements, per unit of its size."""

from cmath import exp as cexp
from math import pi
from typing import Final

from core.condition.measuring.measurement import SIXTH, negative_impedance
from core.condition.observation import VoltageChannels
from core.machines.parameters import Connection, Motor
from core.machines.winding_frame import Winding, terminal_winding
from core.signals.sequence import PhaseSequence

A: Final = cexp(2j * pi / 3.0)
HALF_WARM: Final = 1.1
"""R_s in what shorted turns show, over that of the motor's file. It is between that of a cold winding (1) and
of one at work (`measurement.WARM`), because R_s scales the level that is told. The filter learns by how much
Z2 is another, but not R_s: with a figure between, a level is as little too high as too low."""
PATHS: Final = (0.0, 0.5, 1.0, 2.0, 4.0)
"""Resistances of the path over that of the shorted turns that are tried."""


def shorted_turns(motor: Motor, winding: int, path_ratio: float) -> complex:
    """Return what shorted turns add to y, per equivalent level.

    Parameters
    ----------
    motor : Motor
        The motor.
    winding : int
        0, 1 or 2 in the winding frame.
    path_ratio : float
        Resistance p of the path over that of the shorted turns.

    Returns
    -------
    complex
        -Z2n (1 + p) a^x / (3 (R_s (1 + p) + j X_ls)).
    """
    machine, f = motor.parameters, motor.nameplate.rated_frequency_Hz
    R_s, X_ls = HALF_WARM * machine.stator_resistance_ohm, 2.0 * pi * f * machine.stator_leakage_H
    Z2n = negative_impedance(machine, f)
    return complex(-Z2n * (1.0 + path_ratio) * A**winding / (3.0 * complex(R_s * (1.0 + path_ratio), X_ls)))


def turns_angle_slope(motor: Motor, path_ratio: float) -> float:
    """Return how fast the direction of shorted turns changes with R_s / X_ls.

    Parameters
    ----------
    motor : Motor
        The motor.
    path_ratio : float
        Resistance p of the path over that of the shorted turns.

    Returns
    -------
    float
        Product sin phi cos phi, phi the angle of R_s (1 + p) + j X_ls [rad per relative change].
    """
    machine, f = motor.parameters, motor.nameplate.rated_frequency_Hz
    R = HALF_WARM * machine.stator_resistance_ohm * (1.0 + path_ratio)
    X = 2.0 * pi * f * machine.stator_leakage_H
    return R * X / (R * R + X * X)


def turns_size_slope(motor: Motor, path_ratio: float) -> float:
    """Return how fast the size of shorted turns' signature falls as R_s grows.

    Parameters
    ----------
    motor : Motor
        The motor.
    path_ratio : float
        Resistance p of the path over that of the shorted turns.

    Returns
    -------
    float
        Fall, cos^2 phi, phi the angle of R_s (1 + p) + j X_ls [relative change per relative change].
    """
    machine, f = motor.parameters, motor.nameplate.rated_frequency_Hz
    R = HALF_WARM * machine.stator_resistance_ohm * (1.0 + path_ratio)
    X = 2.0 * pi * f * machine.stator_leakage_H
    return R * R / (R * R + X * X)


def terminal_turn(motor: Motor) -> complex:
    """Return the factor from V2/V1 of the terminals to that of the windings.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    complex
        1 in star; exp(-j 60 deg) in delta, where V1 leads by 30 degrees and V2 lags by as much.
    """
    return 1.0 / SIXTH**2 if motor.nameplate.connection is Connection.DELTA else 1.0 + 0.0j


def voltage_channels(channels: VoltageChannels) -> tuple[complex, ...]:
    """Return what an error of each voltage channel adds to V2/V1 of the terminals, per relative error.

    Parameters
    ----------
    channels : VoltageChannels
        Which voltages are measured.

    Returns
    -------
    tuple of complex
        Three values in the positive-sequence frame. Phase voltages: a^x/3. Line voltages as
        `core.signals.clarke` takes them: v_ab and v_ca weigh half of v_bc. Of two line voltages it is not
        said which are measured. Both of a pair err along the same line, so there is one for each pair.
    """
    half, whole = 0.5 / 3.0**0.5, 1.0 / 3.0**0.5
    if channels is VoltageChannels.PHASE:
        return tuple(A**x / 3.0 for x in range(3))
    if channels is VoltageChannels.THREE_LINES:
        return (half * SIXTH, -0.5 + 0.0j, half / SIXTH)
    return (whole * SIXTH, whole * SIXTH**5, whole * SIXTH**3)


def channel_of(index: int, channels: VoltageChannels, sequence: PhaseSequence) -> Winding | None:
    """Return which voltage channel of the terminals an index of `voltage_channels` means.

    Parameters
    ----------
    index : int
        Index of the signature.
    channels : VoltageChannels
        Which voltages are measured.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.

    Returns
    -------
    Winding or None
        Phase a, b, c, or line ab, bc, ca; None of two lines, where either may be meant.
    """
    if channels is VoltageChannels.TWO_LINES:
        return None
    # Mirroring exchanges phases b and c, hence lines ab and ca, as the windings of a star and of a delta.
    as_if = Connection.STAR if channels is VoltageChannels.PHASE else Connection.DELTA
    return terminal_winding(index, sequence, as_if)
