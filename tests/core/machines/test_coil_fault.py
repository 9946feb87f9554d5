"""The closed form of shorted turns at one slip, against the steady state of the models at great inertia."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from core.machines.base import StatorModel
from core.machines.candidates import Candidates
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents
from core.machines.parameters import Connection, Motor
from core.machines.running import SteadyRunning
from core.machines.shorted_winding import ShortedWinding
from core.machines.split_winding import SplitWinding
from testing.machines.motors import LARGE, MEDIUM, REFERENCE, VERY_LARGE

MOTORS = [
    replace(motor, nameplate=replace(motor.nameplate, connection=connection))
    for motor in (REFERENCE, MEDIUM, LARGE, VERY_LARGE)
    for connection in Connection
]
GREAT_INERTIA = 1e12
"""Over the motor's own: the speed has no ripple."""
UNBALANCE = 0.03 * np.exp(1.1j)


class Turns(NamedTuple):
    """Level m, leakage psi, axis [rad] and linkage of shorted turns in one winding."""

    level: float
    leakage: float
    axis_rad: float
    linkage: float
    winding: int


def of_the_model(model: StatorModel, motor: Motor, turns: Turns, load: float) -> tuple[SequencePair, float]:
    """Currents over the positive sequence of the voltage, and the slip."""
    heavy = replace(
        motor,
        parameters=replace(motor.parameters, inertia_kgm2=GREAT_INERTIA * motor.parameters.inertia_kgm2),
    )
    volts, w_s = motor.nameplate.winding_voltage_V, motor.nameplate.rated_angular_frequency
    phasor = np.sqrt(3.0) * volts * np.array([1.0 + UNBALANCE, -1j * (1.0 - UNBALANCE)])
    one = np.ones(1)
    state = SteadyRunning(model, heavy, w_s, phasor).state(
        Candidates(
            turns.level * one, np.array([turns.winding]), load * one, 0.0 * one, leakage=turns.leakage * one,
            axis_rad=turns.axis_rad * one, linkage=turns.linkage * one,
        )
    )  # fmt: skip
    assert state.balanced[0]
    alpha, beta = state.current[:, 0] / (2.0 * np.sqrt(3.0) * volts)
    return SequencePair(alpha + 1j * beta, alpha - 1j * beta), float(1.0 - state.mean_speed[0] / w_s)


def of_the_closed_form(motor: Motor, turns: Turns, slip: float) -> SequencePair:
    machine, w_s = motor.parameters, motor.nameplate.rated_angular_frequency
    R_s, X_ls = machine.stator_resistance_ohm, w_s * machine.stator_leakage_H
    gap = air_gap(
        complex(R_s, X_ls), w_s * machine.magnetising_inductance_H, machine.rotor_resistance_ohm,
        w_s * machine.rotor_leakage_H, slip,
    )  # fmt: skip
    ahead = complex(turns.linkage * np.exp(1j * turns.axis_rad))
    circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    return faulty_currents(
        gap, SequencePair(1.0 + 0j, complex(UNBALANCE)), complex(R_s, turns.leakage * X_ls) / turns.level,
        ahead, ahead.conjugate(), circulating, turns.winding,
    )  # fmt: skip


def assert_same(found: SequencePair, expected: SequencePair, within: float) -> None:
    allowed = within * abs(expected.positive)
    assert abs(found.positive - expected.positive) < allowed
    assert abs(found.negative - expected.negative) < allowed


@pytest.mark.parametrize(
    "motor", MOTORS, ids=[f"{motor.name}, {motor.nameplate.connection}" for motor in MOTORS]
)
@pytest.mark.parametrize("winding", [0, 1, 2])
def test_the_closed_form_is_the_split_winding_at_great_inertia(motor: Motor, winding: int) -> None:
    for level in (1e-4, 0.01, 0.05, 0.2):
        for over_level in (1.2, 12.0):
            for axis_rad in (-0.4, 0.0, 0.15):
                for linkage in (0.97, 1.0, 1.05):
                    turns = Turns(level, min(over_level * level, 1.5), axis_rad, linkage, winding)
                    expected, slip = of_the_model(SplitWinding(), motor, turns, 0.4)
                    assert_same(of_the_closed_form(motor, turns, slip), expected, 1e-8)


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize("level", [1e-3, 0.05, 0.2])
def test_turns_on_their_phases_axis_with_their_leakage_to_themselves_are_tallams(
    motor: Motor, winding: int, level: float
) -> None:
    turns = Turns(level, 1.0, 0.0, 1.0, winding)
    expected, slip = of_the_model(SplitWinding(), motor, turns, 0.8)
    assert_same(of_the_closed_form(motor, turns, slip), expected, 1e-8)


@pytest.mark.parametrize("motor", [MEDIUM, LARGE], ids=lambda motor: motor.name)
@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize("mu", [1e-3, 0.05, 0.2])
def test_the_additional_winding_of_the_thesis_is_the_limit_of_a_great_linkage(
    motor: Motor, winding: int, mu: float
) -> None:
    """Its turns do not see the phase's drop: m = mu k_d^2 and psi = mu, as k_d goes to 0."""
    k_d = 1e-9
    expected, slip = of_the_model(ShortedWinding(), motor, Turns(mu, 1.0, 0.0, 1.0, winding), 0.6)
    limit = Turns(mu * k_d**2, mu, 0.0, 1.0 / k_d, winding)
    assert_same(of_the_closed_form(motor, limit, slip), expected, 1e-8)


@pytest.mark.parametrize("winding", [0, 1, 2])
def test_a_coil_ahead_of_its_phase_turns_i2_back_by_less_than_twice_its_angle(winding: int) -> None:
    """By -1.4 delta: the stator's leakage keeps the axis of the phase. The change of I1 keeps its angle."""
    slip, level, delta = 0.02, 1e-6, np.radians(20.0)
    sound, aligned, ahead = (
        of_the_closed_form(MEDIUM, Turns(m, 0.1, axis_rad, 1.0, winding), slip)
        for m, axis_rad in ((1e-15, 0.0), (level, 0.0), (level, delta))
    )
    turned = [
        float(np.degrees(np.angle((getattr(ahead, one) - getattr(sound, one))
                                  / (getattr(aligned, one) - getattr(sound, one)))))
        for one in ("positive", "negative")
    ]  # fmt: skip
    assert turned[0] == pytest.approx(0.0, abs=1.0)
    assert turned[1] == pytest.approx(-1.4 * 20.0, abs=2.0)
