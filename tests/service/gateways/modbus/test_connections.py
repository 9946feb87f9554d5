"""Requests that come close together or octet by octet, and clients that take all places of the defaults."""

import socket
import struct
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.modbus.server import SILENT_S
from service.storage import Repository, connect
from testing.ports import LOOPBACK
from testing.service.database import make_database
from testing.service.gateways import running_gateways
from testing.service.plants import two_motor_plant
from testing.waiting import wait_until
from tests.service.gateways.modbus.telegrams import next_answer, reading, registers
from tests.service.gateways.settings import port_of, settings_of

PLACES = ModbusSettings().max_connections
VERSION_AND_BLOCKS = bytes.fromhex("0404 0001 0002")
"""What is answered to who reads the first two registers."""
UNFINISHED = struct.pack(">HHHB", 1, 0, 254, 1)
"""Head of a request that is never whole."""


MOST_TAKEN = 64 * 1024**2
"""Far more than the system's buffers on both sides take."""


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    directory = tmp_path_factory.mktemp("plant")
    Repository(connect(make_database(directory))).sync_plant(two_motor_plant())
    settings = settings_of("modbus", directory)
    with running_gateways(settings):
        yield port_of(settings)


def linked(port: int) -> socket.socket:
    link = socket.create_connection((LOOPBACK, port), timeout=20)
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return link


def is_ended(link: socket.socket) -> bool:
    """Whether the server ends the connection, and says nothing before."""
    with suppress(ConnectionError):
        return link.recv(1) == b""
    return True


def works(link: socket.socket) -> bool:
    return registers(link, 0, 2) == (1, 2)


@pytest.fixture
def link(port: int) -> Iterator[socket.socket]:
    with linked(port) as link:
        yield link


@pytest.mark.parametrize("count", [2, 3, 50])
def test_requests_in_one_segment_are_answered_each_in_order(link: socket.socket, count: int) -> None:
    counts = [1 + number % 7 for number in range(count)]
    link.sendall(b"".join(reading(0, one, transaction=number) for number, one in enumerate(counts)))
    found = [next_answer(link) for _ in counts]
    assert [(transaction, len(content)) for transaction, content in found] == [
        (number, 2 + 2 * one) for number, one in enumerate(counts)
    ]
    link.sendall(reading(0, 2, transaction=9999))
    assert next_answer(link) == (9999, VERSION_AND_BLOCKS), "none was answered twice"


def test_a_request_that_comes_octet_by_octet_is_answered(link: socket.socket) -> None:
    for transaction in (1, 2):
        for octet in reading(0, 2, transaction=transaction):
            link.sendall(bytes([octet]))
        assert next_answer(link) == (transaction, VERSION_AND_BLOCKS)


@pytest.mark.parametrize("cut", [1, 6, 7, 8, 11])
def test_a_request_that_is_begun_is_kept_while_the_one_before_is_answered(
    link: socket.socket, cut: int
) -> None:
    begun = reading(0, 2, transaction=2)
    link.sendall(reading(0, 2, transaction=1) + begun[:cut])
    assert next_answer(link) == (1, VERSION_AND_BLOCKS)
    link.sendall(begun[cut:])
    assert next_answer(link) == (2, VERSION_AND_BLOCKS)


def test_a_frame_of_another_protocol_is_passed_over(link: socket.socket) -> None:
    foreign = [reading(0, 2, transaction=one, protocol=one) for one in (1, 0xFFFF)]
    link.sendall(foreign[0] + reading(0, 2, transaction=2) + foreign[1])
    link.sendall(reading(0, 2, transaction=3))
    assert [next_answer(link) for _ in range(2)] == [(2, VERSION_AND_BLOCKS), (3, VERSION_AND_BLOCKS)]


@pytest.mark.parametrize("length", [0, 1, 255, 0xFFFF])
def test_a_length_that_no_request_has_ends_the_connection(link: socket.socket, length: int) -> None:
    link.sendall(reading(0, 2, transaction=1))
    assert next_answer(link) == (1, VERSION_AND_BLOCKS)
    link.sendall(struct.pack(">HHH", 2, 0, length))
    assert is_ended(link)


def drip(crowd: Sequence[socket.socket]) -> None:
    """Send one octet more of what is never whole, wherever somebody still listens."""
    for one in crowd:
        with suppress(ConnectionError):
            one.sendall(b"\x00")


def test_more_clients_that_drip_octets_than_places_give_way_the_oldest_first(
    port: int, link: socket.socket
) -> None:
    assert works(link)
    with ExitStack() as open_ones:
        crowd = [open_ones.enter_context(linked(port)) for _ in range(2 * PLACES)]
        for one in crowd:
            one.sendall(UNFINISHED)
        drip(crowd)
        newest = open_ones.enter_context(linked(port))
        assert works(newest)
        assert works(link)
        gone, kept = crowd[: 2 - PLACES], crowd[2 - PLACES :]
        assert all(is_ended(one) for one in gone)
        for one in kept:
            one.setblocking(False)  # noqa: FBT003 - the name of the standard library
            with pytest.raises(BlockingIOError):
                one.recv(1)


def test_clients_that_asked_once_and_then_drip_give_way_to_others_but_no_client_that_asks(
    port: int, link: socket.socket
) -> None:
    with ExitStack() as open_ones:
        crowd = [open_ones.enter_context(linked(port)) for _ in range(PLACES - 1)]
        begun_s = time.monotonic()
        for one in crowd:
            assert works(one)
            one.sendall(UNFINISHED)

        def newest_works() -> bool:
            drip(crowd)
            assert works(link)
            with linked(port) as newest, suppress(ConnectionError, AssertionError):
                return works(newest)
            return False

        wait_until(newest_works, "a place for one more")
        assert time.monotonic() - begun_s >= SILENT_S, "who has just asked keeps the place"
        assert is_ended(crowd[0])
        assert works(link)


@pytest.mark.usefixtures("repository")
def test_a_client_that_takes_no_answers_is_heard_no_more_and_sent_away(tmp_path: Path) -> None:
    settings = settings_of("modbus", tmp_path, idle_timeout_s=2)
    requests = reading(0, 125, transaction=1) * 1000
    sent, waits = 0, 0
    with (
        running_gateways(settings),
        linked(port_of(settings)) as other,
        linked(port_of(settings)) as deaf,
    ):
        deaf.settimeout(0.1)
        with suppress(ConnectionError):
            while sent < MOST_TAKEN:
                try:
                    sent += deaf.send(requests[sent % len(requests) :])
                except TimeoutError:
                    waits += 1
                    assert works(other)
        assert waits, "it was sent away at once"
        assert sent < MOST_TAKEN, "it was heard all the time"
        assert works(other)
