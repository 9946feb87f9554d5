"""The rotor circuit of a wound rotor, with what is connected to its rings."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from core.machines.wound_rotor import (
    resistance_at_rings_ohm,
    resistance_ratios,
    turns_ratio,
    while_running,
)
from ied_sim.motor.windings import winding_circuit
from testing.machines.motors import MEDIUM
from testing.machines.wound_rotors import HOIST, HOIST_WITH_UNKNOWN_RESISTANCE, ROTOR


def test_open_rings_show_the_voltage_of_the_plate() -> None:
    """The winding circuit in phase variables, its rotor open, at standstill on rated voltage."""
    nameplate = HOIST.nameplate
    circuit = winding_circuit(HOIST)
    w = 2j * pi * nameplate.rated_frequency_Hz
    phases_V = 400.0 / np.sqrt(3.0) * np.exp(-2j * pi / 3.0 * np.arange(3))
    L, R = circuit.inductance(0.0), circuit.resistance
    stator, rotor = slice(0, 2), slice(2, 4)
    q = np.linalg.solve(R[stator, stator] + w * L[stator, stator], circuit.drive[stator] @ phases_V)
    phase_b_less_c_V, phase_a_less_c_V = (w * L[rotor, stator] @ q)[::-1]
    between_rings_V = abs(phase_a_less_c_V - phase_b_less_c_V)
    assert between_rings_V / turns_ratio(HOIST) == pytest.approx(ROTOR.open_circuit_voltage_V, rel=1e-3)


def test_a_cage_and_shorted_rings_leave_a_motor_as_it_is() -> None:
    for motor in (MEDIUM, HOIST):
        assert while_running(motor) is motor
        assert not resistance_ratios(motor).are_open


def test_a_known_resistance_is_in_the_rotor_circuit() -> None:
    motor = replace(HOIST, wound_rotor=replace(ROTOR, external_resistance_ohm=(0.2, 0.2)))
    running = while_running(motor)
    added = running.parameters.rotor_resistance_ohm - HOIST.parameters.rotor_resistance_ohm
    assert added == pytest.approx(turns_ratio(HOIST) ** 2 * 0.2)
    assert running.tolerances == HOIST.tolerances
    assert not resistance_ratios(running).are_open


def test_an_unknown_resistance_is_within_the_tolerance() -> None:
    running = while_running(HOIST_WITH_UNKNOWN_RESISTANCE)
    least, most = resistance_ratios(running)
    R_r = HOIST.parameters.rotor_resistance_ohm
    R = running.parameters.rotor_resistance_ohm
    assert (least * R, most * R) == pytest.approx((R_r, R_r + turns_ratio(HOIST) ** 2 * 0.35))
    assert running.tolerances.rotor_resistance_ohm >= most - 1.0
    assert resistance_at_rings_ohm(running, least) == pytest.approx(0.0, abs=1e-12)
    assert resistance_at_rings_ohm(running, most) == pytest.approx(0.35)


def test_a_cage_has_no_turns_ratio() -> None:
    with pytest.raises(ValueError, match="expected a wound rotor"):
        turns_ratio(MEDIUM)
