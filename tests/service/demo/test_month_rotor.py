"""The month's motor with a broken bar and the one with a pulsating load, as their records tell it."""

import tomllib
from collections.abc import Sequence
from dataclasses import replace

import pytest

import scl
from core.classification.classification import Classification
from core.classification.motor import MotorEvidence, classify_motor
from core.classification.record_answer import RecordAnswer
from core.condition.kinds import Kind, State
from core.diagnosis.acceptance import accept
from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose_accepted
from core.findings.examining import examine
from core.machines.motor_file.reader import motor_from_table
from core.machines.parameters import Motor
from core.recordings import Recording
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.trend import JudgedRecord, rotor_condition
from core.units import NANOSECONDS_PER_DAY, SECONDS_PER_DAY
from ied_sim.scenario.scenario import read_scenario
from service.demo import MONTH, MOTORS
from testing.machines.disturbed_records import record_of

BEGAN_NS = 1_790_000_000_000_000_000
FEEDERS = {feeder.ied: feeder.motor for feeder in scl.read(scl.DEMO_PLANT_SCD).feeders()}


def recorded(ied: str, day: float) -> tuple[Recording, Motor]:
    """The relay's record of that day, and the motor with the parameters that the service has."""
    relay = read_scenario(MONTH)[ied]
    recorder = relay.recorder
    duration_s = recorder.pre_trigger_s + recorder.post_trigger_s
    assert duration_s == pytest.approx(1.28), "64 cycles"
    samples = relay.plant.window(day * SECONDS_PER_DAY, duration_s, recorder.sample_rate_hz)
    tables = tomllib.loads(MOTORS.read_text(encoding="utf-8"))["motor"]
    (table,) = (each for each in tables if each["name"] == FEEDERS[ied])
    parts = {name: table[name] for name in ("nameplate", "parameters")}
    motor = motor_from_table(parts, name=FEEDERS[ied], source=MOTORS)
    record = record_of(samples, recorder.sample_rate_hz)
    return replace(record, start_time_ns=BEGAN_NS + round(day * NANOSECONDS_PER_DAY)), motor


def found(ied: str, day: float) -> RotorFinding:
    """What the record of that day tells of the rotor."""
    acceptance = accept(*recorded(ied, day))
    assert acceptance.accepted is not None, acceptance.quality
    accepted = acceptance.accepted
    return examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(acceptance))


def answer_of(ied: str, days: Sequence[float]) -> Classification:
    """What is said of the motor by its records of these days, the latest of a month without alarm."""
    records, cage, levels = [], [], []
    for day in days:
        record, motor = recorded(ied, day)
        examined = examine(record, motor)
        records.append(RecordAnswer.from_dict(examined.classification.as_dict()))
        rotor = examined.rotor
        assert rotor.severity_dB is not None
        assert rotor.severity_dB_ci95 is not None
        assert rotor.load_level is not None
        levels.append(rotor.load_level)
        cage.append(
            JudgedRecord(rotor.state, rotor.severity_dB, rotor.severity_dB_ci95, None, load_swings=False)
        )
    return classify_motor(
        MotorEvidence(
            state=State.HEALTHY,
            kind=Kind.NONE,
            candidates=(),
            phase=None,
            rotor=rotor_condition(cage, since_ns=None, bins=()),
            records=records,
            load_levels=levels,
        )
    )


@pytest.mark.parametrize(
    ("ied", "days", "causes"),
    [
        ("A1_SEL710", [5.5, 6.5, 7.5], set()),
        ("A1_SEL710", [27.5, 28.5, 29.5], {Cause.ROTOR}),
        ("B1_SEL710", [27.5, 28.5, 29.5], {Cause.PULSATION}),
    ],
    ids=["sound", "broken bar", "belt"],
)
def test_what_is_there_is_the_answer(ied: str, days: Sequence[float], causes: set[Cause]) -> None:
    answer = answer_of(ied, days)
    assert answer.is_told, answer.words
    assert answer.answer.causes == causes


@pytest.mark.parametrize(
    ("day", "state"), [(2.5, RotorState.HEALTHY), (7.0, RotorState.HEALTHY), (17.0, RotorState.FAULT)]
)
def test_the_broken_bar_shows_once_it_is_broken(day: float, state: RotorState) -> None:
    assert found("A1_SEL710", day).state is state


@pytest.mark.parametrize("day", [2.5, 14.5, 29.0])
def test_the_pulsating_load_is_told_as_that(day: float) -> None:
    finding = found("B1_SEL710", day)
    assert finding.state is RotorState.HEALTHY
    assert finding.lower_sideband_dB is not None
    assert finding.lower_sideband_dB > -35.0, "as large as that of a broken bar"
    assert any("load oscillation" in reason for reason in finding.reasons)
