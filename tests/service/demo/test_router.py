"""The router: what a relay's client sees through it, and without it."""

import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from threading import Thread

import pytest

import scl
from mms import Client, ConnectFailed, FunctionalConstraint
from scl.demo_enterprise import write_demo_enterprise
from service.demo.addresses import free_ports
from service.demo.router import MOST_CONNECTIONS, main, passages
from testing.service.processes import simulated_plant
from testing.waiting import eventually

RELAY = "A1_SEL710"
TRIGGER = f"{RELAY}CON/RBGGIO1.SPCSO01.stVal"


@pytest.fixture(scope="module")
def enterprise(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("enterprise") / "plant.scd"
    write_demo_enterprise(path)
    return path


@contextmanager
def router(scd: Path) -> Iterator["subprocess.Popen[str]"]:
    command = [sys.executable, "-m", "service.demo.router", "--scd", str(scd)]
    command += ["--inside", "FACTORY_A", "--outside", "WAN"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stderr is not None
            for _ in range(3):
                assert "listening" in process.stderr.readline()
            yield process
        finally:
            process.terminate()
            process.wait(10)


def on_loopback(enterprise: Path, copy: Path, relays: Mapping[str, int], outside: Mapping[str, int]) -> None:
    """The enterprise on one machine: its names are loopback, its ports are free ones."""
    text = enterprise.read_text(encoding="utf-8")
    document = scl.read(enterprise)
    for names, view in ((relays, document), (outside, document.seen_from("WAN"))):
        for name, port in names.items():
            address = view.address(name)
            before = f'<P type="DNSName">{address.host}</P>', f'<P type="MMS-Port">{address.port}</P>'
            head, found, tail = text.partition(before[0])
            assert found
            tail = tail.replace(before[1], f'<P type="MMS-Port">{port}</P>', 1)
            text = f'{head}<P type="IP">127.0.0.1</P>{tail}'
    copy.write_text(text, encoding="utf-8")


def test_each_relay_has_its_own_port_outside(enterprise: Path) -> None:
    ways = passages(enterprise, "FACTORY_B", "WAN")
    assert [(way.relay, way.port, str(way.address)) for way in ways] == [
        ("B1_SEL710", 10213, "relay-b1:102"),
        ("B2_SEL710", 10214, "relay-b2:102"),
        ("B3_SEL710", 10215, "relay-b3:102"),
    ]


def test_a_relay_answers_through_the_router(enterprise: Path, tmp_path: Path) -> None:
    with simulated_plant(tmp_path, [RELAY]) as plant:
        inside = {f"A{number}_SEL710": plant.address(f"A{number}_SEL710").port for number in (1, 2, 3)}
        outside = dict(zip(inside, free_ports(3), strict=True))
        scd = tmp_path / "enterprise.scd"
        on_loopback(enterprise, scd, inside, outside)
        with router(scd) as process:
            with Client.connect("127.0.0.1", outside[RELAY]) as client:
                assert client.read(TRIGGER, FunctionalConstraint.ST) is False
                process.terminate()
                assert process.wait(10) == 0, "at once, with a connection open"
            with pytest.raises(ConnectFailed):
                Client.connect("127.0.0.1", outside[RELAY], connect_timeout_s=1.0)
        with router(scd) as process:
            with pytest.raises(ConnectFailed):
                Client.connect("127.0.0.1", outside["A2_SEL710"], connect_timeout_s=2.0)
            assert process.stderr is not None
            line = process.stderr.readline()
            assert "relay unreachable" in line
            assert f"127.0.0.1:{inside['A2_SEL710']}" in line
            with Client.connect("127.0.0.1", outside[RELAY]) as client:
                assert client.read(TRIGGER, FunctionalConstraint.ST) is False, "the others work"


def is_passed_on(connection: socket.socket) -> bool:
    """Whether the relay's side, which greets, is there."""
    try:
        return connection.recv(5) == b"relay"
    except ConnectionResetError:
        return False


def test_connections_to_one_relay_are_bounded(enterprise: Path, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0), backlog=2 * MOST_CONNECTIONS) as relay, ExitStack() as open_:

        def greet() -> None:
            with suppress(OSError):  # the test has ended
                while True:
                    open_.enter_context(relay.accept()[0]).sendall(b"relay")

        inside = dict(zip(("A1_SEL710", "A2_SEL710", "A3_SEL710"), free_ports(3), strict=True))
        inside[RELAY] = relay.getsockname()[1]
        outside = dict(zip(inside, free_ports(3), strict=True))
        scd = tmp_path / "enterprise.scd"
        on_loopback(enterprise, scd, inside, outside)
        Thread(target=greet, daemon=True).start()

        def connect() -> socket.socket:
            return open_.enter_context(socket.create_connection(("127.0.0.1", outside[RELAY]), 5))

        with router(scd) as process:
            connections = [connect() for _ in range(MOST_CONNECTIONS)]
            assert all(is_passed_on(connection) for connection in connections)
            assert not is_passed_on(connect())
            assert process.stderr is not None
            line = process.stderr.readline()
            assert "connection refused" in line
            assert RELAY in line
            connections[0].close()
            assert eventually(lambda: is_passed_on(connect()), 5), "a place is free again"


def test_a_network_that_is_not_in_the_file_is_named(
    enterprise: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--scd", str(enterprise), "--inside", "FACTORY_C", "--outside", "WAN"]
    assert main(words) == 1
    told = capsys.readouterr().err
    assert told.startswith("router: ")
    assert 'a SubNetwork with name="FACTORY_C", found FACTORY_A, FACTORY_B, WAN' in told
