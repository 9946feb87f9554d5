"""The demo's tables show what is open of each motor."""

from pathlib import Path

from service.api import ApiContext, create_app
from service.cli.demo.month import conditions_table
from service.client.rest_client import Document, ServiceClient
from service.configuration.settings import Settings
from service.demo.open_alarms import alarm_text, open_alarms_of
from service.demo.results import DemoMotor
from service.demo.status import ask_status
from service.demo.truth import Truth
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.records.actors import SERVICE
from service.storage.states import AlarmKind
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

TRUTH = Truth(mu_f=0.05, theta_f=1, load_level=0.65)


def test_a_motors_alarm_stands_beside_its_condition(repository: Repository, tmp_path: Path) -> None:
    place = AlarmPlace(relay="A1_SEL710", motor="PUMP-A1")
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns in phase b", "shorted-turns")
    raised = repository.raise_alarm_at(place, spec, now_ns=NOW_NS)
    repository.raise_alarm("A1_SEL710", AlarmKind.DAILY_LIMIT, "", "of the relay itself", now_ns=NOW_NS)
    store = FolderStore(tmp_path / "recordings")
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with serving(app) as client, ServiceClient(str(client.base_url)) as service:
        open_alarms = open_alarms_of(service)
        assert {motor: alarm_text(alarms) for motor, alarms in open_alarms.items()} == {
            "PUMP-A1": "critical, unacknowledged"
        }
        truths = dict.fromkeys(("A1_SEL710", "A2_SEL710"), TRUTH)
        healths = ask_status(service, lambda healths: [truths] * len(healths))
        status = {str(one.health["motor"]): one.as_dict()["alarms"] for one in healths}
        repository.acknowledge_alarm(raised.id, by=SERVICE, now_ns=NOW_NS, comment="seen")
        after = open_alarms_of(service)
    assert status["FAN-A2"] == []
    shown = status["PUMP-A1"]
    assert isinstance(shown, list)
    assert (shown[0]["id"], shown[0]["kind"], shown[0]["state"]) == (
        raised.id,
        "condition-fault",
        "unacknowledged",
    )
    assert alarm_text(after["PUMP-A1"]) == "critical, acknowledged"
    assert alarm_text([*after["PUMP-A1"]] * 3) == "critical, acknowledged (+2)"
    motors = [DemoMotor(name, "FACTORY_A", TRUTH) for name in ("PUMP-A1", "FAN-A2")]
    said: dict[str, object] = {
        **dict.fromkeys(("since", "mu_f", "mu_f_ci95")),
        "state": "fault",
        "kind": "shorted-turns",
        "phase": "b",
        "candidates": [],
        "stale": False,
    }
    rotors: dict[str, Document] = {
        "PUMP-A1": {"state": "fault", "severity_dB": -29.04, "reasons": []},
        "FAN-A2": {"state": "healthy", "severity_dB": -61.0, "reasons": ["load oscillation in 3 of 3"]},
    }
    table = conditions_table(motors, dict.fromkeys(("PUMP-A1", "FAN-A2"), said), rotors, after)
    assert [str(cell) for cell in table.columns[-2].cells] == [
        "fault, -29.0 dB",
        "healthy, -61.0 dB, load oscillation",
    ]
    assert [str(cell) for cell in table.columns[-1].cells] == ["critical, acknowledged", "-"]
