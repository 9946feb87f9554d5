"""Relay, feeder and motor connected other than the motor's file says: named, and never a false fault."""

from dataclasses import replace
from typing import Literal

import pytest

from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Connection, CurrentPosition, Motor
from ied_sim.motor.feeder import Capacitors, Feeder, OtherMotor
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant
from testing.machines.disturbed_records import record_of
from testing.machines.motors import LARGE, MEDIUM
from testing.machines.slot_fault_records import USUAL, drawn_case, with_other_parameters
from tests.ied_sim.motor.plants import plant, short

RATE_HZ = 4_000.0
MAGNETISING_KVAR = 3e-3 * 230.9**2 / (314.16 * (1.5 * 0.08273 + 0.003045))
"""Of the 7.5 kW motor without load."""


def diagnosed(running: MotorPlant, motor: Motor) -> Diagnosis:
    """The diagnosis of a record of a plant."""
    return diagnose(record_of(running.window(0.0, 0.5, RATE_HZ), RATE_HZ), motor)


def words(found: Diagnosis) -> str:
    """All reasons."""
    return "; ".join(found.reasons)


@pytest.mark.parametrize("share", [0.4, 0.9])
@pytest.mark.parametrize("load", [0.3, 0.8])
@pytest.mark.parametrize("connection", list(Connection))
def test_capacitors_that_the_file_has_not(share: float, load: float, connection: Connection) -> None:
    feeder = Feeder(Capacitors(share * MAGNETISING_KVAR, connection))
    found = diagnosed(replace(plant(MEDIUM, level=load), feeder=feeder), MEDIUM)
    assert found.verdict in {Verdict.WATCH, Verdict.UNDIAGNOSABLE}
    assert "capacitors" in words(found)
    assert "[capacitors]" in words(found)
    if found.verdict is Verdict.WATCH:
        assert found.load_level == pytest.approx(load, abs=0.12)
        lost = Feeder(Capacitors(share * MAGNETISING_KVAR, connection, 1, ((0.0, 1.0),)))
        assert diagnosed(replace(plant(MEDIUM, level=load), feeder=lost), MEDIUM).verdict is not Verdict.FAULT


def test_shorted_turns_beside_capacitors_that_the_file_has_not() -> None:
    called = 0
    for seed in range(30, 36):
        case = drawn_case(seed, level=0.05, power_kW=7.5, poles=4, sensors=USUAL, most_path_ratio=1.0)
        assert case.fault is not None
        bank = Capacitors(0.7 * MAGNETISING_KVAR)
        motor = replace(with_other_parameters(case.motor, seed), sensors=USUAL)
        found = diagnosed(replace(case.plant(), feeder=Feeder(bank)), motor)
        assert found.verdict in {Verdict.WATCH, Verdict.FAULT}
        if found.verdict is Verdict.FAULT:
            called += 1
            assert found.phase in {"abc"[case.fault.phase], None}
    assert called >= 3


@pytest.mark.parametrize("load", [0.3, 0.6])
def test_two_motors_are_asked_for(load: float) -> None:
    feeder = Feeder(other_motor=OtherMotor(MEDIUM, Load(load)))
    found = diagnosed(replace(plant(MEDIUM, level=0.7), feeder=feeder), MEDIUM)
    assert found.verdict is Verdict.WATCH
    assert "two motors behind the relay?" in words(found)


@pytest.mark.parametrize(("sequence", "load"), [("abc", 0.3), ("abc", 0.8), ("acb", 0.3)])
def test_transformers_inside_the_delta(sequence: Literal["abc", "acb"], load: float) -> None:
    inside = replace(plant(LARGE, level=load), feeder=Feeder(inside_delta=True))
    inside = replace(inside, supply=replace(inside.supply, sequence=sequence))
    found = diagnosed(inside, LARGE)
    assert found.verdict is Verdict.UNDIAGNOSABLE
    assert 'ct_position = "inside-delta"' in words(found)
    faulty = replace(inside, fault=short(0.05))
    assert "inside the delta" in words(diagnosed(faulty, LARGE))
    told = replace(
        LARGE, transformers=replace(LARGE.transformers, current_position=CurrentPosition.INSIDE_DELTA)
    )
    assert diagnosed(inside, told).verdict is Verdict.HEALTHY
    assert diagnosed(faulty, told).verdict is Verdict.FAULT


@pytest.mark.parametrize("load", [0.05, 0.2])
def test_a_motor_that_stays_in_star(load: float) -> None:
    star = replace(LARGE, nameplate=replace(LARGE.nameplate, connection=Connection.STAR))
    found = diagnosed(plant(star, level=load), LARGE)
    assert found.verdict is Verdict.UNDIAGNOSABLE
    assert "in star" in words(found)


@pytest.mark.parametrize("load", [-0.4, -0.6])
def test_a_motor_that_generates(load: float) -> None:
    found = diagnosed(plant(MEDIUM, load=Load(load)), MEDIUM)
    assert found.verdict is Verdict.UNDIAGNOSABLE
    assert "generates" in words(found)


@pytest.mark.parametrize("motor", [MEDIUM, LARGE])
@pytest.mark.parametrize("load", [0.1, 0.5, 1.0])
def test_a_motor_as_its_file_says_is_taken_as_that(motor: Motor, load: float) -> None:
    sound = diagnosed(plant(motor, level=load), motor)
    assert sound.verdict is Verdict.HEALTHY
    assert not any(one in words(sound) for one in ("capacitors", "two motors", "in star", "inside"))
    assert diagnosed(plant(motor, level=load, fault=short(0.05)), motor).verdict is Verdict.FAULT
