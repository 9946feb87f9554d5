"""Threads, descriptors, memory over connect-disconnect cycles.

    python -m benchmarks.collector.connection_cycles [1000]

Cycles of `mms.Client`: closed by the client; cut by the network; answered by nobody. Then cycles of the
collector's relay session: from the start of its thread to its end, with a visit between.
"""

import logging
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Thread

import structlog

from mms import Client, MmsError
from service.collector.session.relay_session import RelaySession
from service.configuration.settings import Settings
from service.plant import Relay
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
from service.storage.states import LinkState
from testing.ports import LOOPBACK
from testing.relays.serving import Relaying, RelayProcess, mute_server
from testing.service.plants import relay, two_motor_plant
from testing.waiting import eventually

CYCLES = 1000
WARM_UP = 10
FAILING_SHARE = 0.1
"""Of the cycles, these fail: they take their time."""

CUT_AFTER_MESSAGES = 6
SHORT_S = 0.05


@dataclass(frozen=True, slots=True)
class Held:
    """What this process holds."""

    threads: int
    descriptors: int
    memory_MB: float

    @classmethod
    def now(cls) -> "Held":
        (resident,) = [
            line.split()[1]
            for line in Path("/proc/self/status").read_text().splitlines()
            if line.startswith("VmRSS")
        ]
        return cls(_entries("/proc/self/task"), _entries("/proc/self/fd"), int(resident) / 1024)


def _entries(directory: str) -> int:
    return sum(1 for _ in Path(directory).iterdir())


@dataclass(frozen=True, slots=True)
class Growth:
    """Held after the warm-up and at the end."""

    cycles: int
    before: Held
    after: Held

    @property
    def is_none(self) -> bool:
        """Memory aside, which an allocator may keep."""
        return self.after.threads <= self.before.threads and self.after.descriptors <= self.before.descriptors

    def __str__(self) -> str:
        grown_kB = (self.after.memory_MB - self.before.memory_MB) * 1024
        return (
            f"{self.cycles} cycles: threads {self.before.threads} to {self.after.threads}, descriptors "
            f"{self.before.descriptors} to {self.after.descriptors}, memory {self.before.memory_MB:.1f} to "
            f"{self.after.memory_MB:.1f} MB ({grown_kB / self.cycles:.2f} kB a cycle)"
        )


def grown(cycle: Callable[[], object], cycles: int) -> Growth:
    """What so many cycles leave behind, those of the warm-up not counted."""
    for _ in range(WARM_UP):
        cycle()
    before = Held.now()
    for _ in range(cycles):
        cycle()
    # The library's threads end a moment after their connection.
    eventually(lambda: Held.now().threads <= before.threads, 5.0)
    return Growth(cycles, before, Held.now())


def closed_by_the_client(port: int) -> None:
    with Client.connect(LOOPBACK, port) as client:
        client.files("EVENTS")


def cut(port: int) -> None:
    """Through a TCP relay that ends every connection."""
    with suppress(MmsError), Client.connect(LOOPBACK, port, connect_timeout_s=2.0) as client:
        while True:
            client.files("EVENTS")


def unanswered(port: int) -> None:
    with suppress(MmsError):
        Client.connect(LOOPBACK, port, connect_timeout_s=SHORT_S)


@dataclass(frozen=True, slots=True)
class Visits:
    """Sessions of one relay, one after the other."""

    relay: Relay
    repository: Repository
    store: RecordingStore
    settings: Settings

    @classmethod
    def of(cls, directory: Path, port: int) -> "Visits":
        settings = Settings(data_directory=directory, poll_period_s=0.1)
        migrate(settings.database_url)
        repository = Repository(connect(settings.database_url))
        repository.sync_plant(two_motor_plant())
        store = FolderStore(settings.recordings_directory)
        return cls(relay("A1_SEL710", "FACTORY_A", port), repository, store, settings)

    def visit(self) -> None:
        """From start to stop, until the relay has answered."""
        self.repository.reset_links(now_ns=1)
        session = RelaySession(self.relay, "PUMP-A1", self.repository, self.store, self.settings)
        thread = Thread(target=session.run)
        thread.start()
        answered = eventually(lambda: self.repository.relay(self.relay.name).link_state is LinkState.UP, 30.0)
        session.stop()
        thread.join()
        if not answered:
            raise RuntimeError(f"{self.relay.name}: expected an answer within 30 s, found none")


def measure(cycles: int) -> Iterator[tuple[str, Growth]]:
    """Every kind of cycle; those that fail fewer times."""
    failing = max(1, round(cycles * FAILING_SHARE))
    with tempfile.TemporaryDirectory(prefix="statorwatch-cycles-") as name:
        directory = Path(name)
        (directory / "relay" / "EVENTS").mkdir(parents=True)
        process = RelayProcess(directory / "relay")
        try:
            yield "mms.Client, closed", grown(lambda: closed_by_the_client(process.port), cycles)
            cutting = Relaying(process.port, cuts=sys.maxsize, after_messages=CUT_AFTER_MESSAGES)
            yield "mms.Client, cut", grown(lambda: cut(cutting.port), failing)
            cutting.close()
            with mute_server() as port:
                yield "mms.Client, unanswered", grown(lambda: unanswered(port), failing)
            (directory / "data").mkdir()
            visits = Visits.of(directory / "data", process.port)
            yield "relay session", grown(visits.visit, cycles)
        finally:
            process.end()


def main(cycles: int) -> int:
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.ERROR))
    grew = 0
    for kind, growth in measure(cycles):
        print(f"{kind}: {growth}", flush=True)
        grew += not growth.is_none
    return 1 if grew else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else CYCLES))
