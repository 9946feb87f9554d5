"""A relay with files and a client of it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from mms import Client, Server
from testing.ports import LOOPBACK
from testing.relays.serving import RelayProcess, start_relay


@pytest.fixture
def file_root(tmp_path: Path) -> Path:
    root = tmp_path / "files"
    (root / "EVENTS").mkdir(parents=True)
    (root / "EVENTS" / "C4_00001.CEV").write_bytes(bytes(range(256)) * 1000)
    (root / "EVENTS" / "EMPTY.CEV").touch()
    return root


@pytest.fixture
def relay(file_root: Path) -> Iterator[Server]:
    with start_relay(file_root=file_root) as server:
        yield server


@pytest.fixture
def client(relay: Server) -> Iterator[Client]:
    with Client.connect(LOOPBACK, relay.port, request_timeout_s=10.0) as connected:
        yield connected


@pytest.fixture
def relay_process(file_root: Path) -> Iterator[RelayProcess]:
    process = RelayProcess(file_root)
    yield process
    process.end()
