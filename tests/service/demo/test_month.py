"""The month that the demo plays: its files, the leaps of its clock, what is said of motors that develop."""

import tomllib
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

import scl
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.relay.plant_clock import PlantClock
from ied_sim.scenario.scenario import read_clock, read_scenario
from service.cli.demo.month import ConditionLog
from service.client.rest_client import Document
from service.demo import MONTH, MONTH_MOTORS, MOTORS, SCENARIO
from service.demo.month import Month, month_of
from service.demo.results import DemoMotor
from service.demo.status import MotorStatus, truths_of_month
from service.demo.truth import ChannelError, Truth, ask_course

BEGAN = datetime(2026, 1, 1, tzinfo=UTC)
OF_FIVE_MINUTES = Month(BEGAN, 30.0, 8641.0, 5.0)
DAY_S = 86_400.0

HEALTHY = Truth(mu_f=0.0, theta_f=None, load_level=0.6)
FAULT_B = Truth(mu_f=0.012, theta_f=1, load_level=0.6)
DRIFTING = HEALTHY.model_copy(update={"channels": {"VB": ChannelError(gain=-0.0064, delay_us=0.0)}})


def motors(path: Path) -> list[dict[str, object]]:
    return tomllib.loads(path.read_text(encoding="utf-8"))["motor"]  # type: ignore[no-any-return]


def test_the_month_has_the_demo_plants_motors_on_their_buses() -> None:
    relays = {feeder.motor: feeder.ied for feeder in scl.read(scl.DEMO_PLANT_SCD).feeders()}
    bus_of = {str(table["ied"]): table["bus"] for table in motors(MONTH)}
    of_month = motors(MONTH_MOTORS)
    for table in of_month:
        assert table.pop("bus") == bus_of.pop(relays[str(table["name"])])
    assert not bus_of
    assert of_month == motors(MOTORS)


def test_the_month_is_what_it_says() -> None:
    first, last = ask_course(scl.DEMO_PLANT_SCD, MONTH, [0.0, 30 * DAY_S])
    assert {relay: truth.phase for relay, truth in first.items() if truth.phase} == {"B2_SEL710": "a"}
    assert all(truth.running for truth in first.values())
    assert [relay for relay, truth in last.items() if not truth.running] == ["B3_SEL710"]
    assert not any(truth.channels for truth in first.values())
    faults = {relay: (truth.mu_f, truth.phase) for relay, truth in last.items() if truth.phase}
    assert {relay: phase for relay, (_, phase) in faults.items()} == {
        "A2_SEL710": "b",
        "B2_SEL710": "a",
    }
    assert faults["A2_SEL710"][0] == pytest.approx(0.03)
    assert {relay: set(truth.channels) for relay, truth in last.items() if truth.channels} == {
        "A3_SEL710": {"VB"}
    }
    assert not any(truth.broken_bars for truth in first.values())
    assert {relay: truth.broken_bars for relay, truth in last.items() if truth.broken_bars} == {
        "A1_SEL710": 1.0
    }
    assert [relay for relay, truth in last.items() if truth.pulsations] == ["B1_SEL710"]
    known = {feeder.ied: feeder.motor for feeder in scl.read(scl.DEMO_PLANT_SCD).feeders()}
    parameters = {str(table["name"]): table["parameters"] for table in motors(MOTORS)}
    for relay, configuration in read_scenario(MONTH).items():
        true = configuration.plant.motor.parameters
        given = parameters[known[relay]]
        assert isinstance(given, dict)
        assert {name: getattr(true, name) for name in given} == pytest.approx(given, rel=0.0101)


def test_the_demo_counts_the_leaps_as_the_simulator_makes_them() -> None:
    settings = read_clock(MONTH)
    start_ns = round((BEGAN + timedelta(days=30)).timestamp()) * NANOSECONDS_PER_SECOND
    clock = PlantClock(start_ns, settings)
    began = datetime.fromtimestamp(clock.epoch_ns / NANOSECONDS_PER_SECOND, UTC)
    month = month_of(MONTH, f"A1_SEL710 127.0.0.1 10210\nbegan {began.isoformat()}\nready\n")
    assert month == Month(BEGAN, settings.start_days_ago, settings.speed_up, settings.leap_every_s)
    for leap, moment_s in enumerate(month.moments_s()):
        now = BEGAN + timedelta(days=30, seconds=leap * settings.leap_every_s)
        now_ns = start_ns + round(leap * settings.leap_every_s) * NANOSECONDS_PER_SECOND
        seen_s = (clock.plant_ns(now_ns) - clock.epoch_ns) / NANOSECONDS_PER_SECOND
        assert moment_s == pytest.approx(seen_s, abs=1e-3)
        assert month.leap_at(now) == leap
        assert month.until_leap_s(leap, now) == pytest.approx(0.0, abs=1e-3)
    assert month.leaps * settings.leap_every_s == pytest.approx(300.0)


@pytest.mark.parametrize("leap", [1, 14, 59])
@pytest.mark.parametrize("late_s", [0.5, 90.0])
def test_any_record_tells_when_the_month_began(leap: int, late_s: float) -> None:
    clock = {"start_days_ago": 30.0, "speed_up": 8641.0, "leap_every_s": 5.0}
    recorded = BEGAN + timedelta(seconds=OF_FIVE_MINUTES.moments_s()[leap] + 2.0)
    announced = BEGAN + timedelta(days=30, seconds=leap * 5.0 + 2.0 + late_s)
    month = Month.with_record(clock, recorded, announced)
    assert month.began - BEGAN == timedelta(seconds=2.0)
    assert month.moments_s() == OF_FIVE_MINUTES.moments_s()


def test_a_plant_in_real_time_has_no_month() -> None:
    assert month_of(SCENARIO, "ready\n") is None
    late = OF_FIVE_MINUTES.began + timedelta(days=300)
    assert OF_FIVE_MINUTES.leap_at(late) == OF_FIVE_MINUTES.leaps


@pytest.mark.parametrize(
    ("state", "phase", "truth", "right"),
    [
        ("unknown", None, HEALTHY, None),
        ("healthy", None, HEALTHY, True),
        ("watch", "b", DRIFTING, True),
        ("fault", "b", HEALTHY, False),
        ("watch", None, FAULT_B, None),
        ("fault", "b", FAULT_B, True),
        ("fault", "c", FAULT_B, False),
    ],
)
def test_right_is_the_condition_whatever_the_latest_record_says(
    state: str, phase: str | None, truth: Truth, right: bool | None
) -> None:
    reference = {"complete": state != "unknown"}
    condition = {"state": state, "phase": phase, "reference": reference}
    verdict = None if state == "unknown" else "fault"
    health = {"verdict": verdict, "phase": "a", "condition": condition}
    assert MotorStatus(health, truth).is_right is right


def test_the_truth_is_that_at_the_latest_record_of_each_motor() -> None:
    healths = [{"recorded_time": (BEGAN + timedelta(days=days)).isoformat()} for days in (13, 21, 30)]
    found = truths_of_month([*healths, {"recorded_time": None}], BEGAN)
    levels = [truths["A2_SEL710"].mu_f for truths in found]
    assert levels == pytest.approx([0.03 / 18, 0.03 * 9 / 18, 0.03, 0.0], rel=1e-3)


def condition(state: str, kind: str = "none", phase: str | None = None, mu_f: float = 0.0) -> Document:
    return {
        "state": state, "kind": kind, "candidates": [], "phase": phase, "mu_f": mu_f, "mu_f_ci95": None,
    }  # fmt: skip


def test_a_line_is_printed_when_something_else_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    log = ConditionLog()
    healthy = {"MILL-A3": condition("healthy")}
    log.tell(0.5, [DemoMotor("MILL-A3", "FACTORY_A", HEALTHY)], healthy)
    log.tell(1.0, [DemoMotor("MILL-A3", "FACTORY_A", HEALTHY)], healthy)
    named = {"MILL-A3": condition("watch", "voltage-channel", "b", 0.001)}
    log.tell(14.0, [DemoMotor("MILL-A3", "FACTORY_A", DRIFTING)], named)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split("  (")[0].split() for line in lines] == [
        ["day", "0.5", "MILL-A3", "healthy", "0.00", "%"],
        ["day", "14.0", "MILL-A3", "watch:", "voltage", "channel", "b", "0.10", "%"],
    ]
    assert lines[1].endswith("(in truth: healthy, VB -0.64 %)")
