"""From a nameplate to a verdict, over real MMS: the relay records a start, and the rest follows from it."""

import json
import re
from pathlib import Path

import pytest

from mms import Client
from service.cli.app import main
from service.client.rest_client import Document, ServiceClient
from service.demo import MOTORS, SCENARIO
from testing.service.processes import running_service, simulated_plant
from testing.waiting import eventually

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(300)]

MOTOR, RELAY = "PUMP-A1", "A1_SEL710"


def nameplate_alone(directory: Path) -> Path:
    """The demo plant's motors file, in which the first motor has no parameters."""
    text = MOTORS.read_text(encoding="utf-8")
    without = re.sub(r"\[motor\.parameters\]\n(?:\w+ = \S+\n)+", "", text, count=1)
    path = directory / "motors.toml"
    path.write_text(without, encoding="utf-8")
    return path


def at_rest(directory: Path) -> Path:
    """The demo's scenario, in which the first motor stands and its relay records each start of it."""
    text = SCENARIO.read_text(encoding="utf-8")
    whole = f'ied = "{RELAY}"\nstopped = true\n'
    triggers = "\n[motor.triggers]\nmotor_start = true\n\n[motor.supply]\n"
    text = text.replace(f'ied = "{RELAY}"\n', whole, 1).replace("\n[motor.supply]\n", triggers, 1)
    path = directory / "scenario.toml"
    path.write_text(text, encoding="utf-8")
    return path


def recordings(client: ServiceClient, **query: str) -> list[Document]:
    return [one for one in client.items("/recordings", **query) if one["state"] == "diagnosed"]


def test_a_recorded_start_commissions_its_motor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motors = nameplate_alone(tmp_path)
    with (
        simulated_plant(tmp_path, [RELAY], at_rest(tmp_path)) as plant,
        running_service(tmp_path, plant.scd, MCC_MOTORS=str(motors), MCC_POLL_PERIOD_S="1") as service,
    ):
        with ServiceClient(service.url) as client:
            standing = str(client.request_recording(MOTOR)["id"])
            assert eventually(lambda: client.get_event_report(standing)["state"] == "diagnosed", 60)
            (record,) = recordings(client)
            assert record["operation"] == "not-running"
            health = client.get(f"/motors/{MOTOR}/health")
            assert (health["verdict"], health["parameters_source"]) == (None, "typical")
            assert (health["starts"], list(client.items("/alarms"))) == (None, [])

            address = plant.address(RELAY)
            with Client.connect(address.host, address.port) as operator:
                operator.operate(f"{RELAY}CON/RBGGIO1.SPCSO03", value=True)
            assert eventually(lambda: recordings(client, operation="start"), 60)
            starts = client.get(f"/motors/{MOTOR}/health")["starts"]
            assert isinstance(starts, dict)
            assert f"mcc commission --from-service {MOTOR}" in str(starts["advice"])

            command = ["commission", "--from-service", MOTOR, "--write", str(motors), "--url", service.url]
            assert main([*command, "--json"]) == 0
            found = json.loads(capsys.readouterr().out)["parameters"]
            assert found["stator_resistance_ohm"]["value"] == pytest.approx(8.467, rel=0.05)

        service.stop()
        service.start()
        with ServiceClient(service.url) as client:
            request = str(client.request_recording(MOTOR)["id"])
            assert eventually(lambda: client.get_event_report(request)["state"] == "diagnosed", 60)
            health = client.get(f"/motors/{MOTOR}/health")
            assert (health["verdict"], health["parameters_source"]) == ("healthy", "commissioned")
            starts = health["starts"]
            assert isinstance(starts, dict)
            assert starts["advice"] is None
