"""Many servers on one thread."""

import io
import queue
import statistics
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import pytest

from mms import Client, FunctionalConstraint, Report, Server, ServerPump, ServerStartFailed
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT
from testing.waiting import eventually

IND01 = "T1PRO/GGIO1.Ind01.stVal"
ST = FunctionalConstraint.ST


def _running(count: int, file_root: Path | None = None) -> tuple[ServerPump, list[Server]]:
    """A started pump; tries again if another process took one of the ports."""
    for attempt in range(5):
        servers = [Server(MODEL_TEXT, port=free_port(), file_root=file_root) for _ in range(count)]
        pump = ServerPump(servers)
        try:
            pump.start()
        except ServerStartFailed:
            if attempt == 4:
                raise
        else:
            return pump, servers
    raise AssertionError("unreachable")


@pytest.fixture
def plant() -> Iterator[list[Server]]:
    pump, servers = _running(12)
    yield servers
    pump.stop()


def test_one_thread_serves_many_servers(plant: list[Server]) -> None:
    before = {thread.name for thread in threading.enumerate() if thread.name == "mms-pump"}
    assert before == {"mms-pump"}
    with ExitStack() as stack:
        clients = [stack.enter_context(Client.connect(LOOPBACK, server.port)) for server in plant]
        for number, server in enumerate(plant):
            server.update("T1PRO/GGIO1.Types.int32", number)
        assert [client.read("T1PRO/GGIO1.Types.int32", ST) for client in clients] == list(range(len(plant)))


def test_every_server_reports_soon_after_an_update(plant: list[Server]) -> None:
    reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
    with ExitStack() as stack:
        for server in plant:
            client = stack.enter_context(Client.connect(LOOPBACK, server.port))
            client.subscribe("T1PRO/LLN0.BR.BRep01", reports)
        started_s = time.monotonic()
        for server in plant:
            server.update(IND01, value=True)
        for _ in plant:
            reports.get(timeout=5)
        assert time.monotonic() - started_s < 1


def test_requests_are_answered_within_milliseconds(plant: list[Server]) -> None:
    with ExitStack() as stack:
        clients = [stack.enter_context(Client.connect(LOOPBACK, server.port)) for server in plant]
        durations_s = []
        for client in clients * 5:
            started_s = time.monotonic()
            client.read(IND01, ST)
            durations_s.append(time.monotonic() - started_s)
        assert statistics.median(durations_s) < 0.02  # about 3 ms; a shared machine has its moods


def test_an_idle_pump_leaves_the_processor_alone(plant: list[Server]) -> None:
    with ExitStack() as stack:
        for server in plant:
            stack.enter_context(Client.connect(LOOPBACK, server.port))
        used_s, started_s = time.process_time(), time.monotonic()
        threading.Event().wait(1.0)
        share = (time.process_time() - used_s) / (time.monotonic() - started_s)
        assert share < 0.3  # about 0.03, clients included


def test_a_port_that_is_taken_starts_none(plant: list[Server]) -> None:
    free, taken = Server(MODEL_TEXT, port=free_port()), Server(MODEL_TEXT, port=plant[0].port)
    with pytest.raises(ServerStartFailed):
        ServerPump([free, taken]).start()
    assert not free.is_running


def test_a_pump_starts_once() -> None:
    pump, _ = _running(1)
    with pytest.raises(RuntimeError, match="started before"):
        pump.start()
    pump.stop()
    pump.stop()


def test_a_pump_never_started_frees_its_servers() -> None:
    server = Server(MODEL_TEXT, port=free_port())
    ServerPump([server]).stop()
    with pytest.raises(RuntimeError, match="is stopped"):
        server.read(IND01)


def test_a_context_stops_all_servers() -> None:
    servers = [Server(MODEL_TEXT, port=free_port()) for _ in range(2)]
    with ServerPump(servers):
        assert all(server.is_running for server in servers)
    assert not any(server.is_running for server in servers)


def test_one_server_may_stop_while_the_others_go_on(plant: list[Server]) -> None:
    with Client.connect(LOOPBACK, plant[1].port) as other:
        with Client.connect(LOOPBACK, plant[0].port) as first:
            plant[0].stop()
            assert first.wait_closed(10)
        assert other.read(IND01, ST) is False


def test_a_client_that_does_not_read_holds_up_nobody(file_root: Path) -> None:
    """Its download stops when the buffers are full; the pump goes on serving the others."""
    (file_root / "EVENTS" / "BIG.DAT").write_bytes(bytes(20_000_000))
    pump, servers = _running(2, file_root)
    stuck, release = threading.Event(), threading.Event()

    class Stuck(io.BytesIO):
        def write(self, chunk: bytes, /) -> int:  # type: ignore[override]
            stuck.set()
            release.wait(10)
            return super().write(chunk)

    with (
        Client.connect(LOOPBACK, servers[0].port) as slow,
        Client.connect(LOOPBACK, servers[1].port) as quick,
    ):
        fetcher = threading.Thread(target=lambda: slow.download("EVENTS/BIG.DAT", Stuck()))
        fetcher.start()
        assert stuck.wait(10)
        assert quick.read(IND01, ST) is False
        assert slow.read(IND01, ST) is False, "requests go between the parts of a download"
        release.set()
        fetcher.join(20)
    assert eventually(lambda: servers[0].connections == 0)
    pump.stop()


class _QuietServer:
    """A server that nobody has sent anything; it counts how often it is asked."""

    connections = 1

    def __init__(self) -> None:
        self.polled_s: list[float] = []

    def tell_updates(self, updated: Callable[[], None]) -> None:
        del updated

    def listen(self) -> None:
        pass

    def serve_pending(self) -> bool:
        self.polled_s.append(time.monotonic())
        return False

    def take_turn(self) -> bool:
        return False

    def close(self) -> None:
        pass


def test_a_server_that_is_told_of_is_polled_then_and_hardly_ever_else() -> None:
    servers = [_QuietServer() for _ in range(300)]

    def all_polled_since(moment_s: float) -> bool:
        return all(each.polled_s[-1:] >= [moment_s] for each in servers)

    with ServerPump(servers) as pump:
        delays_s = []
        for _ in range(20):
            told_s = time.monotonic()
            for server in servers:
                pump.expect(server)
            assert eventually(partial(all_polled_since, told_s))
            delays_s.append(max(server.polled_s[-1] for server in servers) - told_s)
        assert statistics.median(delays_s) < 0.1, "far less than the 0.3 s that 300 servers may be left alone"
        told_s = time.monotonic()
        assert eventually(lambda: time.monotonic() - told_s > 2.0)
    polls = sum(told_s + 1.0 < polled_s < told_s + 2.0 for each in servers for polled_s in each.polled_s)
    assert polls < 8 * len(servers), "servers that nobody is told of are polled 13 times"


def test_others_servers_are_no_business_of_a_pump() -> None:
    server = _QuietServer()
    with ServerPump([server]) as pump:
        pump.expect(_QuietServer())
        assert eventually(lambda: len(server.polled_s) >= 2)
