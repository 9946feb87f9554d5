"""Who keeps a place at the station where there are more connections than places, and who gives way."""

import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress

import pytest

from service.configuration.gateways.iec104 import Iec104Settings, Iec104Tls
from service.gateways.iec104.security import HANDSHAKE_S, Security
from service.gateways.iec104.server import BEGIN_S, StationServer
from service.gateways.iec104.telegrams import Control, single_point, unnumbered
from testing.ports import LOOPBACK, free_port
from testing.relays.pki import Pki
from testing.service.iec104_master import Master
from testing.waiting import wait_until
from tests.service.gateways.iec104.test_tls import linked
from tests.service.gateways.tls import files_of, pki

__all__ = ["pki"]  # a fixture

PLACES = Iec104Settings().max_connections
POINT = 1000


@contextmanager
def serving(
    *, places: int = PLACES, begin_within_s: float = BEGIN_S, security: Security | None = None
) -> Iterator[int]:
    """The port of a station with one point."""
    port = free_port()
    server = StationServer(
        LOOPBACK,
        port,
        station=1,
        max_connections=places,
        begin_within_s=begin_within_s,
        security=security,
    )
    server.put({POINT: single_point(on=True, quality=0, time_ns=None)})
    server.start()
    try:
        yield port
    finally:
        server.stop()


def tells(master: Master) -> bool:
    """Whether this controlling station is told what there is."""
    master.told.clear()
    master.interrogate()
    return list(master.told) == [POINT]


def is_tested(link: socket.socket) -> bool:
    """Whether the station answers a test on this connection."""
    link.sendall(unnumbered(Control.TEST_ACTIVATION))
    return link.recv(6) == unnumbered(Control.TEST_CONFIRMATION)


def is_ended(link: socket.socket) -> bool:
    """Whether the station ends the connection, and says nothing before."""
    with suppress(ConnectionError):
        return link.recv(1) == b""
    return True


def test_clients_that_test_and_never_begin_give_way_the_oldest_first() -> None:
    with serving() as port, ExitStack() as open_ones:
        working = open_ones.enter_context(closing(Master(LOOPBACK, port)))
        crowd = []
        for _ in range(2 * PLACES):
            one = open_ones.enter_context(socket.create_connection((LOOPBACK, port), timeout=20))
            assert is_tested(one), "the latest always has a place"
            crowd.append(one)
        late = open_ones.enter_context(closing(Master(LOOPBACK, port)))
        assert tells(late)
        assert tells(working)
        gone, kept = crowd[: 2 - PLACES], crowd[2 - PLACES :]
        assert all(is_ended(one) for one in gone)
        assert all(is_tested(one) for one in kept)


def test_who_has_begun_gives_way_to_nobody_until_it_stops() -> None:
    with serving() as port, ExitStack() as open_ones:
        links = [
            open_ones.enter_context(socket.create_connection((LOOPBACK, port), timeout=20))
            for _ in range(PLACES)
        ]
        masters = [Master(LOOPBACK, port, link) for link in links]
        for _ in range(PLACES):
            with socket.create_connection((LOOPBACK, port), timeout=20) as late:
                assert is_ended(late)
        assert all(tells(one) for one in masters)
        links[3].sendall(unnumbered(Control.STOP_ACTIVATION))
        assert links[3].recv(6) == unnumbered(Control.STOP_CONFIRMATION)
        with closing(Master(LOOPBACK, port)) as late_master:
            assert tells(late_master)
        assert is_ended(links[3])
        assert all(tells(one) for number, one in enumerate(masters) if number != 3)


def test_who_does_not_begin_in_time_is_sent_away_where_there_is_room_too() -> None:
    with serving(begin_within_s=0.5) as port, closing(Master(LOOPBACK, port)) as working:
        with socket.create_connection((LOOPBACK, port), timeout=20) as waiting:

            def is_sent_away() -> bool:
                try:
                    return not is_tested(waiting)
                except ConnectionError:
                    return True

            wait_until(is_sent_away, "the end of who does not begin")
        assert tells(working)


@pytest.fixture
def secured(pki: Pki) -> Iterator[int]:
    with serving(security=Security.of(Iec104Tls.model_validate(files_of(pki)))) as port:
        yield port


def test_handshakes_take_places_and_give_way_before_all_others(pki: Pki, secured: int) -> None:
    with ExitStack() as open_ones:
        waiting = open_ones.enter_context(linked(secured, pki, pki.client))
        assert is_tested(waiting)
        begun_s = time.monotonic()
        mute = [
            open_ones.enter_context(socket.create_connection((LOOPBACK, secured), timeout=20))
            for _ in range(2 * PLACES)
        ]
        gone, kept = mute[: PLACES + 1], mute[PLACES + 1 :]
        assert all(is_ended(one) for one in gone)
        assert time.monotonic() - begun_s < HANDSHAKE_S, "they gave way before their time was over"
        for one in kept:
            one.setblocking(False)  # noqa: FBT003 - the name of the standard library
            with pytest.raises(BlockingIOError):
                one.recv(1)
        link = open_ones.enter_context(linked(secured, pki, pki.client))
        assert tells(Master(LOOPBACK, secured, link))
        assert is_tested(waiting)


def test_no_handshake_takes_the_place_of_who_has_begun(pki: Pki, secured: int) -> None:
    with ExitStack() as open_ones:
        links = [open_ones.enter_context(linked(secured, pki, pki.client)) for _ in range(PLACES)]
        masters = [Master(LOOPBACK, secured, link) for link in links]
        with socket.create_connection((LOOPBACK, secured), timeout=20) as late:
            assert is_ended(late), "it is refused before anything is ciphered"
        assert all(tells(one) for one in masters)


def test_a_server_ends_in_the_middle_of_a_handshake(pki: Pki) -> None:
    security = Security.of(Iec104Tls.model_validate(files_of(pki)))
    with ExitStack() as open_ones:
        with serving(security=security) as port:
            mute = open_ones.enter_context(socket.create_connection((LOOPBACK, port), timeout=20))
            mute.sendall(b"\x16\x03\x01")
            with linked(port, pki, pki.client) as link:
                assert is_tested(link)
        assert is_ended(mute)
