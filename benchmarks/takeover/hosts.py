"""A service on a PostgreSQL server, and hosts beside it that can be killed, frozen and cut off from it.

A host is one of gateways, one of workers, or a whole service like the first one.
"""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TypeVar

from sqlalchemy import Engine, Select, text

from scl import Address
from service.demo.addresses import LOOPBACK, free_ports
from service.storage import Repository, connect
from testing.service.postgresql import INSTALLED, OPTIONS, OWNER, binaries, serving_postgresql
from testing.service.processes import (
    Service,
    SimulatedPlant,
    descendants,
    is_alive,
    running_service,
    service_environment,
    simulated_plant,
)
from testing.tcp_proxy import Proxy
from testing.waiting import wait_until

Thing = TypeVar("Thing", bound=Hashable)

DATABASE = "mcc"
NAMES = ("first", "second")
SERVE = "serve"
END_LIMIT_S = 20.0
RENEWAL_LIMIT_S = 60.0

WAITS_FOR_US = text(
    "SELECT count(*) FROM pg_locks WHERE NOT granted AND pg_backend_pid() = ANY (pg_blocking_pids(pid))"
)


class Fault(StrEnum):
    """What happens to a host."""

    KILLED = "killed"
    FROZEN = "frozen"
    FROZEN_IN_TRANSACTION = "frozen inside a transaction"
    CUT_OFF = "cut off from the database"


@dataclass
class Host:
    """The processes of a command of `mcc`, which reach the database by a link of their own."""

    name: str
    command: str
    environment: Mapping[str, str]
    log: Path
    proxy: Proxy
    process: "subprocess.Popen[bytes] | None" = None

    def start(self) -> None:
        """Start it, for the first time or after it was killed."""
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "service.cli", self.command],
                env=self.environment,
                stdout=log,
                stderr=log,
            )

    @property
    def process_ids(self) -> list[int]:
        """The host's own process, then those that it has started."""
        assert self.process is not None
        return [self.process.pid, *descendants(self.process.pid)]

    def strike(self, fault: Fault) -> None:
        """Let a fault begin."""
        match fault:
            case Fault.KILLED:
                self.kill()
            case Fault.FROZEN | Fault.FROZEN_IN_TRANSACTION:
                self.signal(signal.SIGSTOP)
            case Fault.CUT_OFF:
                self.proxy.freeze(self.name, on=True)

    def mend(self, fault: Fault) -> None:
        """Let a fault end. What a host has sent while it was cut off arrives now."""
        match fault:
            case Fault.KILLED:
                self.start()
            case Fault.FROZEN | Fault.FROZEN_IN_TRANSACTION:
                self.signal(signal.SIGCONT)
            case Fault.CUT_OFF:
                self.proxy.freeze(self.name, on=False)

    def signal(self, number: signal.Signals) -> None:
        """Send all its processes a signal."""
        for process_id in self.process_ids:
            with suppress(ProcessLookupError):  # processes end with those that have started them
                os.kill(process_id, number)

    def kill(self) -> None:
        """End all its processes at once, as a power cut does."""
        ending = self.process_ids
        self.signal(signal.SIGKILL)
        assert self.process is not None
        self.process.wait()
        wait_until(lambda: not any(is_alive(one) for one in ending), f"{self.name} to end", END_LIMIT_S)


def freeze_inside_a_transaction(engine: Engine, host: Host, row: Select[str]) -> None:
    """Freeze a host once it waits for a row that is locked here, and let it have the row's lock then."""
    with engine.connect() as ours:
        ours.execute(row.with_for_update()).one()
        host.signal(signal.SIGCONT)
        wait_until(lambda: ours.scalar(WAITS_FOR_US), f"{host.name} to want a row", RENEWAL_LIMIT_S)
        host.strike(Fault.FROZEN_IN_TRANSACTION)
        ours.rollback()


def require_once(what: str, expected: Iterable[Thing], found: Mapping[Thing, int]) -> None:
    """Raise AssertionError where something expected was found otherwise than once, so lost or doubled."""
    wrong = {one: found.get(one, 0) for one in expected if found.get(one, 0) != 1}
    assert not wrong, f"expected each {what} once, found {wrong}"


@dataclass(frozen=True, slots=True)
class Site:
    """What all hosts share: simulated relays, a service that uses them, its database and recordings."""

    plant: SimulatedPlant
    service: Service
    engine: Engine
    repository: Repository
    proxy: Proxy
    lease_s: float

    @property
    def recordings(self) -> Path:
        """The folder of the recordings."""
        return self.service.data / "recordings"

    @contextmanager
    def hosts(self, command: str) -> Iterator[Sequence[Host]]:
        """Two hosts of a command of `mcc`, which are killed in the end."""
        with ExitStack() as running:
            yield [running.enter_context(self._host(name, command)) for name in NAMES]

    @contextmanager
    def _host(self, name: str, command: str) -> Iterator[Host]:
        folder = Path(tempfile.mkdtemp(prefix=f"{command}-{name}-", dir=self.service.directory))
        seen = self.proxy.links[name].seen
        settings = {
            "MCC_SCD": str(self.plant.scd),
            "MCC_DATABASE_URL": f"postgresql+psycopg://{OWNER}@{seen.host}:{seen.port}/{DATABASE}",
            "MCC_RECORDINGS_DIRECTORY": str(self.recordings),
            "MCC_LEASE_S": f"{self.lease_s:g}",
            "MCC_WORKERS": "1",
        }
        if command == SERVE:
            settings["MCC_PORT"] = str(free_ports(1)[0])
        host = Host(name, command, service_environment(folder / "data", settings), folder / "log", self.proxy)
        host.start()
        try:
            yield host
        finally:
            self.proxy.freeze(name, on=False)
            host.kill()


@contextmanager
def serving_site(directory: Path, lease_s: float) -> Iterator[Site]:
    """A site, with its files in `directory`. Raises RuntimeError where no PostgreSQL server is installed."""
    programs = binaries()
    if programs is None:
        raise RuntimeError(f"no PostgreSQL server in {INSTALLED}: apt-get install postgresql")
    server_port, *ports = free_ports(1 + len(NAMES))
    own = Address(LOOPBACK, server_port)
    ways = {name: (own, Address(LOOPBACK, port)) for name, port in zip(NAMES, ports, strict=True)}
    options = OPTIONS | {"listen_addresses": own.host, "port": str(own.port), "synchronous_commit": "on"}
    with (
        serving_postgresql(programs, options) as server,
        Proxy(ways) as proxy,
        simulated_plant(directory) as plant,
    ):
        server.execute(f"CREATE DATABASE {DATABASE}")
        url = server.url(DATABASE)
        settings = {"MCC_DATABASE_URL": url, "MCC_LEASE_S": f"{lease_s:g}", "MCC_WORKERS": "1"}
        with running_service(directory, plant.scd, **settings) as service:
            engine = connect(url, limits=None)
            try:
                yield Site(plant, service, engine, Repository(engine), proxy, lease_s)
            finally:
                engine.dispose()
