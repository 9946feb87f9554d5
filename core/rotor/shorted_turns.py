"""What shorted turns draw, taken off: the rotor sees the rest.

With a fraction mu of a phase's turns bridged by a path of resistance r_f, the rest of the machine is a sound
one with the current i' = i_s - k n j in place of i_s (core.machines.split_winding). The voltage e across the
phase drives j, whatever the rotor does:

    r_f j / mu^2 + Z (1 / mu - c) j = e,    Z = R_s + j w_s L_ls,   c = 2/3 in star and 1 in delta

k n j pulsates along one axis; what of it turns forward is the voltage's space vector over three times that
impedance. (The voltage's negative sequence adds as small a share as it is of the voltage.) Without this the
loss in the turns passes for load: the slip comes out too high, and the asymmetry, which is over the rotor's
current, too low.
"""

from dataclasses import replace

from core.machines.parameters import Connection, Motor
from core.rotor.baseband import Baseband

STAR_SHARE, DELTA_SHARE = 2.0 / 3.0, 1.0


def without_shorted_turns(baseband: Baseband, motor: Motor, level: float, path_ratio: float) -> Baseband:
    """Take the current off that shorted turns draw.

    Parameters
    ----------
    baseband : Baseband
        The record, its currents in step with the voltages.
    motor : Motor
        Nameplate and parameters of the motor.
    level : float
        Equivalent fault level, a fraction of the phase turns.
    path_ratio : float
        Resistance of the path that bridges the turns over that of the turns.

    Returns
    -------
    Baseband
        The record with the current of the sound rest of the machine.
    """
    machine, w_s = motor.parameters, float(baseband.angular_frequency.mean())
    star = motor.nameplate.connection is Connection.STAR
    turns = level * (1.0 + path_ratio)
    own_share = 1.0 - (STAR_SHARE if star else DELTA_SHARE) * turns
    impedance = machine.stator_resistance_ohm + 1j * w_s * machine.stator_leakage_H
    admittance = turns / (path_ratio * machine.stator_resistance_ohm + own_share * impedance)
    return replace(baseband, current=baseband.current - baseband.voltage * admittance / 3.0)
