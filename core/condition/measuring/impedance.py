"""Impedances that a warm motor shows to the two sequences, and the slip that they tell."""

from math import pi

from core.machines.parameters import MachineParameters, Motor

WARM = 1.2
"""Resistance of a winding at work over that of the motor's file, where it is that of a cold one."""
RATED_SLIP = 0.02
LARGEST_SLIP = 0.1


def negative_impedance(motor: Motor, frequency_hz: float, slip: float = RATED_SLIP) -> complex:
    """Return the nominal negative-sequence impedance of a warm motor.

    Parameters
    ----------
    motor : Motor
        The motor.
    frequency_hz : float
        Supply frequency [Hz].
    slip : float, default RATED_SLIP
        Slip of the rotor against the positive sequence.

    Returns
    -------
    complex
        Z2n = 1.2 (R_s + R_r / (2 - s)) + j 2 pi f (L_ls + L_lr) [ohm], the rotor as that sequence sees it.
    """
    machine, rotor = motor.parameters, motor.backward_rotor
    R_r = rotor.resistance_ratio * machine.rotor_resistance_ohm
    L_lr = rotor.leakage_share * machine.rotor_leakage_H
    resistance = WARM * (machine.stator_resistance_ohm + R_r / (2.0 - slip))
    return complex(resistance, 2.0 * pi * frequency_hz * (machine.stator_leakage_H + L_lr))


def slip_of(machine: MachineParameters, frequency_hz: float, impedance: complex) -> float:
    """Return the slip at which a motor shows an impedance to the positive sequence.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    frequency_hz : float
        Supply frequency [Hz].
    impedance : complex
        V1/I1 of the windings [ohm].

    Returns
    -------
    float
        Slip, between 0 and 0.1.
    """
    w = 2.0 * pi * frequency_hz
    air_gap = impedance - complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    if air_gap == 0.0:
        return LARGEST_SLIP
    admittance = 1.0 / air_gap + 1j / (w * machine.magnetising_inductance_H)
    if admittance == 0.0:
        return 0.0
    resistance = (1.0 / admittance).real
    if resistance <= 0.0:
        return LARGEST_SLIP
    return min(WARM * machine.rotor_resistance_ohm / resistance, LARGEST_SLIP)
