"""What happens within a record is named, and the longest stretch in which nothing happens is diagnosed."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Motor
from core.operation import Operation
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant
from ied_sim.motor.supply import Supply, SupplyEvent
from testing.machines.disturbed_records import record_of
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from tests.ied_sim.motor.plants import plant, short

RATE_HZ = 4_000.0
Array = NDArray[np.float64]


def diagnosed(samples: Array, motor: Motor) -> Diagnosis:
    """The diagnosis of samples."""
    return diagnose(record_of(samples, RATE_HZ), motor)


def warnings(found: Diagnosis) -> str:
    """What the quality gate tells of a record that passed."""
    return "; ".join(one.message for one in found.quality if one.is_warning)


def is_right(found: Diagnosis, *, faulty: bool) -> bool:
    """Whether a record with 5 % of phase b shorted is called, and one without is not."""
    if not faulty:
        return found.verdict is Verdict.HEALTHY
    return found.verdict is Verdict.FAULT and found.phase == "b"


def window(one: MotorPlant, duration_s: float = 0.5) -> Array:
    """Samples of a record."""
    return one.window(0.0, duration_s, RATE_HZ)


@pytest.mark.parametrize("motor", [MEDIUM, LARGE])
@pytest.mark.parametrize("faulty", [False, True])
def test_a_stop_in_the_last_cycle(motor: Motor, faulty: bool) -> None:
    running = plant(motor, fault=short(0.05) if faulty else None)
    found = diagnosed(window(replace(running, contactor=Contactor(opens_s=0.488))), motor)
    assert is_right(found, faulty=faulty)
    assert found.operation is Operation.STOP
    assert "switched off 12 ms before the end" in warnings(found)


@pytest.mark.parametrize("sequence", ["abc", "acb"])
@pytest.mark.parametrize("faulty", [False, True])
def test_a_dip(sequence: str, faulty: bool) -> None:
    dip = SupplyEvent(0.25, 0.1, 0.9)
    supply = Supply(400.0, 50.0, events=(dip,), sequence="acb" if sequence == "acb" else "abc")
    found = diagnosed(window(plant(MEDIUM, supply=supply, fault=short(0.05) if faulty else None)), MEDIUM)
    assert is_right(found, faulty=faulty)
    assert "the voltage dips to 90% at 0.2" in warnings(found)


def test_a_dip_in_a_short_record_is_named_and_nothing_is_diagnosed() -> None:
    supply = Supply(400.0, 50.0, events=(SupplyEvent(0.1, 0.08, 0.85),))
    found = diagnosed(window(plant(MEDIUM, supply=supply), 0.25), MEDIUM)
    assert found.verdict is Verdict.UNDIAGNOSABLE
    assert "the voltage dips to 85%" in found.reasons[0]
    assert "record again" in found.reasons[0]


@pytest.mark.parametrize("motor", [REFERENCE, MEDIUM, LARGE])
def test_a_fuse_that_blows_is_named_and_never_healthy_running(motor: Motor) -> None:
    ohm = 30.0 * motor.nameplate.rated_voltage_V**2 / motor.nameplate.rated_power_W
    running = plant(motor)
    before, behind = window(running), window(replace(running, joint=JointCourse(1, ((0.0, ohm),))))
    samples = np.concatenate((before[:, :1_400], behind[:, 1_400:]), axis=1)
    found = diagnosed(samples, motor)
    assert found.verdict is Verdict.HEALTHY
    assert "phase b carries no current from 0.3" in warnings(found)
    late = diagnosed(np.concatenate((before[:, :400], behind[:, 400:900]), axis=1), motor)
    assert late.verdict is Verdict.UNDIAGNOSABLE


@pytest.mark.parametrize(
    ("pulsation", "duration_s"),
    [
        (Pulsation(0.5, per_turn=1.0), 0.5),
        (Pulsation(0.5, per_turn=0.5), 0.5),
        (Pulsation(0.4, frequency_Hz=3.0), 1.0),
    ],
)
@pytest.mark.parametrize("faulty", [False, True])
def test_a_pulsating_load_is_diagnosed(pulsation: Pulsation, duration_s: float, faulty: bool) -> None:
    load = Load(0.6, pulsations=(pulsation,))
    for motor in (MEDIUM, LARGE):
        running = plant(motor, load=load, fault=short(0.05) if faulty else None)
        assert is_right(diagnosed(window(running, duration_s), motor), faulty=faulty)


def test_a_slow_swing_is_told_how_long_a_record_it_takes() -> None:
    load = Load(0.6, pulsations=(Pulsation(0.5, frequency_Hz=1.2),))
    found = diagnosed(window(plant(MEDIUM, load=load), 0.4), MEDIUM)
    assert found.verdict is Verdict.UNDIAGNOSABLE
    assert "the load swings" in found.reasons[0] or "the load changes" in found.reasons[0]
