"""A Modbus client that is not ours reads the state of motors from the service's gateway."""

import math
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK
from service.storage import Repository
from testing.not_installed import not_installed
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.plants import NOW_NS
from testing.waiting import eventually
from tests.service.gateways.settings import settings_of

FAN, PUMP = FIRST_BLOCK, FIRST_BLOCK + BLOCK


@pytest.fixture
def port(repository: Repository, tmp_path: Path) -> Iterator[int]:
    settings = settings_of("modbus", tmp_path, idle_timeout_s=1.0)
    assert settings.gateways.modbus is not None
    with running_gateways(settings):
        yield settings.gateways.modbus.port


def mbpoll(port: int, address: int, kind: str, count: int = 1, written: Sequence[str] = ()) -> str:
    """What Debian's mbpoll (libmodbus) prints; it exits with an error where the server refuses."""
    if shutil.which("mbpoll") is None:
        not_installed("no mbpoll: apt-get install --no-install-recommends mbpoll")
    # 3: input registers by function 4; 4: holding registers by function 3, or written by 6 and 16.
    table = "4" if written else "3"
    command = ["mbpoll", "-0", "-1", "-q", "-B", "-p", str(port), "-t", f"{table}{kind}", "-r", str(address)]
    command += [] if written else ["-c", str(count)]
    done = subprocess.run(
        [*command, LOOPBACK, *written], capture_output=True, text=True, timeout=30, check=False
    )
    return done.stdout + done.stderr


def figures(port: int, address: int, kind: str, count: int = 1) -> list[float]:
    return [
        float(found) for found in re.findall(r"^\[\d+\]:\s+(\S+)", mbpoll(port, address, kind, count), re.M)
    ]


def test_a_fault_is_read_by_libmodbus(repository: Repository, port: int) -> None:
    tell(repository, HEALTHY)
    assert eventually(lambda: figures(port, PUMP, "", 5) == [1, 0, 0, 0, 0])
    tell(repository, FAULT)
    assert eventually(lambda: figures(port, PUMP, "", 5) == [3, 1, 2, 1, 0])
    level, low, high, change, limit, load = figures(port, PUMP + 10, ":float", 6)
    assert (level, low, high, change) == pytest.approx((0.0121, 0.009, 0.0225, 0.012), rel=1e-4)
    assert math.isnan(limit)
    assert math.isnan(load)
    assert figures(port, PUMP + 22, ":int") == [NOW_NS // 10**9]
    assert figures(port, FAN, "", 5) == [0, 0, 0, 2, 2]


def test_the_header_tells_that_somebody_tells(port: int) -> None:
    assert eventually(lambda: figures(port, 3, "") == [1])
    version, blocks, alive = figures(port, 0, "", 3)
    assert (version, blocks) == (1, 2)
    assert eventually(lambda: figures(port, 2, "") != [alive])


def test_nobody_writes(port: int) -> None:
    assert "Illegal function" in mbpoll(port, PUMP, "", written=["3"])
    assert "Illegal data address" in mbpoll(port, 65_500, "", 10)


def test_the_map_of_the_registers_is_written_for_people(port: int, tmp_path: Path) -> None:
    written = tmp_path / "modbus-map.csv"
    assert eventually(written.exists)
    assert written.read_text(encoding="utf-8").splitlines() == [
        "motor,block,first register",
        f"FAN-A2,0,{FAN}",
        f"PUMP-A1,1,{PUMP}",
    ]


def test_clients_that_say_nothing_keep_nobody_out_for_long(port: int) -> None:
    with ExitStack() as open_ones:
        crowd = [open_ones.enter_context(socket.create_connection((LOOPBACK, port))) for _ in range(100)]
        assert eventually(lambda: figures(port, 0, "") == [1])
        for one in crowd:
            one.settimeout(10)
            assert one.recv(1) == b""


def test_a_client_that_drips_octets_and_never_asks_is_sent_away(port: int) -> None:
    with socket.create_connection((LOOPBACK, port)) as link:
        link.sendall(struct.pack(">HHHB", 1, 0, 254, 1))
        link.settimeout(0.05)

        def is_sent_away() -> bool:
            try:
                link.sendall(b"\x00")
                return link.recv(1) == b""
            except TimeoutError:
                return False
            except ConnectionError:
                return True

        assert eventually(is_sent_away, within_s=10)


@settings(max_examples=50, deadline=None)
@given(st.lists(st.binary(min_size=1, max_size=300), min_size=1, max_size=5))
def garbled_requests(port: int, requests: list[bytes]) -> None:
    with socket.create_connection((LOOPBACK, port)) as link:
        for request in requests:
            try:
                link.sendall(struct.pack(">HHH", 1, 0, len(request)) + request)
            except OSError:
                break
    assert eventually(lambda: figures(port, 0, "") == [1], within_s=10)


def test_garbled_requests_bring_nothing_down(port: int) -> None:
    garbled_requests(port)


def test_a_gateway_that_is_killed_is_back_with_the_right_values(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    settings = settings_of("modbus", tmp_path)
    assert settings.gateways.modbus is not None
    port = settings.gateways.modbus.port
    with running_gateways(settings) as gateways:
        assert eventually(lambda: figures(port, PUMP, "") == [1])
        first = gateways.status()[0].process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        tell(repository, FAULT)
        assert eventually(lambda: figures(port, PUMP, "") == [3])


def test_without_passwords_clients_are_named() -> None:
    with pytest.raises(ValueError, match="Modbus knows no passwords"):
        ModbusSettings.model_validate({"bind_address": "0.0.0.0"})  # noqa: S104 - refused
    named = ModbusSettings.model_validate({"bind_address": "0.0.0.0", "clients": ["10.1.0.0/16"]})  # noqa: S104
    assert named.allows(named.clients[0].network_address)
    assert not named.allows(named.bind_address)


def test_a_client_that_is_not_named_gets_no_answer(repository: Repository, tmp_path: Path) -> None:
    settings = settings_of("modbus", tmp_path, clients=["10.1.0.0/16"])
    assert settings.gateways.modbus is not None
    with running_gateways(settings):
        assert figures(settings.gateways.modbus.port, 0, "") == []
