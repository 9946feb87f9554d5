"""The circle on which a motor's current lies whatever its load (Heyland and Ossanna's circle diagram)."""

from dataclasses import dataclass

from core.machines.parameters import MachineParameters


@dataclass(frozen=True, slots=True)
class CurrentLocus:
    """Circle of the admittance I1 / V1 of a winding over the slip.

    Parameters
    ----------
    centre : complex
        Centre [S].
    radius : float
        Radius [S].
    """

    centre: complex
    radius: float

    def distance(self, admittance: complex) -> float:
        """Return how far an admittance lies outside the circle; below zero inside it.

        Parameters
        ----------
        admittance : complex
            I1 / V1 [S].

        Returns
        -------
        float
            Distance [S].
        """
        return abs(admittance - self.centre) - self.radius


def current_locus(machine: MachineParameters, angular_frequency: float) -> CurrentLocus:
    """Return the circle of a healthy machine's admittance to the positive sequence.

    The admittance is a Moebius transform of s / R_r', so it moves on a circle as the slip goes from zero to
    infinity. The rotor's resistance is not in the circle: it only says where on it a slip lies.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    angular_frequency : float
        Angular frequency of the supply [rad/s].

    Returns
    -------
    CurrentLocus
        The circle through no load, a rotor without resistance, and a point between.
    """
    w = angular_frequency
    stator = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    magnetising = 1j * w * machine.magnetising_inductance_H
    leakage = 1j * w * machine.rotor_leakage_H
    between = w * (machine.stator_leakage_H + machine.rotor_leakage_H)

    def with_rotor(impedance: complex) -> complex:
        return 1.0 / (stator + magnetising * impedance / (magnetising + impedance))

    no_load, no_resistance = 1.0 / (stator + magnetising), with_rotor(leakage)
    centre = _centre(no_load, with_rotor(between + leakage), no_resistance)
    return CurrentLocus(centre, abs(no_load - centre))


def _centre(a: complex, b: complex, c: complex) -> complex:
    """Return the centre of the circle through three points."""
    p, q = a - c, b - c
    twice_area = (p.conjugate() * q).imag
    return c - 1j * (abs(p) ** 2 * q - abs(q) ** 2 * p) / (2.0 * twice_area)
