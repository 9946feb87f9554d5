"""The circuit that terminals tell, against the T circuit written out."""

from math import pi

import numpy as np
import pytest

from core.machines.parameters import MachineParameters, Motor
from core.tracking.circuit import distance_from_circle, terminal_circuit
from testing.machines.motors import ALL

FREQUENCIES_HZ = (49.0, 50.0, 60.0)
SLIPS = (1e-4, 0.01, 0.05, 0.3, 1.0)


def t_circuit(machine: MachineParameters, w: float, slip: float) -> complex:
    rotor = machine.rotor_resistance_ohm / slip + 1j * w * machine.rotor_leakage_H
    magnetising = 1j * w * machine.magnetising_inductance_H
    stator = machine.stator_resistance_ohm + 1j * w * machine.stator_leakage_H
    return stator + rotor * magnetising / (rotor + magnetising)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_the_circuit_shows_the_impedance_of_the_t_circuit(motor: Motor) -> None:
    circuit = terminal_circuit(motor.parameters)
    for w in (2.0 * pi * f for f in FREQUENCIES_HZ):
        for slip in SLIPS:
            expected = t_circuit(motor.parameters, w, slip)
            assert circuit.impedance(w, circuit.R_R / slip) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
def test_every_load_lies_on_the_circle(motor: Motor) -> None:
    circuit, w = terminal_circuit(motor.parameters), 2.0 * pi * 50.0
    for slip in SLIPS:
        Z = t_circuit(motor.parameters, w, slip)
        distance, _ = distance_from_circle(Z, circuit.R_s, w * circuit.L_sigma, w * circuit.L_M)
        assert abs(distance) < 1e-9 * abs(Z)


def test_the_slopes_are_those_of_the_distance() -> None:
    figures, Z, step = np.array([8.0, 20.0, 190.0]), 90.0 + 70.0j, 1e-6
    here, slopes = distance_from_circle(Z, *figures)
    for k, slope in enumerate(slopes.tolist()):
        moved = figures + step * np.eye(3)[k]
        assert slope == pytest.approx((distance_from_circle(Z, *moved)[0] - here) / step, abs=1e-6)
