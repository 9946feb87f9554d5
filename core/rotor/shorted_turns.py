"""What shorted turns draw, taken off: the rotor sees the rest.

At one slip the machine draws what it would draw without them, and beside it the share Y of the voltage that
the signature of shorted turns tells (core.machines.coil_fault); of that only what turns forward is taken off:

    I1 = (1 / Z1 + Y) V1

(The voltage's negative sequence adds as small a share as it is of the voltage.) Turns on the axis of their
phase draw j k n whatever the rotor does. Those of a coil beside it need the slip, which follows from what is
left: a few rounds find it. Without this the loss in the turns passes for load: the slip comes out too high,
and the asymmetry, which is over the rotor's current, too low.
"""

from cmath import rect
from dataclasses import replace

from core.diagnosis.verdict import FittedParameters
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents
from core.machines.parameters import Connection, Motor
from core.rotor.baseband import Baseband
from core.rotor.running_point import running_point

ROUNDS = 3
"""Rounds from the slip to the current and back. Each leaves some hundredths of the error before."""
NO_NEGATIVE_SEQUENCE = SequencePair(1.0 + 0.0j, 0.0j)


def without_shorted_turns(baseband: Baseband, motor: Motor, turns: FittedParameters) -> Baseband:
    """Take the current off that shorted turns draw.

    Parameters
    ----------
    baseband : Baseband
        The record, its currents in step with the voltages.
    motor : Motor
        Nameplate and parameters of the motor.
    turns : FittedParameters
        Level, leakage, axis and linkage of the turns.

    Returns
    -------
    Baseband
        The record with the current that the machine would draw without them at the same slip.
    """
    if turns.mu_f <= 0.0:
        return baseband
    found, w_s = baseband, float(baseband.angular_frequency.mean())
    for _ in range(ROUNDS):
        drawn = _admittance(motor, turns, running_point(found, motor).slip(motor), w_s)
        found = replace(baseband, current=baseband.current - baseband.voltage * drawn)
    return found


def _admittance(motor: Motor, turns: FittedParameters, slip: float, w_s: float) -> complex:
    """Return Y at one slip and angular frequency: the change of I1 over V1 [1/ohm]."""
    machine = motor.parameters
    R_s, X_ls = machine.stator_resistance_ohm, w_s * machine.stator_leakage_H
    X_m, X_lr = w_s * machine.magnetising_inductance_H, w_s * machine.rotor_leakage_H
    gap = air_gap(complex(R_s, X_ls), X_m, machine.rotor_resistance_ohm, X_lr, slip, *motor.backward_rotor)
    branch = complex(R_s, turns.leakage * X_ls) / turns.mu_f
    ahead = rect(turns.linkage, turns.axis_rad)
    circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    faulty = faulty_currents(
        gap, NO_NEGATIVE_SEQUENCE, branch, ahead, ahead.conjugate(), circulating, 0
    )  # of the forward sequence alone every winding makes the same
    return complex(faulty.positive - 1.0 / (gap.stator + gap.forward))
