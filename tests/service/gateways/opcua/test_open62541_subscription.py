"""A client of another stack than the server's own is told of what changes."""

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from threading import Thread
from typing import IO, Any

from asyncua import ua

from core.units import NANOSECONDS_PER_DAY
from scl import Address
from service.configuration.settings import Settings
from service.gateways.opcua.certificate import own_certificate
from service.storage import Repository
from service.storage.records import Role
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.plants import NOW_NS, SECOND_NS
from testing.tcp_proxy import Proxy
from testing.waiting import eventually, wait_until
from tests.service.gateways.opcua.clients import PASSWORD, PEER, add_user, address_of, require_open62541
from tests.service.gateways.settings import port_of, settings_of

MOST_S = 60.0
GOOD, UNCERTAIN = ua.StatusCodes.Good, ua.StatusCodes.UncertainLastUsableValue
OLD_NS = NOW_NS - 4000 * NANOSECONDS_PER_DAY
"""More days ago than the settings let a condition be without becoming stale."""


class Subscriber:
    """A process of the client, and what it was told."""

    def __init__(self, process: subprocess.Popen[str], lines: IO[str]) -> None:
        self.process = process
        self.lines: list[str] = []
        self._reader = Thread(target=self._read, args=(lines,), name="subscriber's lines", daemon=True)
        self._reader.start()

    def _read(self, lines: IO[str]) -> None:
        for line in lines:
            self.lines.append(line)  # at once, for the test looks at them meanwhile

    def told(self, what: str) -> list[Any]:
        """What it was told of this, in order."""
        found = [json.loads(line) for line in tuple(self.lines) if line.startswith('{"what"')]
        return [one["told"] for one in found if one["what"] == what]

    def end(self) -> int:
        """Have it end; return its status."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        status = self.process.wait(MOST_S)
        self._reader.join(MOST_S)
        return status


@contextmanager
def subscriber(settings: Settings, folder: Path, address: str | None = None) -> Iterator[Subscriber]:
    """A client of open62541 that has subscribed as the user vera; by another address than the server's."""
    require_open62541()
    folder.mkdir()
    certificate, key = own_certificate(folder, "urn:statorwatch:test-client", LOOPBACK)
    script = Path(__file__).with_name("open62541_subscriber.py")
    command = [sys.executable, script, PEER, address or address_of(settings), certificate, key, "vera"]
    process = subprocess.Popen(
        [str(word) for word in command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdin.write(f"{PASSWORD}\n")
        process.stdin.flush()
        client = Subscriber(process, process.stdout)
        wait_until(lambda: client.told("ready") or process.poll() is not None, "the client to subscribe")
        assert client.told("ready"), "".join(client.lines)[-2000:]
        yield client
    finally:
        process.kill()
        process.wait()
        process.stdin.close()
        process.stdout.close()


def states(client: Subscriber) -> list[tuple[str, int]]:
    """The states that it was told, with the status of each."""
    return [(value, status) for value, status, _ in client.told("State")]


def test_open62541_is_told_of_a_state_that_changes(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "vera", Role.VIEWER)
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path)
    with running_gateways(chosen), subscriber(chosen, tmp_path / "client") as client:
        assert eventually(lambda: states(client) == [("healthy", GOOD)]), client.lines
        assert eventually(lambda: client.told("DeviceHealth")[0][:2] == [0, GOOD]), client.lines
        tell(repository, FAULT)
        assert eventually(lambda: states(client) == [("healthy", GOOD), ("fault", GOOD)]), client.lines
        assert eventually(lambda: [one[0] for one in client.told("DeviceHealth")] == [0, 1]), client.lines
        (_, _, told_at) = client.told("State")[-1]
        assert datetime.fromisoformat(told_at) == datetime.fromtimestamp(NOW_NS // SECOND_NS, UTC)
        tell(repository, replace(FAULT, as_of_ns=OLD_NS))
        assert eventually(lambda: states(client)[2:] == [("fault", UNCERTAIN)]), client.lines
        assert client.end() == 0, client.lines
    assert len(states(client)) == 3


def test_open62541_is_told_of_a_motors_alarm_as_an_event(repository: Repository, tmp_path: Path) -> None:
    add_user(repository, "vera", Role.VIEWER)
    chosen = settings_of("opcua", tmp_path)
    with running_gateways(chosen), subscriber(chosen, tmp_path / "client") as client:
        tell(repository, FAULT)
        assert eventually(lambda: client.told("event")), client.lines
        assert client.end() == 0, client.lines
    (event, *_) = client.told("event")
    (alarm,) = repository.open_alarms(motor="PUMP-A1", limit=5).items
    assert (event["SourceName"], event["Message"]) == (alarm.place, alarm.reason)
    assert event["SourceNode"].endswith(";s=motor/PUMP-A1")
    changed = datetime.fromtimestamp(alarm.changed_ns // SECOND_NS, UTC)
    assert datetime.fromisoformat(event["Time"]).replace(microsecond=0) == changed


def test_open62541_whose_connection_was_cut_is_told_of_later_changes(
    repository: Repository, tmp_path: Path
) -> None:
    """It tries to connect again once, and goes on with its session and its subscription."""
    add_user(repository, "vera", Role.VIEWER)
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path)
    own, seen = Address(LOOPBACK, port_of(chosen)), Address(LOOPBACK, free_port())
    with (
        running_gateways(chosen),
        Proxy({"server": (own, seen)}) as proxy,
        subscriber(chosen, tmp_path / "client", f"opc.tcp://{seen.host}:{seen.port}/") as client,
    ):
        assert eventually(lambda: states(client) == [("healthy", GOOD)]), client.lines
        proxy.cut("server")
        tell(repository, FAULT)
        assert eventually(lambda: states(client)[-1] == ("fault", GOOD), MOST_S), "".join(client.lines)
        assert proxy.links["server"].accepted >= 2
        assert proxy.links["server"].connections == 1
        assert client.end() == 0, client.lines
