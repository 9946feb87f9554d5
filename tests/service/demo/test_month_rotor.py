"""The month's motor with a broken bar and the one with a pulsating load, each as a record tells it."""

import tomllib

import pytest

import scl
from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.machines.motor_file.reader import motor_from_table
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding, RotorState
from core.units import SECONDS_PER_DAY
from ied_sim.scenario.scenario import read_scenario
from service.demo import MONTH, MOTORS
from testing.machines.disturbed_records import record_of

FEEDERS = {feeder.ied: feeder.motor for feeder in scl.read(scl.DEMO_PLANT_SCD).feeders()}


def found(ied: str, day: float) -> RotorFinding:
    """What the relay's record of that day tells of the rotor, by the parameters that the service has."""
    relay = read_scenario(MONTH)[ied]
    recorder = relay.recorder
    duration_s = recorder.pre_trigger_s + recorder.post_trigger_s
    assert duration_s == pytest.approx(1.28), "64 cycles"
    samples = relay.plant.window(day * SECONDS_PER_DAY, duration_s, recorder.sample_rate_hz)
    tables = tomllib.loads(MOTORS.read_text(encoding="utf-8"))["motor"]
    (table,) = (each for each in tables if each["name"] == FEEDERS[ied])
    parts = {name: table[name] for name in ("nameplate", "parameters")}
    motor = motor_from_table(parts, name=FEEDERS[ied], source=MOTORS)
    acceptance = accept(record_of(samples, recorder.sample_rate_hz), motor)
    assert acceptance.accepted is not None, acceptance.quality
    accepted = acceptance.accepted
    return examine_rotor(baseband_of(accepted), accepted, diagnose_accepted(acceptance))


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
