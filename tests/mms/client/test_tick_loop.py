"""Connections without threads of their own: driven by loops, each by the socket that belongs to it."""

import queue
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import pytest

from mms import Client, ConnectionLost, FunctionalConstraint, MmsError, Report, Server, Timeout
from scl import Address
from testing.ports import LOOPBACK, free_port
from testing.relays.serving import RelayProcess, start_relay
from testing.tcp_proxy import Proxy
from testing.waiting import eventually

IND01 = "T1PRO/GGIO1.Ind01.stVal"
RELAYS = 5
MANY = 5 * RELAYS
TOGETHER = 100
NONSENSE = bytes.fromhex("0300000b02f080ffffffff")
"""A whole message of the transport whose session layer is none."""


@dataclass(frozen=True, slots=True)
class Hall:
    """Relays of five sessions each, which their clients take in turns."""

    relays: tuple[Server, ...]

    def connect(self, number: int = 0) -> Client:
        return Client.connect(LOOPBACK, self.relays[number % len(self.relays)].port)

    @property
    def visitors(self) -> int:
        return sum(relay.connections for relay in self.relays)


@pytest.fixture(scope="module")
def hall() -> Iterator[Hall]:
    with ExitStack() as stack:
        yield Hall(tuple(stack.enter_context(start_relay()) for _ in range(RELAYS)))


@pytest.fixture(autouse=True)
def _empty(hall: Hall) -> None:
    assert eventually(lambda: hall.visitors == 0)


def threads() -> int:
    return sum(1 for _ in Path("/proc/self/task").iterdir())


def sockets() -> int:
    found = 0
    for link in Path("/proc/self/fd").iterdir():
        with suppress(FileNotFoundError):  # the descriptor of this very listing
            found += str(link.readlink()).startswith("socket:")
    return found


def is_read(client: Client) -> bool:
    return client.read(IND01, FunctionalConstraint.ST) is False


def test_a_connection_has_no_thread_of_its_own(hall: Hall) -> None:
    with hall.connect() as first, ExitStack() as stack:
        before = threads()
        clients = [stack.enter_context(hall.connect(number)) for number in range(1, MANY)]
        assert all(map(is_read, [first, *clients]))
        # The timer of a connect may need a moment to end, also that of the first.
        assert eventually(lambda: threads() <= before)


def test_connects_at_the_same_moment_find_each_its_own_socket(hall: Hall) -> None:
    before = sockets()
    with ThreadPoolExecutor(MANY) as pool:
        clients = list(pool.map(hall.connect, range(MANY)))
    for closed, client in enumerate(clients, 1):
        client.close()
        assert all(map(is_read, clients[closed:]))
    assert eventually(lambda: sockets() == before)


def test_a_frozen_relay_holds_up_no_other(relay_process: RelayProcess, hall: Hall) -> None:
    slowest_s = 0.0
    with ExitStack() as stack:
        frozen = stack.enter_context(Client.connect(LOOPBACK, relay_process.port, request_timeout_s=1.0))
        others = [stack.enter_context(hall.connect(number)) for number in range(8)]
        relay_process.freeze()
        with ThreadPoolExecutor(1) as pool:
            asked_s = time.monotonic()
            refused = pool.submit(frozen.read, IND01, FunctionalConstraint.ST)
            while not refused.done():
                for other in others:
                    begun_s = time.monotonic()
                    assert is_read(other)
                    slowest_s = max(slowest_s, time.monotonic() - begun_s)
            took_s = time.monotonic() - asked_s
        assert isinstance(refused.exception(), Timeout)
    assert 1.0 <= took_s < 2.5
    assert slowest_s < 1.0


@contextmanager
def nonsense_after(port: int, client_messages: int, *, asked: bool = True) -> Iterator[int]:
    """A proxy that says nonsense and then keeps silent; gives its port. asked: only as the next answer."""

    def serve() -> None:
        client, _ = listener.accept()
        with client, socket.create_connection((LOOPBACK, port)) as relay:
            for _ in range(client_messages):
                relay.sendall(client.recv(65_536))
                client.sendall(relay.recv(65_536))
            if asked:
                client.recv(65_536)
            client.sendall(NONSENSE)
            done.wait(30)

    done = threading.Event()
    with socket.create_server((LOOPBACK, 0)) as listener:
        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield int(listener.getsockname()[1])
        finally:
            done.set()
            thread.join(10)


def test_nonsense_ends_the_association_long_before_the_answer_is_overdue(hall: Hall) -> None:
    # Transport, association, names of the devices: the next request is the first of ours.
    with (
        nonsense_after(hall.relays[0].port, 3) as port,
        Client.connect(LOOPBACK, port, request_timeout_s=30.0) as client,
    ):
        asked_s = time.monotonic()
        with pytest.raises(ConnectionLost):
            is_read(client)
        assert time.monotonic() - asked_s < 5
        assert not client.is_open


def test_nonsense_is_noticed_though_nothing_is_asked(hall: Hall) -> None:
    with (
        nonsense_after(hall.relays[0].port, 3, asked=False) as port,
        Client.connect(LOOPBACK, port, request_timeout_s=30.0) as client,
    ):
        assert client.wait_closed(10)
        assert not client.is_open


def test_a_slow_callback_holds_up_no_other_relay(hall: Hall) -> None:
    """More callbacks than loops: a loop that waited for one would answer nobody."""
    begun, done = threading.Semaphore(0), threading.Event()

    def linger() -> None:
        begun.release()
        done.wait(30)

    with ExitStack() as stack:
        others = [stack.enter_context(hall.connect(number)) for number in range(8)]
        for _ in range(8):
            ending = start_relay()
            stack.callback(ending.stop)
            client = Client.connect(LOOPBACK, ending.port, on_closed=linger)
            stack.callback(client.close)
            ending.stop()
        assert all(begun.acquire(timeout=10) for _ in range(8))
        assert all(map(is_read, others))
        done.set()


def test_messages_that_come_together_are_all_read(hall: Hall) -> None:
    """More of them than the library would be let read in one go; others are answered in between."""
    relay, reports = hall.relays[0], queue.SimpleQueue[Report]()
    own, seen = Address(LOOPBACK, relay.port), Address(LOOPBACK, free_port())
    with (
        Proxy({"relay": (own, seen)}) as proxy,
        hall.connect(1) as other,
        Client.connect(LOOPBACK, seen.port) as client,
    ):
        client.subscribe("T1PRO/LLN0.RP.URep01", reports)
        proxy.freeze("relay", on=True)
        for number in range(TOGETHER):
            relay.update_many({IND01: number % 2 == 0})
        proxy.freeze("relay", on=False)
        assert is_read(other)
        came = [reports.get(timeout=10) for _ in range(TOGETHER)]
        relay.update_many({IND01: False})
    assert [report.sequence_number for report in came] == list(range(TOGETHER))


CROWDED = """
import os, resource, sys
from mms import Client, ConnectFailed
from mms.binding.library import library
library()
"relay".encode("idna")  # Python loads the codec when it is first needed
_, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
resource.setrlimit(resource.RLIMIT_NOFILE, (int(sys.argv[2]), hard))
try:
    for _ in range(int(sys.argv[3])):
        os.open(os.devnull, os.O_RDONLY)
except OSError:
    pass
try:
    Client.connect("127.0.0.1", int(sys.argv[1]))
except ConnectFailed as error:
    print(error)
"""


@pytest.mark.parametrize(
    ("allowed", "opened", "told"),
    [
        (4096, 1030, "descriptors below 1024 only"),
        (200, 1030, "no socket can be opened: Too many open files"),
    ],
)
def test_a_process_with_too_many_open_files_says_so(hall: Hall, allowed: int, opened: int, told: str) -> None:
    command = [sys.executable, "-c", CROWDED, str(hall.relays[0].port), str(allowed), str(opened)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert told in ended.stdout, ended.stderr


def test_a_client_may_be_closed_while_others_are_asked(hall: Hall) -> None:
    stop = threading.Event()
    failures: list[MmsError] = []

    def come_and_go(number: int) -> None:
        while not stop.is_set():
            try:
                with hall.connect(number) as client:
                    is_read(client)
            except MmsError as error:
                failures.append(error)

    visitors = [threading.Thread(target=come_and_go, args=(number,)) for number in range(RELAYS)]
    with hall.connect() as steady:
        for visitor in visitors:
            visitor.start()
        assert all(is_read(steady) for _ in range(200))
        stop.set()
        for visitor in visitors:
            visitor.join(20)
    assert failures == []
