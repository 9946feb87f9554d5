"""A gateway crashes while it is busy with a relay: a real service sets that relay aside and goes on."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

import scl
from scl import Address
from service.cli.app import main
from service.client.rest_client import ServiceClient
from testing.ports import LOOPBACK, free_port
from testing.relays.serving import mute_server
from testing.service.processes import RELAYS, Service, descendants, running_service
from testing.waiting import eventually

pytestmark = pytest.mark.timeout(300)

RELAY = RELAYS[0]


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Service]:
    """One relay accepts connections and never answers; the others refuse them at once."""
    scd = tmp_path / "plant.scd"
    with mute_server() as mute:
        addresses = {name: Address(LOOPBACK, free_port()) for name in RELAYS}
        scl.with_addresses(scl.DEMO_PLANT_SCD, scd, addresses | {RELAY: Address(LOOPBACK, mute)})
        with running_service(tmp_path, scd, MCC_CONNECT_TIMEOUT_S="600", MCC_WORKERS="1") as running:
            yield running


def gateway(service: Service) -> int | None:
    """Its process id."""
    for process_id in descendants(service.process_id):
        if b"service.collector" in Path(f"/proc/{process_id}/cmdline").read_bytes():
            return process_id
    return None


def visited(service: Service) -> set[str]:
    return {path.name for path in (service.data / "visiting" / "0").glob("*")}


def crash_while_only_that_relay_is_visited(service: Service) -> int:
    """Its process id. It stands still while we look: the others are visited again every few seconds."""
    process_id: int | None = None

    def frozen_there() -> bool:
        nonlocal process_id
        process_id = gateway(service)
        if process_id is None:
            return False
        os.kill(process_id, signal.SIGSTOP)
        if visited(service) == {RELAY}:
            return True
        os.kill(process_id, signal.SIGCONT)
        return False

    assert eventually(frozen_there, 60)
    assert process_id is not None
    os.kill(process_id, signal.SIGSEGV)
    os.kill(process_id, signal.SIGCONT)
    return process_id


def test_the_relay_is_set_aside_the_gateway_goes_on_and_a_command_releases(service: Service) -> None:
    crashed = crash_while_only_that_relay_is_visited(service)
    with ServiceClient(service.url) as client:
        assert eventually(lambda: client.get(f"/ieds/{RELAY}")["link_state"] == "quarantined", 60)
        assert "its answers crashed the gateway (SIGSEGV)" in str(client.get(f"/ieds/{RELAY}")["link_reason"])
        assert eventually(lambda: gateway(service) not in (None, crashed), 60)
        other = RELAYS[1]
        assert eventually(lambda: client.get(f"/ieds/{other}")["link_state"] == "down", 60), (
            "it is visited on"
        )
        assert RELAY not in visited(service)
        assert main(["release", RELAY, "--url", service.url]) == 0
        assert eventually(lambda: RELAY in visited(service), 60)
        assert client.get(f"/ieds/{RELAY}")["quarantine"] is None
