"""Real processes: a simulated plant and a service beside it, on free ports, seen from outside."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import scl
from scl import Address
from service.client.rest_client import ServiceClient, ServiceError
from service.demo import MOTORS, SCENARIO
from service.demo.addresses import free_ports
from testing.service.accounts import log_in_before_start
from testing.waiting import eventually

RELAYS = ("A1_SEL710", "A2_SEL710", "A3_SEL710", "B1_SEL710", "B2_SEL710", "B3_SEL710")
MOTOR_NAMES = ("PUMP-A1", "FAN-A2", "MILL-A3", "CONVEYOR-B1", "COMPRESSOR-B2", "PUMP-B3")

START_LIMIT_S = 120.0
"""Far more than a start takes: others may keep every core busy."""
NOBODY = "127.66.0.1"
"""A loopback address at which nothing listens, also not the demo plant of another process."""


@dataclass(frozen=True)
class SimulatedPlant:
    """A running simulator; `files` holds each relay's EVENTS folder."""

    scd: Path
    files: Path
    process: "subprocess.Popen[str]"

    def address(self, relay: str) -> Address:
        return scl.read(self.scd).address(relay)

    def events(self, relay: str) -> Path:
        return self.files / relay / "EVENTS"

    def records(self) -> set[tuple[str, str]]:
        """(relay, record) of everything the relays recorded."""
        return {(path.parts[-3], path.stem) for path in self.files.glob("*/EVENTS/*.CFG")}


def switched_off_plant(directory: Path) -> Path:
    """Write the demo plant's SCD with relays that do not answer."""
    scd = directory / "plant.scd"
    addresses = {relay: Address(NOBODY, 10_211 + k) for k, relay in enumerate(RELAYS)}
    scl.with_addresses(scl.DEMO_PLANT_SCD, scd, addresses)
    return scd


@contextmanager
def simulated_plant(
    directory: Path, relays: Sequence[str] = RELAYS, scenario: Path = SCENARIO
) -> Iterator[SimulatedPlant]:
    """The demo plant on free ports; only the named relays are switched on."""
    scd = directory / "plant.scd"
    ports = free_ports(len(RELAYS))
    scl.with_addresses(
        scl.DEMO_PLANT_SCD,
        scd,
        {relay: Address("127.0.0.1", port) for relay, port in zip(RELAYS, ports, strict=True)},
    )
    files = directory / "relays"
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--scenario", str(scenario)]
    command += ["--files", str(files)]
    command += [word for relay in relays for word in ("--ied", relay)]
    with (
        (directory / "ied-sim.log").open("w") as log,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True) as process,
    ):
        try:
            assert process.stdout is not None
            for line in process.stdout:
                if line.strip() == "ready":
                    break
            else:
                raise AssertionError((directory / "ied-sim.log").read_text())
            yield SimulatedPlant(scd, files, process)
        finally:
            process.terminate()
            process.wait(20)


@dataclass
class Service:
    """`mcc serve` as a process. It can be killed and started again on the same data."""

    directory: Path
    scd: Path
    settings: Mapping[str, str]
    process: "subprocess.Popen[bytes] | None" = None
    url: str = ""

    def start(self) -> None:
        port = free_ports(1)[0]
        self.url = f"http://127.0.0.1:{port}"
        environment = service_environment(
            self.data, {"MCC_SCD": str(self.scd), "MCC_PORT": str(port), **self.settings}
        )
        log_in_before_start(environment, self.url)
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "service.cli", "serve"], env=environment, stdout=log, stderr=log
            )
        with ServiceClient(self.url) as client:
            ready = eventually(lambda: self.has_ended() or client.is_ready(), START_LIMIT_S)
            not_ready = None if ready else client.what_is_not_ready()
        assert ready, f"not ready: {not_ready or 'nothing answers'}\n{self.log.read_text()}"
        assert not self.has_ended(), self.log.read_text()

    @property
    def data(self) -> Path:
        return self.directory / "data"

    @property
    def log(self) -> Path:
        return self.directory / "service.log"

    @property
    def process_id(self) -> int:
        assert self.process is not None
        return self.process.pid

    def has_ended(self) -> bool:
        return self.process is not None and self.process.poll() is not None

    def kill(self, *, alone: bool) -> None:
        """SIGKILL the service and its processes; or the service alone, and see them go by themselves."""
        below = descendants(self.process_id)
        for process_id in [self.process_id, *([] if alone else below)]:
            os.kill(process_id, signal.SIGKILL)
        assert self.process is not None
        self.process.wait(10)
        assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 10)

    def stop(self) -> int:
        """SIGTERM; returns the exit code."""
        assert self.process is not None
        self.process.terminate()
        return self.process.wait(30)


@contextmanager
def running_service(directory: Path, scd: Path, **settings: str) -> Iterator[Service]:
    """A running service; the block's end is its end, with no process left over."""
    service = Service(directory, scd, settings)
    try:
        service.start()
        yield service
    finally:
        if not service.has_ended():
            below = descendants(service.process_id)
            service.stop()
            assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 10)


def service_environment(data: Path, settings: Mapping[str, str]) -> dict[str, str]:
    """The environment of a service of the demo plant's motors."""
    others = {name: value for name, value in os.environ.items() if not name.startswith("MCC_")}
    return others | {"MCC_DATA_DIRECTORY": str(data), "MCC_MOTORS": str(MOTORS), **settings}


def serve_in_vain(data: Path, **settings: str) -> str:
    """A service that cannot start: its one line on stderr."""
    ended = subprocess.run(
        [sys.executable, "-m", "service.cli", "serve"],
        env=service_environment(data, settings),
        capture_output=True,
        text=True,
        timeout=START_LIMIT_S,
        check=False,
    )
    assert ended.returncode == 1, ended.stderr
    assert ended.stdout == ""
    (line,) = [line for line in ended.stderr.splitlines() if line.startswith("mcc: ")]
    return line


def descendants(process_id: int) -> list[int]:
    """Children of a process, their children and so on."""
    parents: dict[int, int] = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        parents[int(status.parent.name)] = int(fields[1])
    found = [process_id]
    for ancestor in found:
        found.extend(child for child, parent in parents.items() if parent == ancestor)
    return found[1:]


FORKED = b"multiprocessing.forkserver"
"""In the command line of the workers' parent, and so of the workers."""


def workers_of(process_id: int) -> list[int]:
    """Workers of a service: forked from their parent, which is a child of the service."""
    forked = [one for one in descendants(process_id) if FORKED in _command_line(one)]
    return [worker for parent in forked for worker in descendants(parent)]


def _command_line(process_id: int) -> bytes:
    try:
        return Path(f"/proc/{process_id}/cmdline").read_bytes()
    except OSError:  # it ended meanwhile
        return b""


def is_alive(process_id: int) -> bool:
    """Whether a process runs; one that ended and was not waited for does not."""
    try:
        state = Path(f"/proc/{process_id}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state not in "ZX"


def link_states(client: ServiceClient) -> dict[str, str]:
    return {str(ied["name"]): str(ied["link_state"]) for ied in client.items("/ieds")}


def all_recordings(client: ServiceClient) -> list[Mapping[str, object]]:
    """Every recording the service has, or none while it does not answer."""
    try:
        return list(client.items("/recordings"))
    except ServiceError:
        return []
