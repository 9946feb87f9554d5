"""Scenario files: what they mean, and what is said of those that mean nothing."""

import re
import tomllib
from math import sqrt
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np
import pytest

import scl
from core.machines.parameters import Connection
from ied_sim.errors import ScenarioError
from ied_sim.misbehaviour import Kind
from ied_sim.relay.plant_clock import ClockSettings
from ied_sim.scenario import fault_tables, feeder_tables, moments, motor_tables, supply_tables, tables
from ied_sim.scenario.scenario import healthy_reference, read_clock, read_scenario
from ied_sim.toml_tables import Table

REPOSITORY = Path(__file__).parents[3]
DEMO = REPOSITORY / "service" / "demo" / "scenario.toml"

MINIMAL = """
[[motor]]
ied = "R1"
[motor.nameplate]
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2
connection = "star"
[motor.parameters]
stator_resistance_ohm = 8.4
rotor_resistance_ohm = 8.2
stator_leakage_H = 0.0328
rotor_leakage_H = 0.0328
stator_self_inductance_H = 0.4377
inertia_kgm2 = 0.0229
"""

LAP = """
[motor.winding]
kind = "lap"
slots = 36
coil_pitch_slots = 8
"""

HEALTHY: dict[str, object] = {
    "running": True,
    "mu_f": 0.0,
    "theta_f": None,
    "load_level": 0.5,
    "joint_ohm": 0.0,
    "broken_bars": 0.0,
    "bars": 28,
    "eccentricity": {"static": 0.0, "dynamic": 0.0},
    "pulsations": [],
    "channels": {},
}

BUS = """
[[bus]]
name = "MCC"
line_voltage_V = 400
frequency_Hz = 50
wander = { unbalance = 0.001 }
"""


def write(directory: Path, text: str) -> Path:
    path = directory / "scenario.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_motor_without_more_is_healthy_at_half_load_on_its_rated_supply(tmp_path: Path) -> None:
    relay = read_scenario(write(tmp_path, MINIMAL))["R1"]
    assert relay.plant.fault is None
    assert relay.plant.load.level == 0.5
    assert relay.plant.supply.line_voltage_V == 380
    assert relay.plant.supply.frequency_Hz == 50
    assert relay.recorder.capacity == 20
    assert relay.truth(0.0) == HEALTHY


def test_a_fault_of_the_relay_alone_needs_no_motor(tmp_path: Path) -> None:
    text = '[[motor]]\nied = "R1"\n[[motor.misbehaviour]]\nkind = "frozen"\n'
    relay = read_scenario(write(tmp_path, text), "rdre")["R1"]
    assert relay.profile.name == "rdre"
    assert relay.plant.motor == healthy_reference("R1").plant.motor
    assert [each.kind for each in relay.misbehaviour] == [Kind.FROZEN]
    half = MINIMAL[: MINIMAL.index("[motor.parameters]")]
    with pytest.raises(ScenarioError, match=r"\[motor R1\] \[parameters\]: expected a table"):
        read_scenario(write(tmp_path, half))


def test_the_documented_example_is_a_scenario(tmp_path: Path) -> None:
    page = (REPOSITORY / "docs" / "reference" / "scenario.md").read_text(encoding="utf-8")
    example, timeline, slip_rings = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    relay = read_scenario(write(tmp_path, example))["A2_SEL710"]
    assert relay.plant.supply.harmonics[0].order == 5
    assert relay.plant.sensors.current_delay_s == pytest.approx(41e-6)
    assert relay.plant.sensors.full_scale_A == 260
    truth = relay.truth(0.0)
    assert (truth["theta_f"], truth["coil"], truth["coil_axis_deg"]) == (1, 3, 20.0)
    assert truth["mu_f"] == pytest.approx(0.6 / 12)
    late = relay.truth(30 * 86400.0)
    assert late["joint_ohm"] == 0.01
    assert relay.truth(19.9 * 86400.0)["running"]
    assert not late["running"], "it was stopped on day 20"
    assert late["channels"] == {
        "IB": {"gain": 0.005, "delay_us": pytest.approx(10.0)},
        "VC": {"gain": pytest.approx(-0.005), "delay_us": pytest.approx(5.0)},
    }
    assert read_clock(write(tmp_path, example)) == ClockSettings(30.0, 8640.0, 5.0)
    assert read_clock(write(tmp_path, MINIMAL)) == ClockSettings()
    developing = read_scenario(write(tmp_path, MINIMAL + timeline))["R1"]
    assert developing.truth(0.0) == HEALTHY
    wound = read_scenario(write(tmp_path, WOUND + slip_rings))["R1"]
    assert wound.truth(0.0)["rotor_contacts_ohm"] == [0.02, 0.0, 0.0]
    assert developing.truth(900.0)["mu_f"] == pytest.approx(8.4 / (0.1 / 0.08**2 + 8.4 / 0.08))


def test_a_fault_in_a_coil_grows_by_shares_of_the_coil(tmp_path: Path) -> None:
    fault = """[motor.fault]
phase = "c"
coil = 7
path_ratio = 1.0
timeline = [{ at_s = 0, coil_share = 0 }, { at_s = 100, coil_share = 0.5 }]
"""
    for branches in (1, 2):
        text = MINIMAL + LAP + f"branches = {branches}\n" + fault
        relay = read_scenario(write(tmp_path, text))["R1"]
        assert relay.plant.fault_at(0.0) is None
        truth = relay.truth(100.0)
        assert truth["mu_f"] == pytest.approx(0.5 / 12 / 2)
        assert (truth["theta_f"], truth["coil"], truth["coil_axis_deg"]) == (2, 7, -20.0)
        assert relay.plant.circuit(100.0).loops > relay.plant.circuit(0.0).loops


def test_every_field_is_documented() -> None:
    page = (REPOSITORY / "docs" / "reference" / "scenario.md").read_text(encoding="utf-8")
    modules = (fault_tables, feeder_tables, moments, motor_tables, supply_tables, tables)
    sections = [found for module in modules for found in vars(module).values() if _is_table(found)]
    assert len(sections) > 20
    fields = {name for section in sections for name in section.model_fields}
    assert {name for name in fields if not re.search(rf"\b{name}\b", page)} == set()


def _is_table(found: object) -> bool:
    return isinstance(found, type) and issubclass(found, Table)


def test_the_demo_plant_is_what_it_says() -> None:
    scenarios = read_scenario(DEMO)
    assert list(scenarios) == [ied.name for ied in scl.read(scl.DEMO_PLANT_SCD).ieds]
    truths = {name: relay.truth(0.0) for name, relay in scenarios.items()}
    faults = {name: (truth["mu_f"], truth["theta_f"]) for name, truth in truths.items()}
    assert faults == {
        "A1_SEL710": (0.0, None),
        "A2_SEL710": (0.05, 1),
        "A3_SEL710": (0.0, None),
        "B1_SEL710": (0.04, 2),
        "B2_SEL710": (0.1, 0),
        "B3_SEL710": (0.0, None),
    }
    axes = {name: truth["coil_axis_deg"] for name, truth in truths.items() if "coil" in truth}
    assert axes == {"A2_SEL710": 20.0, "B1_SEL710": 7.5, "B2_SEL710": 0.0}
    assert truths["A1_SEL710"]["load_level"] == 0.8
    assert truths["B3_SEL710"]["load_level"] == 0.1
    assert scenarios["A3_SEL710"].plant.supply.unbalance == 0.03
    for name, relay in scenarios.items():
        acb = relay.plant.supply.sequence == "acb"
        assert acb == (name in {"B1_SEL710", "B3_SEL710"})


def test_the_demo_motors_are_within_a_percent_of_the_motors_file() -> None:
    feeders = {feeder.ied: feeder.motor for feeder in scl.read(scl.DEMO_PLANT_SCD).feeders()}
    table = tomllib.loads((DEMO.parent / "motors.toml").read_text(encoding="utf-8"))
    motors = {motor["name"]: motor for motor in table["motor"]}
    for ied, relay in read_scenario(DEMO).items():
        known = motors[feeders[ied]]
        plant = relay.plant.motor
        assert plant.nameplate.rated_power_W == known["nameplate"]["rated_power_W"]
        assert plant.nameplate.connection == Connection(known["nameplate"]["connection"])
        for name, value in known["parameters"].items():
            assert getattr(plant.parameters, name) == pytest.approx(value, rel=0.0101)


def test_a_cage_breaks_over_time_and_the_truth_tells(tmp_path: Path) -> None:
    cage = "[motor.cage]\nbars = 32\nplaces = [3, 9]\n"
    cage += "timeline = [{ at_days = 1, broken = 0 }, { at_days = 2, broken = 2 }]\n"
    gap = "[motor.eccentricity]\nstatic = 0.2\ndynamic = 0.1\n"
    load = (
        "[motor.load]\npulsations = [{ depth = 0.1, per_turn = 2 }, { depth = 0.02, at_twice_slip = true }]\n"
    )
    relay = read_scenario(write(tmp_path, MINIMAL + cage + gap + load))["R1"]
    assert relay.truth(0.0)["broken_bars"] == 0
    late = relay.truth(3 * 86400.0)
    assert (late["broken_bars"], late["bars"]) == (2, 32)
    assert late["eccentricity"] == {"static": 0.2, "dynamic": 0.1}
    assert late["pulsations"] == [{"depth": 0.1, "per_turn": 2.0}, {"depth": 0.02, "twice_slip": True}]
    assert relay.plant.cage.lost_conductance(2 / 32).nonzero()[0].tolist() == [3, 9]
    slots = MINIMAL.replace("pole_pairs = 2", "pole_pairs = 2\nrotor_bars = 44")
    assert read_scenario(write(tmp_path, slots))["R1"].truth(0.0)["bars"] == 44


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ("[motor.cage]\nbars = 12\nbroken = 1\n", "12 bars are too few for 2 pole pairs"),
        ("[motor.cage]\nplaces = [28]\n", "places name a bar above 27, the last of 28"),
        ("[motor.cage]\nplaces = [1, 1]\n", "places name a bar twice"),
        ("[motor.cage]\nbroken = 10\n", "10 broken bars of 28 are more than 30%"),
        (
            "[motor.cage]\nbroken = 1\ntimeline = [{ at_s = 0, broken = 1 }]\n",
            "give either broken or timeline",
        ),
        (
            "[motor.load]\npulsations = [{ depth = 0.1 }]\n",
            "give one of frequency_Hz, per_turn and at_twice_slip",
        ),
    ],
)
def test_a_rotor_or_load_that_cannot_be_is_refused(tmp_path: Path, table: str, told: str) -> None:
    with pytest.raises(ScenarioError, match=r"\[motor R1\]") as refused:
        read_scenario(write(tmp_path, MINIMAL + table))
    assert told in str(refused.value)


def test_motors_of_a_bus_share_its_supply(tmp_path: Path) -> None:
    first = MINIMAL.replace('"R1"', '"R1"\nbus = "MCC"')
    second = MINIMAL.replace('"R1"', '"R2"\nbus = "MCC"').replace("= 380", "= 400")
    turned = second.replace('"R2"', '"R3"') + '[motor.supply]\nsequence = "acb"\n'
    other = MINIMAL.replace('"R1"', '"R4"\nbus = "ELSEWHERE"') + BUS.replace("MCC", "ELSEWHERE")
    relays = read_scenario(write(tmp_path, first + second + turned + other + BUS))
    times = 5e5 + np.arange(200) / 10_000
    volts = {name: relay.plant.supply.phase_voltages(times) for name, relay in relays.items()}
    assert np.array_equal(volts["R1"], volts["R2"])
    assert volts["R3"] == pytest.approx(volts["R1"][[0, 2, 1]], abs=1e-4)
    assert np.abs(volts["R4"] - volts["R1"]).max() > 0.01


def test_full_scales_leave_room_for_a_start(tmp_path: Path) -> None:
    sensors = read_scenario(write(tmp_path, MINIMAL))["R1"].plant.sensors
    assert sensors.full_scale_A > 8 * 1.7 * sqrt(2)
    assert sensors.full_scale_V > 1.5 * 380 * sqrt(2 / 3)


def test_the_reference_motor_needs_no_file() -> None:
    assert healthy_reference("X").plant.motor.nameplate.rated_power_W == 800


@pytest.mark.parametrize(
    ("text", "field", "words"),
    [
        ("motor = 3", "motor", "tuple"),
        ("[[motor", "file", "TOML"),
        ("", "motor", "this field"),
        (MINIMAL.replace('ied = "R1"', ""), "[motor 1] ied", "this field"),
        (MINIMAL + MINIMAL, "[motor R1] ied", "each IED once"),
        (
            MINIMAL.replace("pole_pairs = 2", "pole_pairs = 1.5"),
            "[motor R1] [nameplate] pole_pairs",
            "whole number",
        ),
        (MINIMAL.replace("inertia_kgm2 = 0.0229", ""), "[motor R1] [parameters] inertia_kgm2", "above zero"),
        (MINIMAL + "[motor.load]\nlevel = -1", "[motor R1] load.level", "greater than or equal to 0"),
        (MINIMAL + "[motor.load]\nleve = 1", "[motor R1] load.leve", "no such field"),
        (MINIMAL + '[motor.supply]\nsequence = "bac"', "[motor R1] supply.sequence", "'abc' or 'acb'"),
        (
            MINIMAL + "[motor.supply]\nharmonics = [{ order = 9, fraction = 0.1 }]",
            "[motor R1] supply.harmonics.0",
            "three wires",
        ),
        (MINIMAL + '[motor.fault]\nphase = "d"\nlevel = 0.1', "[motor R1] fault.phase", "'a', 'b' or 'c'"),
        (MINIMAL + '[motor.fault]\nphase = "a"', "[motor R1] fault", "either level or timeline"),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\ntimeline = [{at_s=5, level=0.1}, {at_s=5, level=0.2}]',
            "[motor R1] fault",
            "times must rise",
        ),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\ntimeline = [{at_s=5, at_days=1, level=0.1}]',
            "[motor R1] fault.timeline.0",
            "either at_s or at_days",
        ),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\nlevel = 0.1\nresistance_ohm = 1\npath_ratio = 1',
            "[motor R1] fault",
            "either resistance_ohm or path_ratio",
        ),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\ncoil = 1\nlevel = 0.1',
            "[motor R1] fault",
            "coil and coil_share belong together",
        ),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\ntimeline = [{at_s=5, coil_share=0.1}]',
            "[motor R1] fault",
            "coil and coil_share belong together",
        ),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\ncoil = 1\ncoil_share = 0.1',
            "[motor R1] fault.coil",
            "a coil of the phase",
        ),
        (
            MINIMAL + LAP + '[motor.fault]\nphase = "a"\ncoil = 13\ncoil_share = 0.1',
            "[motor R1] fault.coil",
            "a coil of the phase",
        ),
        (MINIMAL + LAP.replace("36", "40"), "[motor R1] winding", "one that the motor can have"),
        (MINIMAL + LAP.replace("lap", "wave"), "[motor R1] winding.kind", "'lap' or 'concentric'"),
        (MINIMAL + '[motor.joint]\nphase = "a"', "[motor R1] joint", "either resistance_ohm or timeline"),
        (
            MINIMAL + '[motor.sensors]\nchanges = [{ channel = "VA", at_days = 1 }]',
            "[motor R1] sensors.changes.0",
            "give gain",
        ),
        (
            MINIMAL
            + '[motor.sensors]\nchanges = [{ channel = "VA", at_days=3, gain_per_day=0.1, until_days=2 }]',
            "[motor R1] sensors.changes.0",
            "after the beginning",
        ),
        (MINIMAL.replace('"R1"', '"R1"\nbus = "MCC"'), "[motor R1] bus", "there is none"),
        (
            MINIMAL.replace('"R1"', '"R1"\nbus = "MCC"') + "[motor.supply]\nunbalance = 0.01" + BUS,
            "[motor R1]",
            "no supply of its own",
        ),
        (MINIMAL + BUS + BUS, "[bus MCC] name", "each bus once"),
        (MINIMAL + BUS.replace("line_voltage_V = 400", ""), "[bus MCC] line_voltage_V", "this field"),
        (MINIMAL + "[clock]\nstart_days_ago = 30\nspeed_up = 1", "clock.speed_up", "greater than 1"),
        (
            MINIMAL + '[motor.fault]\nphase = "a"\nlevel = 0.1\nresistance_ohm = 1e6',
            "[motor R1] fault.resistance_ohm",
            "at most",
        ),
        (MINIMAL + "[motor.sensors]\ngain_errors = [0.1]", "[motor R1] sensors.gain_errors.1", "this field"),
        (
            MINIMAL + "[motor.recorder]\ncapacity = 0",
            "[motor R1] recorder.capacity",
            "greater than or equal to 1",
        ),
        (
            MINIMAL + '[motor.recorder]\ntime_zone = "Berlin"',
            "[motor R1] recorder.time_zone",
            "timezone",
        ),
    ],
)
def test_a_wrong_scenario_is_refused_with_the_field_at_fault(
    tmp_path: Path, text: str, field: str, words: str
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    assert caught.value.field == field
    assert words in caught.value.expected
    assert str(path) in str(caught.value)


def test_a_relay_may_keep_local_time(tmp_path: Path) -> None:
    relay = read_scenario(write(tmp_path, MINIMAL + '[motor.recorder]\ntime_zone = "Europe/Berlin"'))["R1"]
    assert relay.time_zone == ZoneInfo("Europe/Berlin")
    assert read_scenario(write(tmp_path, MINIMAL))["R1"].time_zone is None


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"nowhere\.toml: file: expected a readable file"):
        read_scenario(tmp_path / "nowhere.toml")


WOUND = MINIMAL.replace(
    'connection = "star"',
    'connection = "star"\nkind = "wound-rotor"\nrotor_voltage_V = 100\nrotor_current_A = 5.5',
)


def test_a_wound_rotor_has_slip_rings(tmp_path: Path) -> None:
    path = tmp_path / "scenario.toml"
    table = "[motor.rotor]\nexternal_ohm = 2\nstart_ends_s = 1.5\nstart = [{ after_s = 0, external_ohm = 9 }]"
    path.write_text(WOUND + table, encoding="utf-8")
    configuration = read_scenario(path)["R1"]
    rings = configuration.plant.slip_rings
    assert rings is not None
    assert [rings.outside_ohm(100.0, since_s) for since_s in (0.0, 1.4, 1.6)] == [9.0, 9.0, 2.0]
    assert rings.turns_ratio == pytest.approx(380 / 100, rel=0.08)
    assert configuration.truth(0.0)["external_rotor_ohm"] == 2.0


@pytest.mark.parametrize(
    ("motor", "table", "words"),
    [
        (MINIMAL, "[motor.rotor]\nexternal_ohm = 1\n", "wound-rotor"),
        (WOUND, "[motor.cage]\nbroken = 1\n", "wound rotor"),
        (WOUND, "[motor.rotor]\nstart = [{ after_s = 1, external_ohm = 9 }]\nstart_ends_s = 2\n", "after_s"),
        (WOUND, "[motor.rotor]\nexternal_ohm = 1\ntimeline = [{ at_s = 0, external_ohm = 1 }]\n", "either"),
    ],
)
def test_rotor_tables_that_mean_nothing_are_refused(
    tmp_path: Path, motor: str, table: str, words: str
) -> None:
    path = tmp_path / "scenario.toml"
    path.write_text(motor + table, encoding="utf-8")
    with pytest.raises(ScenarioError) as refused:
        read_scenario(path)
    assert words in f"{refused.value.expected} {refused.value.found}"
