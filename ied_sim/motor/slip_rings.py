"""Slip rings of a wound rotor: what a brush adds to each phase, and a resistance outside that steps down.

Resistances are those of the rotor's own turns. The ratio of turns to the stator's follows from the voltage
between the open rings at standstill: the stator then carries its magnetising current alone, whose field
induces that voltage.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, inf, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from ied_sim.motor.course import Points, value_at
from ied_sim.motor.rotor import FLOATING_POINT

Matrix = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SlipRings:
    """What is connected to the three ends of a rotor winding in star.

    Parameters
    ----------
    turns_ratio : float
        Turns of a stator winding over those of a rotor phase.
    contacts_ohm : tuple of float
        What brushes, rings and joints add to each phase.
    external_ohm : float or Points
        Resistance of each phase outside while the motor runs, or its course over time; 0 for shorted rings.
    start_steps : tuple of (float, float)
        Resistances of a start: from so many seconds after the contactor's closing on, so many ohm. The last
        one stays until `start_ends_s`; then comes `external_ohm`.
    start_ends_s : float
        Time after the closing at which the start's resistance is out of the circuit.
    """

    turns_ratio: float
    contacts_ohm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    external_ohm: float | Points = 0.0
    start_steps: tuple[tuple[float, float], ...] = ()
    start_ends_s: float = 0.0

    @property
    def switching_s(self) -> tuple[float, ...]:
        """Times after the contactor's closing at which the resistance changes."""
        return (*(after_s for after_s, _ in self.start_steps if after_s > 0), self.start_ends_s)

    def outside_ohm(self, time_s: float, since_closing_s: float = inf) -> float:
        """Return the resistance of each phase outside the motor."""
        begun = [ohm for after_s, ohm in self.start_steps if after_s <= since_closing_s]
        if begun and since_closing_s < self.start_ends_s:
            return begun[-1]
        outside = self.external_ohm
        return value_at(outside, time_s) if isinstance(outside, tuple) else outside

    def added_resistance(self, time_s: float, since_closing_s: float = inf) -> Matrix:
        """Return what is added to the resistance of the rotor's two loops, referred to the stator [ohm]."""
        phases = np.array(self.contacts_ohm) + self.outside_ohm(time_s, since_closing_s)
        added: Matrix = self.turns_ratio**2 * FLOATING_POINT.T @ np.diag(phases) @ FLOATING_POINT
        return added


def sections(
    rings: SlipRings | None, late_s: float, samples: int, sample_rate_hz: float
) -> Iterator[tuple[float, int, int]]:
    """Yield the stretches of a start between two steps; the first sample comes `late_s` after the closing.

    A stretch has a time after the closing at which its resistance is in the circuit, its first sample, and
    its last one, at which the next begins.
    """
    begins = {0: 0.0}
    for after_s in () if rings is None else rings.switching_s:
        begins[max(0, ceil((after_s - late_s) * sample_rate_hz))] = after_s
    edges = [*sorted(one for one in begins if one < samples - 1 or one == 0), samples - 1]
    for first, last in pairwise(edges):
        yield begins[first], first, last


def turns_ratio(motor: Motor, open_circuit_voltage_V: float) -> float:
    """Return the turns of a stator winding over those of a rotor phase, by the voltage of the open rings."""
    nameplate, machine = motor.nameplate, motor.parameters
    w, L_m = 2 * pi * nameplate.rated_frequency_Hz, machine.magnetising_inductance_H
    impedance = complex(machine.stator_resistance_ohm, w * (machine.stator_leakage_H + L_m))
    induced_V = nameplate.winding_voltage_V * w * L_m / abs(impedance)
    return sqrt(3) * induced_V / open_circuit_voltage_V
