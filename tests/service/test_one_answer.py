"""One motor, one answer: a plant with each cause, and with pairs of them; every surface says the same."""

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import httpx
import pytest

from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.starts.examined import ExaminedStart, StartStress
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState
from core.units import NANOSECONDS_PER_DAY
from service.api import ApiContext
from service.cli.app import main
from service.client.rest_client import Document
from service.configuration.settings import Settings
from service.gateways.iec104.points import POINTS, said_of
from service.gateways.iec61850.values import motor_values
from service.gateways.kind_codes import KIND_CODES
from service.gateways.modbus.register_map import FIRST_BLOCK, STATES, blocks
from service.gateways.mqtt import documents
from service.gateways.mqtt.sparkplug.metrics import of_motor
from service.gateways.opcua.values import MOTOR_VARIABLES, motor_value
from service.gateways.plant_state.figures import MotorFigures, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.notifications.digests import due_digests
from service.recording_store.store import RecordingStore
from service.reports.contents.fleet import fleet_document
from service.reports.contents.motor import motor_document
from service.reports.source import ReportSource
from service.reports.times import Period
from service.storage import Repository
from service.web.app import create_site
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.rotor_and_supply import BROKEN_ROTOR, SOUND_ROTOR, SUPPLY, ExaminedRecordings
from testing.service.starts import START, RecordedStarts
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store
from tests.service.web.pages import page, words

__all__ = ["database_url", "engine", "repository", "store"]

MOTOR = "PUMP-A1"
SOUND = replace(HEALTHY, as_of_ns=NOW_NS)
JOINT = replace(FAULT, state=State.WATCH, kind=Kind.CONNECTION, phase="c", phase_probabilities=None)
CHANNEL = replace(FAULT, state=State.WATCH, kind=Kind.VOLTAGE_CHANNEL, phase="a", phase_probabilities=None)
POOR = replace(SUPPLY, voltage_deviation=-0.115, voltage_unbalance_nema=0.023)
WORSE = replace(SUPPLY, voltage_unbalance_nema=0.06)
HOT = TrackedParameters(
    state=TrackingState.DRIFTING,
    parameters=(),
    records=40,
    as_of_ns=NOW_NS,
    reference_complete=True,
    winding_excess_K=None,
    winding_excess_K_ci95=None,
    causes=(DriftCause.WINDING_HOT,),
    reasons=(),
)
LEAKAGE = replace(HOT, causes=(DriftCause.LEAKAGE,))


@dataclass(frozen=True)
class Case:
    """What the records show, and what every surface has to say."""

    state: State
    kind: Kind
    finding: str
    stator: Condition = SOUND
    rotor: bool = False
    supply: object = SUPPLY
    tracked: TrackedParameters | None = None
    hard_start: bool = False


CASES = {
    "healthy": Case(State.HEALTHY, Kind.NONE, ""),
    "turns": Case(State.FAULT, Kind.SHORTED_TURNS, "shorted turns", FAULT),
    "joint": Case(State.WATCH, Kind.CONNECTION, "joint", JOINT),
    "channel": Case(State.WATCH, Kind.VOLTAGE_CHANNEL, "voltage channel", CHANNEL),
    "unfit supply": Case(State.WATCH, Kind.SUPPLY, "unbalanced voltage", supply=WORSE),
    "rotor": Case(State.FAULT, Kind.ROTOR, "broken rotor bars", rotor=True),
    "supply": Case(State.WATCH, Kind.SUPPLY, "undervoltage and unbalanced voltage", supply=POOR),
    "heat": Case(State.WATCH, Kind.THERMAL, "hotter than their load explains", tracked=HOT),
    "parameters": Case(State.WATCH, Kind.PARAMETERS, "leakage inductance changed", tracked=LEAKAGE),
    "starts": Case(State.WATCH, Kind.STARTS, "hard starts", hard_start=True),
    "turns and rotor": Case(State.FAULT, Kind.SHORTED_TURNS, "broken rotor bars", FAULT, rotor=True),
    "rotor and parameters": Case(State.FAULT, Kind.ROTOR, "broken rotor bars", rotor=True, tracked=LEAKAGE),
    "channel and rotor": Case(State.FAULT, Kind.ROTOR, "voltage channel in phase a", CHANNEL, rotor=True),
    "supply and joint": Case(State.WATCH, Kind.CONNECTION, "unbalanced voltage", JOINT, supply=WORSE),
}


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    return ApiContext(Settings(data_directory=tmp_path, stale_after_days=36_500), repository, store)


@pytest.fixture
def client(context: ApiContext) -> Iterator[httpx.Client]:
    with serving(create_site(context)) as client:
        yield client


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest, repository: Repository, store: RecordingStore) -> Case:
    """The plant whose motor has this cause."""
    wanted = CASES[request.param]
    records = ExaminedRecordings(repository, store)
    for _ in range(3):
        records.add(BROKEN_ROTOR if wanted.rotor else SOUND_ROTOR, wanted.supply)  # type: ignore[arg-type]
    if wanted.hard_start:
        stress = StartStress(10_000.0, None, 0.95, None, "motor file", 2)
        RecordedStarts(repository, store).add(
            ExaminedStart(START, stress=stress), at_ns=NOW_NS + 9 * SECOND_NS
        )
    tell(repository, replace(wanted.stator, as_of_ns=NOW_NS), parameters=wanted.tracked)
    return wanted


def test_all_documents_of_the_api_say_it(client: httpx.Client, case: Case) -> None:
    condition = client.get(f"/api/v1/motors/{MOTOR}/condition").json()
    health = client.get(f"/api/v1/motors/{MOTOR}/health").json()["condition"]
    listed = client.get("/api/v1/motors", params={"health": "true"}).json()["items"]
    (of_list,) = (one["health"]["condition"] for one in listed if one["name"] == MOTOR)
    for found in (condition, health, of_list):
        assert (found["state"], found["kind"]) == (case.state, case.kind)
        assert case.finding in found["finding"] or case.finding == "joint"
    counting = [one for one in condition["parts"] if one["state"] in ("watch", "fault")]
    assert (case.kind is Kind.NONE) == (not counting)
    if case.kind is not Kind.NONE:
        assert "Nothing needs to be done" not in condition["advice"]
        assert condition["urgency"] != "none"


def test_all_commands_say_it(client: httpx.Client, case: Case, capsys: pytest.CaptureFixture[str]) -> None:
    url = ["--url", str(client.base_url)]
    for command in (["motors"], ["health", MOTOR], ["condition", MOTOR]):
        assert main([*command, *url]) == 0
        assert f" {case.state}" in _one_line(capsys.readouterr().out).replace(MOTOR, " "), command
    assert main(["check", "--fail-on", "watch", *url]) == int(case.state is not State.HEALTHY)
    line = _one_line(capsys.readouterr().out)
    assert (f"{MOTOR}: {case.state}" in line) == (case.state is not State.HEALTHY)
    assert case.finding in line or case.finding == "joint"
    assert main(["motors", "--json", *url]) == 0
    motors: Sequence[Document] = json.loads(capsys.readouterr().out)["motors"]
    (found,) = (one["health"]["condition"] for one in motors if one["name"] == MOTOR)  # type: ignore[index]
    assert (found["state"], found["kind"]) == (case.state, case.kind)


def test_all_pages_say_it(client: httpx.Client, case: Case) -> None:
    client.headers["Accept"] = "text/html"
    fleet = page(client.get("/"))
    (row,) = (one for one in fleet.cssselect("tbody tr") if MOTOR in one.text_content())
    assert row.get("class") == case.state
    of_fleet = " ".join(row.text_content().split())
    motor = page(client.get(f"/motors/{MOTOR}"))
    assert str(case.state) in (motor.cssselect("#verdict")[0].get("class") or "")
    (sentence,) = words(motor, "#verdict .sentence")
    if case.state is not State.HEALTHY:
        assert "Nothing needs to be done" not in " ".join(words(motor, "#verdict .advice"))
        for said in (of_fleet, sentence):
            assert case.finding.casefold() in said.casefold()
    shown = words(motor, "#parts .state")
    assert any(one.startswith((str(case.state), State.FAULT)) for one in shown)
    assert (case.state is State.HEALTHY) == all(one.startswith(("healthy", "not assessed")) for one in shown)


def test_the_metrics_say_it(client: httpx.Client, case: Case) -> None:
    found = client.get("/metrics").text
    assert f'mcc_motor_state{{motor="{MOTOR}",state="{case.state}"}} 1.0' in found
    assert f'mcc_motor_kind{{kind="{case.kind}",motor="{MOTOR}"}} 1.0' in found


def test_reports_and_digests_say_it(repository: Repository, tmp_path: Path, case: Case) -> None:
    source = ReportSource(repository, stale_after_days=36_500)
    until_ns = NOW_NS + 60 * SECOND_NS
    fleet = fleet_document(source, Period(NOW_NS - 1, until_ns), "The plant")
    of_motor = motor_document(source, MOTOR, until_ns)
    table = {
        "notifications": {
            "channels": {"log": {"kind": "webhook", "url": "https://plant.example/hook"}},
            "digests": [{"period": "daily", "at": "00:00", "channels": ["log"]}],
        }
    }
    settings = Settings.model_validate({"data_directory": tmp_path, **table})
    (digest,) = due_digests(settings, repository, NOW_NS + NANOSECONDS_PER_DAY)
    assert digest.document is not None
    listed: Sequence[Mapping[str, object]] = digest.document["attention"]  # type: ignore[assignment]
    attention = [one for one in listed if one["motor"] == MOTOR]
    if case.state is State.HEALTHY:
        assert attention == []
        return
    assert [(one["state"], one["kind"]) for one in attention] == [(case.state, case.kind)]
    for document in (fleet, of_motor):
        said = repr(document)
        assert case.finding.casefold() in said.casefold()
        assert str(case.state) in said


def test_all_gateways_say_it(repository: Repository, case: Case) -> None:
    state = read_plant_state(repository, now_ns=NOW_NS + 60 * SECOND_NS, stale_after_days=36_500)
    motor = state.motors[MOTOR]
    for name, (said_state, said_kind) in _of_protocols(motor, state).items():
        assert (said_state, said_kind) == (case.state, case.kind), name
    healths = {State.HEALTHY: "normal", State.WATCH: "maintenance-required", State.FAULT: "failure"}
    expected = "off-spec" if case.kind is Kind.SUPPLY else healths[case.state]
    assert str(motor.device_health) == expected
    assert (motor.rotor is not None) == case.rotor


def test_what_needs_somebody_has_its_alarm(repository: Repository, case: Case) -> None:
    now_ns = NOW_NS + 60 * SECOND_NS
    repository.settle_start_alarms_of(MOTOR, now_ns=now_ns)
    kinds = {str(one.kind) for one in repository.open_alarms(motor=MOTOR, limit=10).items if one.standing}
    of_cause = {
        Kind.NONE: set[str](),
        Kind.SHORTED_TURNS: {"condition-fault"},
        Kind.CONNECTION: {"condition-watch", *(["supply-fault"] if case.supply is WORSE else [])},
        Kind.VOLTAGE_CHANNEL: {"condition-watch"},
        Kind.ROTOR: {"rotor-fault"},
        Kind.SUPPLY: {"supply-fault" if case.supply is WORSE else "supply-watch"},
        Kind.THERMAL: {"parameter-drift"},
        Kind.PARAMETERS: {"parameter-drift"},
        Kind.STARTS: {"hard-starts"},
    }
    assert of_cause[case.kind] <= kinds
    assert (case.kind is Kind.NONE) == (not kinds)
    if case.rotor:
        assert "parameter-drift" not in kinds, "a broken cage explains it"


def _of_protocols(motor: MotorFigures, state: PlantState) -> Mapping[str, tuple[str, str]]:
    """The state and the kind as each protocol's own encoding has them."""
    opcua = {one.name: motor_value(one, motor, state).Value.Value for one in MOTOR_VARIABLES}
    plain = json.loads(documents.figures(motor))
    sparkplug = {one.name: one.value for one in of_motor(motor, state)}
    registers = blocks(state, dict.fromkeys(state.motors, 0) | {MOTOR: 0})[FIRST_BLOCK]
    points = {point.meaning: said_of(point, motor, state).number or 0.0 for point in POINTS}
    attributes = motor_values("D", motor, None)
    of_kind: Callable[[float], str] = lambda code: str(KIND_CODES[round(code)])  # noqa: E731
    is_fault, is_worse = points["Fault"], points["Watch or fault"]
    of_points = State.FAULT if is_fault else State.WATCH if is_worse else State.HEALTHY
    is_op = attributes["D/GAPC1.Op.general"]
    is_str = attributes["D/GAPC1.Str.general"]
    return {
        "OPC UA": (opcua["State"], opcua["Kind"]),
        "MQTT": (plain["state"], plain["kind"]),
        "Sparkplug": (str(sparkplug["Condition/State"]), str(sparkplug["Condition/Kind"])),
        "Modbus": (STATES[registers[0]], of_kind(registers[1])),
        "IEC 60870-5-104": (of_points, of_kind(points["Kind, numbered as for Modbus"])),
        "IEC 61850": (
            State.FAULT if is_op else State.WATCH if is_str else State.HEALTHY,
            of_kind(attributes["D/GGIO1.IntIn1.stVal"]),  # type: ignore[arg-type]
        ),
    }


def _one_line(text: str) -> str:
    return " ".join(text.split())
