"""Wound rotors: the winding's ends are on slip rings, where a resistance may be in series with it.

Referred to the stator with the ratio of turns u, a wound rotor obeys a cage's equations with the resistance

    R = R_r + u^2 R_ext          U_20 / sqrt 3 = V_N / u  L_m / (L_ls + L_m)   (open rings, standstill)

so every stator model holds for it. What is new is that R_ext may be another one in each record. At supply
frequency the stator sees R over the slip alone, forwards: a larger resistance at a larger slip draws the
same current at the same torque. So the load is told whatever R_ext is, and R_ext is not. Backwards the rotor
shows R / (2 - s), on which the answer to an unbalanced supply depends a little. What does tell R_ext is the
slip: of a tachometer, or of the sidebands that an uneven rotor makes (`core.rotor`).
"""

from dataclasses import replace
from math import sqrt
from typing import NamedTuple

from core.machines.parameters import Motor

MOST_SHARE = 0.95
"""Most that the resistance may be off by, relative to the middle of what it may be."""


class ResistanceRatios(NamedTuple):
    """What a rotor's resistance may be, over the one that is assumed.

    Parameters
    ----------
    least, most : float
        Ends; 1 and 1 where nothing but its temperature is unknown.
    """

    least: float = 1.0
    most: float = 1.0

    @property
    def are_open(self) -> bool:
        """Whether a resistance at the rings is unknown."""
        return self.least < self.most


def turns_ratio(motor: Motor) -> float:
    """Return the turns of a stator winding over those of a rotor phase in star.

    Parameters
    ----------
    motor : Motor
        A motor with a wound rotor.

    Returns
    -------
    float
        The ratio u.

    Raises
    ------
    ValueError
        If the motor has a cage.
    """
    rotor, machine = motor.wound_rotor, motor.parameters
    if rotor is None:
        raise ValueError(f"turns ratio: expected a wound rotor, found the cage of {motor.name}")
    linked = machine.magnetising_inductance_H / (machine.stator_leakage_H + machine.magnetising_inductance_H)
    return sqrt(3.0) * motor.nameplate.winding_voltage_V * linked / rotor.open_circuit_voltage_V


def external_resistance_ohm(motor: Motor) -> tuple[float, float]:
    """Return the least and the largest resistance at the rings of a running motor, referred to the stator.

    Parameters
    ----------
    motor : Motor
        The motor, as its file has it.

    Returns
    -------
    tuple of float
        The ends of u^2 R_ext [ohm]; zero of a cage.
    """
    if motor.wound_rotor is None:
        return 0.0, 0.0
    square = turns_ratio(motor) ** 2
    least, most = motor.wound_rotor.external_resistance_ohm
    return square * least, square * most


def while_running(motor: Motor) -> Motor:
    """Return the motor with the resistance that its rotor circuit has while it runs.

    Parameters
    ----------
    motor : Motor
        The motor, as its file has it; its rotor resistance is that with shorted rings.

    Returns
    -------
    Motor
        The motor with the middle of what the resistance may be, and with the tolerance that holds all of it.
        A cage, and a wound rotor with shorted rings, are as they were.
    """
    least, most = external_resistance_ohm(motor)
    if most == 0.0:
        return motor
    R_r, tolerance = motor.parameters.rotor_resistance_ohm, motor.tolerances.rotor_resistance_ohm
    middle = R_r + 0.5 * (least + most)
    if least < most:
        tolerance = min(tolerance + 0.5 * (most - least) / middle, MOST_SHARE)
    return replace(
        motor,
        parameters=replace(motor.parameters, rotor_resistance_ohm=middle),
        tolerances=replace(motor.tolerances, rotor_resistance_ohm=tolerance),
    )


def resistance_ratios(running: Motor) -> ResistanceRatios:
    """Return what the resistance of a running motor's rotor circuit may be, over the assumed one.

    Parameters
    ----------
    running : Motor
        The motor, as `while_running` returns it.

    Returns
    -------
    ResistanceRatios
        Both 1 of a cage, and where the resistance at the rings is known.
    """
    least, most = external_resistance_ohm(running)
    if least == most:
        return ResistanceRatios()
    off = 0.5 * (most - least) / running.parameters.rotor_resistance_ohm
    return ResistanceRatios(1.0 - off, 1.0 + off)


def resistance_at_rings_ohm(running: Motor, ratio: float) -> float:
    """Return the resistance at the rings where that of the rotor circuit is known.

    Parameters
    ----------
    running : Motor
        The motor, as `while_running` returns it.
    ratio : float
        Resistance of the rotor circuit over the assumed one: as the slips are.

    Returns
    -------
    float
        R_ext [ohm a phase], at the rings; below zero where the winding is colder than assumed.
    """
    least, most = external_resistance_ohm(running)
    assumed = running.parameters.rotor_resistance_ohm
    R_r = assumed - 0.5 * (least + most)
    return (ratio * assumed - R_r) / turns_ratio(running) ** 2
