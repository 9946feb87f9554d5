"""Starts of a wound rotor by steps of resistance, simulated with three rotor coils in phase variables."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.commissioning.commissioning import commission
from core.commissioning.start_detection import start_of
from core.commissioning.stepped_start import half_intervals, stepped_start
from core.machines.candidates import LoadLaw
from core.machines.motor_file.reader import Plate
from core.machines.wound_rotor import turns_ratio
from core.recordings import Recording
from core.starts.examining import examine_start
from testing.machines.wound_rotors import HOIST, WoundRotorCase

STEPS = ((0.0, 1.0), (1.2, 0.45), (2.2, 0.18))
ADDED_INERTIA, LOAD = 1.5, 0.5


@cache
def _record(load_level: float = LOAD) -> Recording:
    case = WoundRotorCase(
        load_level=load_level, start_steps=STEPS, start_ends_s=3.0, inertia_kgm2=ADDED_INERTIA
    )
    return case.start(4.5)


@pytest.mark.parametrize("load_level", [0.2, 0.7])
def test_inertia_load_and_the_resistance_of_each_step_are_told(load_level: float) -> None:
    start = start_of(_record(load_level), HOIST.nameplate, HOIST.channels, by_steps=True)
    found = stepped_start(start.air_gap(HOIST.parameters), HOIST)
    assert found is not None
    assert found.begins_s == pytest.approx((0.0, 1.2, 2.2, 3.0), abs=0.01)
    assert found.load_law is LoadLaw.CONSTANT
    R_r, square = HOIST.parameters.rotor_resistance_ohm, turns_ratio(HOIST) ** 2
    true = np.array(
        [
            HOIST.parameters.inertia_kgm2 + ADDED_INERTIA,
            load_level * HOIST.nameplate.rated_torque_Nm,
            *(R_r + square * ohm for _, ohm in STEPS),
        ]
    )
    assert found.figures[:-1] == pytest.approx(true, rel=0.02)
    half = half_intervals(start, HOIST, found)[:-1]
    assert (np.abs(found.figures[:-1] - true) < half).all()
    assert (half < 0.15 * true).all()


def test_a_direct_start_has_no_steps() -> None:
    case = WoundRotorCase(load_level=0.2)
    start = start_of(case.start(1.5), HOIST.nameplate, HOIST.channels, by_steps=True)
    assert stepped_start(start.air_gap(HOIST.parameters), HOIST) is None


def test_commissioning_takes_the_inertia_and_leaves_what_steps_do_not_tell() -> None:
    wrong = replace(HOIST.parameters, inertia_kgm2=1.0)
    plate = Plate(
        HOIST.name,
        HOIST.nameplate,
        wrong,
        HOIST.channels,
        HOIST.limits,
        HOIST.sensors,
        wound_rotor=HOIST.wound_rotor,
    )
    found = commission([_record()], plate)
    assert found.identifiable
    assert set(found.fixed) == set(found.parameters) - {"inertia_kgm2"}
    inertia = found.parameters["inertia_kgm2"]
    assert inertia.ci95 is not None
    assert inertia.ci95[0] < HOIST.parameters.inertia_kgm2 + ADDED_INERTIA < inertia.ci95[1]
    assert found.motor.wound_rotor == HOIST.wound_rotor
    (start,) = found.starts
    assert start.load_level.value == pytest.approx(LOAD, abs=0.02)
    assert start.residual_share < 0.03
    assert "slip rings" in found.reasons[0]


def test_the_figures_of_a_start_by_steps_are_right() -> None:
    examined = examine_start(_record(), HOIST)
    assert examined.figures.acceleration_s == pytest.approx(3.1, abs=0.15)
    torque = examined.torque
    assert torque is not None
    assert torque.load_torque_Nm == pytest.approx(LOAD * HOIST.nameplate.rated_torque_Nm, rel=0.05)
    speeds = [one for one in torque.speed if one is not None]
    assert speeds[0] < 0.1
    assert speeds[-1] == pytest.approx(0.988, abs=0.005)
    assert examined.parameters is None
    assert "3 steps" in (examined.remark or "")
