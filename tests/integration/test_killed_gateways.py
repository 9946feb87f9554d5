"""Gateways to other systems that are killed while all relays are recorded are in nobody's way."""

import json
import os
import signal
from collections.abc import Mapping
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from testing.ports import free_port
from testing.service.mosquitto import running_mosquitto
from testing.service.processes import MOTOR_NAMES, link_states, running_service, simulated_plant
from testing.waiting import eventually

KINDS = ("iec104", "iec61850", "modbus", "opcua")
BACK_S = 60.0


def gateways(client: ServiceClient) -> Mapping[str, tuple[int, int]]:
    """Process and number of restarts of each gateway in which all works."""
    return {
        str(one["kind"]): (int(str(one["process_id"])), int(str(one["restarts"])))
        for one in client.items("/integrations")
        if one["problem"] is None and one["process_id"] is not None
    }


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_gateways_that_are_killed_while_relays_are_recorded_lose_no_recording(tmp_path: Path) -> None:
    with running_mosquitto(tmp_path) as broker:
        tables: dict[str, object] = {kind: {"port": free_port()} for kind in KINDS}
        tables["mqtt"] = {"port": broker.port, "sparkplug": {}}
        with (
            simulated_plant(tmp_path) as plant,
            running_service(
                tmp_path, plant.scd, MCC_POLL_PERIOD_S="1", MCC_GATEWAYS=json.dumps(tables)
            ) as service,
            ServiceClient(service.url) as client,
        ):
            assert eventually(lambda: set(link_states(client).values()) == {"up"}, 30)
            assert eventually(lambda: set(gateways(client)) == set(tables), BACK_S)
            before = gateways(client)
            requests = [str(client.request_recording(motor)["id"]) for motor in MOTOR_NAMES]

            def states() -> set[str]:
                return {str(client.get_event_report(one)["state"]) for one in requests}

            assert eventually(lambda: "requested" not in states(), 30)
            assert states() != {"diagnosed"}, "they are killed before everything is done"
            for process, _ in before.values():
                os.kill(process, signal.SIGKILL)
            assert eventually(lambda: states() == {"diagnosed"}, 60), service.log.read_text()
            assert set(link_states(client).values()) == {"up"}
            assert len(plant.records()) == len(list(client.items("/recordings"))) == len(MOTOR_NAMES)
            assert eventually(lambda: set(gateways(client)) == set(tables), BACK_S), service.log.read_text()
            after = gateways(client)
            assert {kind: restarts for kind, (_, restarts) in after.items()} == dict.fromkeys(tables, 1)
            assert all(after[kind][0] != process for kind, (process, _) in before.items())
