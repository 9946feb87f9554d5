"""A client of another stack than the server's own is told of what changes."""

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import IO, Any

from service.configuration.settings import Settings
from service.gateways.opcua.certificate import own_certificate
from service.storage import Repository
from service.storage.records import Role
from testing.not_installed import not_installed
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.waiting import eventually, wait_until
from tests.service.gateways.opcua.test_opcua import PASSWORD, PEER, add_user, address_of
from tests.service.gateways.settings import settings_of

MOST_S = 60.0


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
def subscriber(settings: Settings, folder: Path) -> Iterator[Subscriber]:
    """A client of open62541 that has subscribed as the user vera."""
    folder.mkdir()
    certificate, key = own_certificate(folder, "urn:statorwatch:test-client", LOOPBACK)
    script = Path(__file__).with_name("open62541_subscriber.py")
    command = [sys.executable, script, PEER, address_of(settings), certificate, key, "vera"]
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


def test_open62541_is_told_of_a_state_that_changes(repository: Repository, tmp_path: Path) -> None:
    if not PEER.exists():
        not_installed(f"no open62541: python -m pip install --no-deps --target {PEER} o6==2.2.0")
    add_user(repository, "vera", Role.VIEWER)
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path)
    with running_gateways(chosen), subscriber(chosen, tmp_path / "client") as client:
        assert eventually(lambda: client.told("State") == ["healthy"]), client.lines
        assert eventually(lambda: client.told("DeviceHealth") == [0]), client.lines
        tell(repository, FAULT)
        assert eventually(lambda: client.told("State") == ["healthy", "fault"]), client.lines
        assert eventually(lambda: client.told("DeviceHealth") == [0, 1]), client.lines
        assert client.end() == 0, client.lines
    assert client.told("State") == ["healthy", "fault"]
