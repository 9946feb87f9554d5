"""Killed with SIGKILL in the middle and started again, the service loses no recording and doubles none."""

import os
import signal
from collections import Counter
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect
from service.storage.states import RecordingRequestState
from testing.service.processes import (
    MOTOR_NAMES,
    Service,
    descendants,
    is_alive,
    link_states,
    running_service,
    simulated_plant,
)
from testing.waiting import eventually

PROGRESS = ("requested", "triggered", "recorded", "fetched", "diagnosed")


def states(client: ServiceClient, requests: list[str]) -> list[str]:
    return [str(client.get_event_report(request)["state"]) for request in requests]


def request_all(client: ServiceClient) -> list[str]:
    return [str(client.request_recording(motor)["id"]) for motor in MOTOR_NAMES]


def in_the_middle(client: ServiceClient, requests: list[str], past: str) -> bool:
    """Every relay was triggered, one request got past a state, and not everything is done."""
    reached = [PROGRESS.index(state) for state in states(client, requests)]
    return min(reached) >= 1 and max(reached) > PROGRESS.index(past) and min(reached) < len(PROGRESS) - 1


def kill_in_the_middle(service: Service, past: str, *, alone: bool) -> list[str]:
    """Trigger every motor, kill everything on the way, start again. Returns the recording requests."""
    with ServiceClient(service.url) as client:
        assert eventually(lambda: set(link_states(client).values()) == {"up"}, 30)
        requests = request_all(client)
        assert eventually(lambda: in_the_middle(client, requests, past), 30)
    service.kill(alone=alone)
    repository = Repository(connect(sqlite_url(service.data)))
    left = {repository.recording_request(request).state for request in requests}
    assert left - {RecordingRequestState.DIAGNOSED}, "it was killed before everything was done"
    service.start()
    return requests


@pytest.mark.timeout(300)  # it starts the service four times and waits for twelve diagnoses
def test_twelve_recordings_are_twelve_rows(tmp_path: Path) -> None:
    with (
        simulated_plant(tmp_path) as plant,
        running_service(tmp_path, plant.scd, MCC_POLL_PERIOD_S="1") as service,
    ):
        requests = kill_in_the_middle(service, past="triggered", alone=False)
        with ServiceClient(service.url) as client:
            assert eventually(lambda: set(states(client, requests)) == {"diagnosed"}, 60), (
                service.log.read_text()
            )
        requests += kill_in_the_middle(service, past="recorded", alone=True)
        with ServiceClient(service.url) as client:
            assert eventually(lambda: set(states(client, requests)) == {"diagnosed"}, 60), (
                service.log.read_text()
            )
            rows = Counter((str(row["ied"]), str(row["name"])) for row in client.items("/recordings"))
            of_requests = {client.get_event_report(request)["recording_id"] for request in requests}
            trends = [len(list(client.items(f"/motors/{motor}/trend"))) for motor in MOTOR_NAMES]
        assert len(plant.records()) == 12
        assert rows == Counter(plant.records())
        assert len(of_requests) == 12
        assert trends == [2] * 6


def collector_of(service: Service) -> int | None:
    for process_id in descendants(service.process_id):
        if is_alive(process_id) and b"service.collector" in Path(f"/proc/{process_id}/cmdline").read_bytes():
            return process_id
    return None


@pytest.mark.timeout(300)
def test_a_collector_that_dies_is_replaced_and_the_api_goes_on(tmp_path: Path) -> None:
    with (
        simulated_plant(tmp_path, ["A1_SEL710"]) as plant,
        running_service(tmp_path, plant.scd, MCC_POLL_PERIOD_S="1", MCC_CONNECT_TIMEOUT_S="1") as service,
        ServiceClient(service.url) as client,
    ):
        assert eventually(lambda: link_states(client)["A1_SEL710"] == "up", 30)
        first = collector_of(service)
        assert first is not None
        os.kill(first, signal.SIGKILL)
        assert eventually(lambda: link_states(client)["A1_SEL710"] == "unknown", 10), "the API says so"
        request = str(client.request_recording("PUMP-A1")["id"])
        assert eventually(lambda: states(client, [request]) == ["diagnosed"], 40), service.log.read_text()
        assert collector_of(service) not in (None, first)
        assert link_states(client)["A1_SEL710"] == "up"
        assert len(plant.records()) == 1
