"""Relays shared out between gateways by leases: over real MMS, with a real database, and real processes."""

import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

import scl
from mms import Server
from scl import Address
from scl.model_text import model_text
from service.api import ApiContext, create_app
from service.application.parts import running
from service.collector.gateway import gateway as gateway_module
from service.collector.gateway.gateway import Gateway, GatewayIdentity
from service.collector.session.relay_session import RelaySession
from service.collector.session.visit_marks import BUSY
from service.collector.supervision.gateway_processes import COLLECTOR, COMMAND, GatewayProcesses
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.demo.addresses import free_ports
from service.plant import Plant, read_plant
from service.plant.handover import plant_to_bytes
from service.recording_store.folder import FolderStore
from service.storage import LeaseLostError, Repository, connect
from service.storage.states import LinkState
from service.supervision.supervised_process import SupervisedProcess
from service.timing.backoff import Backoff
from testing.service.database import make_database
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import eventually
from tests.service.api.serving import serving

LEASE_S = 1.5


@dataclass
class Hall:
    """Six relays that count their visitors, and the database of whoever visits them."""

    plant: Plant
    repository: Repository
    settings: Settings
    servers: dict[str, Server]
    most_visitors: int = 0
    _closed: Event = field(default_factory=Event)

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Looks all the time how many visit one relay at once."""

        def look() -> None:
            while not self._closed.wait(0.005):
                self.most_visitors = max(self.most_visitors, *map(visitors, self.servers.values()))

        thread = Thread(target=look)
        thread.start()
        try:
            yield
        finally:
            self._closed.set()
            thread.join()

    def settings_of(self, host: str) -> Settings:
        directory = self.settings.data_directory / host
        directory.mkdir(exist_ok=True)
        return self.settings.model_copy(update={"data_directory": directory})

    def shares(self) -> dict[str, int]:
        return {gateway.id: gateway.relays for gateway in self.repository.gateways()}

    def all_visited(self) -> bool:
        return all(visitors(server) == 1 for server in self.servers.values())

    def links(self) -> set[LinkState]:
        return {ied.link_state for ied in self.repository.relays(limit=100).items}


def visitors(server: Server) -> int:
    return server.connections


@pytest.fixture
def hall(tmp_path: Path) -> Iterator[Hall]:
    names = [ied.name for ied in scl.read(scl.DEMO_PLANT_SCD).ieds]
    scd = tmp_path / "plant.scd"
    addresses = {n: Address("127.0.0.1", p) for n, p in zip(names, free_ports(len(names)), strict=True)}
    scl.with_addresses(scl.DEMO_PLANT_SCD, scd, addresses)
    settings = Settings(
        data_directory=tmp_path / "data",
        recordings_directory=tmp_path / "recordings",
        database_url=make_database(tmp_path),
        scd=scd,
        motors=MOTORS,
        lease_s=LEASE_S,
        poll_period_s=0.5,
        connect_timeout_s=1.0,
        request_timeout_s=1.0,
    )
    settings.data_directory.mkdir()
    plant = read_plant(settings)
    repository = Repository(connect(settings.database_url))
    repository.sync_plant(plant)
    with ExitStack() as stack:
        servers = {}
        for name in names:
            root = tmp_path / name
            (root / "EVENTS").mkdir(parents=True)
            server = Server(model_text(scl.read(scd), name), port=addresses[name].port, file_root=root)
            server.start()
            stack.callback(server.stop)
            servers[name] = server
        yield Hall(plant, repository, settings, servers)


@contextmanager
def gateway(
    hall: Hall, name: str, *, most: int = 100, on_expiry: Callable[[], None] = lambda: None
) -> Iterator[Gateway]:
    """A gateway on a thread; the block's end is its ordinary end."""
    settings = hall.settings.model_copy(update={"relays_per_gateway": most})
    made = Gateway(
        GatewayIdentity(name, "here", os.getpid()),
        hall.plant,
        Repository(connect(settings.database_url)),
        FolderStore(settings.recordings_directory),
        settings,
        on_expiry=on_expiry,
    )
    stop = Event()
    thread = Thread(target=made.run, args=(stop,))
    thread.start()
    try:
        yield made
    finally:
        stop.set()
        thread.join(15)
        assert not thread.is_alive()


def test_relays_are_shared_out_and_given_back_and_never_visited_by_two(hall: Hall) -> None:
    with hall.watched():
        with gateway(hall, "a"):
            assert eventually(lambda: hall.shares() == {"a": 6} and hall.all_visited())
            with gateway(hall, "b"), gateway(hall, "c"):
                assert eventually(lambda: hall.shares() == {"a": 2, "b": 2, "c": 2}, within_s=20)
                assert eventually(hall.all_visited)
            assert eventually(lambda: hall.shares() == {"a": 6} and hall.all_visited(), within_s=20)
        assert hall.shares() == {}
        assert hall.links() == {LinkState.UNKNOWN}
    assert hall.most_visitors == 1


def test_leases_are_renewed_while_many_sessions_are_started(
    hall: Hall, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The start of 250 sessions took longer than the lease: each gateway of a thousand relays ended again."""

    class SlowSession(RelaySession):
        def __init__(self, *given: Any, **named: Any) -> None:
            time.sleep(LEASE_S / 3)
            super().__init__(*given, **named)

    monkeypatch.setattr(gateway_module, "RelaySession", SlowSession)
    expired: list[float] = []
    with gateway(hall, "one", on_expiry=lambda: expired.append(time.monotonic())):
        assert eventually(hall.all_visited, 10 * LEASE_S)
    assert expired == []


def test_a_gateway_writes_down_what_its_relays_measure(hall: Hall) -> None:
    hall.settings = hall.settings.model_copy(update={"metering_period_s": 0.2})
    server = hall.servers["A1_SEL710"]
    server.update("A1_SEL710MET/METMMXU1.Hz.mag.f", 50.5)
    with gateway(hall, "a"):
        assert eventually(lambda: len(hall.repository.measurements("PUMP-A1", 0, limit=5).items) == 5)
        assert eventually(
            lambda: all(hall.repository.measurements(m.name, 0, limit=1).items for m in hall.plant.motors)
        )
    (*_, latest) = hall.repository.measurements("PUMP-A1", 0, limit=5).items
    assert latest.values["frequency_Hz"] == pytest.approx(50.5)


def test_a_gateway_takes_no_more_than_it_may(hall: Hall) -> None:
    with gateway(hall, "a", most=4):
        assert eventually(lambda: hall.shares() == {"a": 4})
        with gateway(hall, "b", most=4):
            assert eventually(lambda: hall.shares() == {"a": 3, "b": 3}, within_s=20)
            assert eventually(hall.all_visited)


@contextmanager
def supervised(hall: Hall, host: str) -> Iterator[SupervisedProcess]:
    """A gateway process, kept running as the service does it, of a host of its own."""
    supervisor = SupervisedProcess(
        COLLECTOR, (*COMMAND, "0"), hall.settings_of(host), handed=plant_to_bytes(hall.plant)
    )
    supervisor.start()
    try:
        yield supervisor
    finally:
        supervisor.stop()


def process_of(supervisor: SupervisedProcess) -> int:
    found = supervisor.process_id
    assert found is not None
    return found


def freeze(process_id: int, database_url: str) -> None:
    """Stop a process between two of its transactions: within one it would hold SQLite's lock for all."""
    database = sqlite3.connect(database_url.removeprefix("sqlite:///"), timeout=0.5)

    def frozen() -> bool:
        os.kill(process_id, signal.SIGSTOP)
        try:
            database.execute("BEGIN IMMEDIATE")
        except sqlite3.OperationalError:
            os.kill(process_id, signal.SIGCONT)
            return False
        database.rollback()
        return True

    with closing(database):
        assert eventually(frozen)


def test_relays_of_a_frozen_host_are_taken_over_until_it_wakes(hall: Hall) -> None:
    hall.settings = hall.settings.model_copy(update={"lease_s": 2 * LEASE_S})
    with supervised(hall, "one") as one, supervised(hall, "two"):
        assert eventually(lambda: sorted(hall.shares().values()) == [3, 3] and hall.all_visited(), 60)
        frozen = process_of(one)
        freeze(frozen, hall.settings.database_url)
        frozen_s = time.monotonic()
        try:
            assert eventually(lambda: list(hall.shares().values()) == [6], 60)
            assert time.monotonic() - frozen_s >= LEASE_S, "nobody is declared dead in a hurry"
        finally:
            os.kill(frozen, signal.SIGCONT)
        assert eventually(lambda: one.process_id not in (None, frozen), 30), "it ends when it wakes"
        assert eventually(
            lambda: sorted(hall.shares().values()) == [3, 3] and hall.links() == {LinkState.UP}, 60
        )


@pytest.mark.campaign
@pytest.mark.parametrize("stray", ["NOT-A-RELAY", "a folder"])
def test_a_stray_file_among_the_marks_of_visits_keeps_no_gateway_from_coming_again(
    hall: Hall, stray: str
) -> None:
    gateways = GatewayProcesses(hall.settings, hall.plant, hall.repository)
    with running([gateways]):
        assert eventually(hall.all_visited, 60)
        (first,) = hall.repository.gateways()
        marks = hall.settings.data_directory / "visiting" / "0"
        if stray == "a folder":
            (marks / stray).mkdir()
        else:
            (marks / stray).write_bytes(BUSY)
        os.kill(first.process_id, signal.SIGSEGV)
        assert eventually(
            lambda: (
                first.process_id not in (found := [each.process_id for each in hall.repository.gateways()])
                and bool(found)
            ),
            60,
        )
        assert gateways.problem() is None


@pytest.mark.campaign
def test_a_gateway_that_cannot_write_what_it_measures_is_not_ready(hall: Hall) -> None:
    # On a busy machine no link may fail: then nothing would be measured, and nothing refused.
    hall.settings = hall.settings.model_copy(update={"metering_period_s": 0.2, "request_timeout_s": 20.0})
    gateways = GatewayProcesses(hall.settings, hall.plant, hall.repository)
    store = FolderStore(hall.settings.recordings_directory)
    context = ApiContext(hall.settings, hall.repository, store, readiness={"collector": gateways.problem})
    with (
        running([gateways]),
        serving(create_app(context)) as client,
        closing(sqlite3.connect(hall.settings.database_url.removeprefix("sqlite:///"), timeout=60)) as tables,
    ):
        motor = hall.plant.motors[0].name
        assert eventually(lambda: hall.repository.measurements(motor, 0, limit=1).items, 60)
        assert eventually(lambda: client.get("/readyz").json()["parts"]["collector"] == "ready")
        tables.execute(
            "CREATE TRIGGER refusal BEFORE INSERT ON measurements BEGIN SELECT RAISE(ABORT, 'no room'); END"
        )
        assert eventually(lambda: "no room" in client.get("/readyz").json()["parts"]["collector"])
        refused = client.get("/readyz")
        assert refused.status_code == 503
        (listed,) = client.get("/api/v1/gateways").json()["items"]
        # Each batch may lose another number of items, so that the two answers need not name the same one.
        for told in (refused.json()["parts"]["collector"], f"{listed['id']}: {listed['problem']}"):
            assert told.startswith(f"{listed['id']}: batch writer: BatchRefusedError: ")
            assert "the database refuses them: " in told
            assert "no room" in told
        tables.execute("DROP TRIGGER refusal")
        assert eventually(lambda: client.get("/readyz").status_code == 200, 60)
        (listed,) = client.get("/api/v1/gateways").json()["items"]
        assert listed["problem"] is None


def test_gateways_alone_share_the_relays_of_a_service_elsewhere(hall: Hall) -> None:
    settings = hall.settings_of("other").model_copy(update={"lease_s": 10.0, "relays_per_gateway": 3})
    chosen = settings.model_dump(mode="json", exclude_defaults=True)
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith("MCC_")},
        **{f"MCC_{name.upper()}": str(value) for name, value in chosen.items()},
    }
    with subprocess.Popen([sys.executable, "-m", "service.cli", "collect"], env=environment) as host:
        try:
            assert eventually(lambda: sorted(hall.shares().values()) == [3, 3] and hall.all_visited(), 60)
            with gateway(hall, "of the service"):
                assert eventually(lambda: sorted(hall.shares().values()) == [2, 2, 2], 60)
            host.terminate()
            assert host.wait(30) == 0
            assert hall.shares() == {}
        finally:
            host.kill()


def test_a_gateway_that_cannot_renew_its_leases_ends_and_its_connections_with_it(hall: Hall) -> None:
    lease_s = 3 * LEASE_S
    hall.settings = hall.settings.model_copy(update={"lease_s": lease_s})
    with (
        supervised(hall, "a") as supervisor,
        closing(
            sqlite3.connect(hall.settings.database_url.removeprefix("sqlite:///"), timeout=60)
        ) as locking,
    ):
        assert eventually(hall.all_visited, 60)
        visiting = process_of(supervisor)
        locking.execute("BEGIN IMMEDIATE")
        silent_s = time.monotonic()
        assert eventually(lambda: supervisor.process_id != visiting)
        assert eventually(lambda: all(visitors(server) == 0 for server in hall.servers.values()))
        assert time.monotonic() - silent_s < lease_s, "before anybody else can think it dead"
        locking.rollback()
        assert eventually(hall.all_visited, 60)


def test_a_gateway_declared_dead_by_mistake_starts_again(hall: Hall) -> None:
    with gateway(hall, "a"):
        assert eventually(lambda: hall.shares() == {"a": 6})
        assert hall.repository.end_gateway("a", now_ns=NOW_NS)
        assert eventually(lambda: hall.shares() == {"a": 6} and hall.all_visited())


def test_relays_set_aside_by_a_clock_that_was_ahead_are_visited(hall: Hall) -> None:
    aside, ahead = sorted(hall.servers)[:2]
    for ied, ahead_s in ((aside, 0), (ahead, 86_400)):
        now_ns = time.time_ns() + ahead_s * SECOND_NS
        hall.repository.set_aside(ied, "why", backoff=Backoff(60.0, 86_400.0), now_ns=now_ns)
    with gateway(hall, "a"):
        assert eventually(lambda: sum(map(visitors, hall.servers.values())) == 5)
        assert visitors(hall.servers[ahead]) == 1
        assert visitors(hall.servers[aside]) == 0
        assert hall.repository.relay(aside).link_state is LinkState.QUARANTINED


def test_a_trigger_needs_the_lease(hall: Hall) -> None:
    repository = hall.repository
    motor = hall.plant.motors[0]
    report = repository.request_recording(motor.name, now_ns=NOW_NS)
    repository.register_gateway("a", host="here", process_id=1, now_ns=NOW_NS)
    repository.share_relays("a", [motor.relay], most=10, problem=None)
    repository.register_gateway("b", host="here", process_id=2, now_ns=NOW_NS)
    with pytest.raises(LeaseLostError, match=f"gateway b does not hold the lease of {motor.relay}"):
        repository.mark_triggered(report.id, now_ns=NOW_NS, gateway="b")
    assert repository.recording_request(report.id).triggered_ns is None
    assert repository.mark_triggered(report.id, now_ns=NOW_NS, gateway="a").triggered_ns == NOW_NS
    assert not repository.end_gateway("a", now_ns=NOW_NS, heartbeats=7), "it has gone on since"
    assert repository.end_gateway("a", now_ns=NOW_NS, heartbeats=1)
    with pytest.raises(LeaseLostError):
        repository.share_relays("a", [motor.relay], most=10, problem=None)
