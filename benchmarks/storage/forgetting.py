"""Forgetting old measurements beside processes that renew their leases: waits, write-ahead log, time.

    python -m benchmarks.storage.forgetting [--rows 10000000] [--postgresql] [--whole]

It fills a new database with measurements, then forgets them all. Meanwhile another process renews the lease
of a gateway every 100 ms, a thread of this process renews that of a job runner, and a third reads lists.
--whole: forget in one transaction, as the service did until batches were made, for comparison.
"""

import argparse
import multiprocessing
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Event, Thread

from sqlalchemy import Engine, delete, func, select, text
from sqlalchemy.exc import OperationalError, TimeoutError  # noqa: A004 - that of the database
from sqlalchemy.orm import Session

from service.configuration.settings import sqlite_url
from service.plant import Plant, PlantMotor, Site
from service.retention.batches import Batches, Pace
from service.storage import Repository, connect, migrate
from service.storage.engine import WRITES
from service.storage.models import MeasurementRow
from testing.service.job_runner import RUNNER, register_runner
from testing.service.plants import NOW_NS, SECOND_NS, motor, relay
from testing.service.postgresql import binaries, serving_postgresql

MOTORS = 100
SAMPLE_PERIOD_S = 10
RENEWAL_PERIOD_S = 0.1
ROWS_A_FILLING = 200_000
VALUES = {
    "ia_A": "10.1 + n % 97 * 0.01",
    "ib_A": "10.2 + n % 89 * 0.01",
    "ic_A": "10.0 + n % 83 * 0.01",
    "vab_V": "398.0 + n % 71 * 0.1",
    "vbc_V": "399.0 + n % 67 * 0.1",
    "vca_V": "397.5 + n % 61 * 0.1",
    "power_W": "5500.0 + n % 59",
    "reactive_power_var": "3100.0 + n % 53",
    "power_factor": "0.86 + n % 47 * 0.0001",
    "frequency_Hz": "50.0 + n % 43 * 0.001",
}
GATEWAY = "measured"


@dataclass(slots=True)
class Waits:
    """How long each of many calls took [s], and how many the database refused as it was locked."""

    each_s: list[float] = field(default_factory=list)
    refused: int = 0

    def repeat(
        self,
        call: Callable[[], object],
        stopping: Callable[[float], bool],
        period_s: float = RENEWAL_PERIOD_S,
    ) -> None:
        """Call again and again, one call each `period_s`, until `stopping`, which waits, says so."""
        while True:
            began_s = time.monotonic()
            try:
                call()
            except (OperationalError, TimeoutError):
                self.refused += 1
            took_s = time.monotonic() - began_s
            self.each_s.append(took_s)
            if stopping(max(0.0, period_s - took_s)):
                return

    def text(self) -> str:
        ordered = sorted(self.each_s)
        p99_s = ordered[int(0.99 * (len(ordered) - 1))]
        return (
            f"{len(ordered)} calls, median {1e3 * statistics.median(ordered):.1f} ms, "
            f"99 % {1e3 * p99_s:.0f} ms, longest {1e3 * ordered[-1]:.0f} ms, {self.refused} refused"
        )


def plant() -> Plant:
    names = [f"MOTOR-{number:03}" for number in range(MOTORS)]
    return Plant(
        sites=(Site("FACTORY_A", "Factory A"),),
        relays=tuple(relay(f"R_{name}", "FACTORY_A") for name in names),
        motors=tuple(PlantMotor(motor(name), "", "FACTORY_A", f"R_{name}") for name in names),
    )


def fill(engine: Engine, rows: int) -> None:
    """Measurements of MOTORS motors, all ten seconds, in the order of time."""
    columns = ", ".join(f'"{name}"' for name in VALUES)
    values = ", ".join(VALUES.values())
    statement = text(
        f"INSERT INTO measurements (motor, step_s, time_ns, samples, {columns}) "  # noqa: S608 - own words
        "WITH RECURSIVE steps(n) AS (SELECT CAST(:first AS BIGINT) UNION ALL "
        "SELECT n + 1 FROM steps WHERE n < :last) "
        f"SELECT motors.name, 0, :begin_ns + n * :period_ns, 1, {values} FROM steps CROSS JOIN motors"
    )
    times = -(-rows // MOTORS)
    a_filling = ROWS_A_FILLING // MOTORS
    period_ns = SAMPLE_PERIOD_S * SECOND_NS
    for first in range(0, times, a_filling):
        last = min(times, first + a_filling) - 1
        with engine.execution_options(**{WRITES: True}).begin() as connection:
            connection.execute(
                statement,
                {
                    "first": first,
                    "last": last,
                    "begin_ns": NOW_NS - times * period_ns,
                    "period_ns": period_ns,
                },
            )


def renew_gateway(url: str, pipe: Connection) -> None:
    """Renew a gateway's lease until the other end says stop; send the waits."""
    repository = Repository(connect(url))
    repository.register_gateway(GATEWAY, host="here", process_id=1, now_ns=NOW_NS)
    waits = Waits()
    names = [one.name for one in plant().relays]
    pipe.send("ready")
    waits.repeat(lambda: repository.share_relays(GATEWAY, names, most=MOTORS, problem=None), pipe.poll)
    pipe.send(waits)


@contextmanager
def renewing(url: str, repository: Repository, waits: dict[str, Waits]) -> Iterator[None]:
    """Renew leases and read lists as a service does, from another process and from threads of this one."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    gateway = context.Process(target=renew_gateway, args=(url, theirs))
    gateway.start()
    ours.recv()
    end = Event()
    register_runner(repository)
    runner, reader = Waits(), Waits()
    threads = [
        Thread(target=runner.repeat, args=(lambda: repository.renew_runner(RUNNER), end.wait)),
        Thread(
            target=reader.repeat,
            args=(lambda: repository.measurements("MOTOR-000", 0, limit=1000), end.wait),
        ),
    ]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        end.set()
        for thread in threads:
            thread.join()
        ours.send("stop")
        received = ours.recv()
        assert isinstance(received, Waits)
        gateway.join()
    waits["renewals of a gateway (another process)"] = received
    waits["renewals of a job runner (a thread of the same process)"] = runner
    waits["reading 1000 measurements"] = reader


def forget_whole(engine: Engine) -> None:
    with Session(engine.execution_options(**{WRITES: True})) as session, session.begin():
        session.execute(
            delete(MeasurementRow).where(MeasurementRow.step_s == 0, MeasurementRow.time_ns < NOW_NS)
        )


class LogSize:
    """The largest size of SQLite's write-ahead log, looked at ten times a second [bytes]."""

    def __init__(self, log: Path) -> None:
        self._log = log
        self._end = Event()
        self._thread = Thread(target=self._look)
        self.largest_bytes = 0

    def __enter__(self) -> "LogSize":
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._end.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._end.wait(0.1):
            if self._log.exists():
                self.largest_bytes = max(self.largest_bytes, self._log.stat().st_size)


def measure(url: str, rows: int, *, whole: bool) -> None:
    migrate(url)
    engine = connect(url)
    repository = Repository(engine)
    repository.sync_plant(plant())
    began_s = time.monotonic()
    fill(engine, rows)
    print(f"filled with {rows} measurements in {time.monotonic() - began_s:.0f} s")
    log = Path(f"{engine.url.database}-wal")
    if engine.dialect.name == "sqlite":
        print(f"file {Path(str(engine.url.database)).stat().st_size / 1e6:.0f} MB")
        with engine.connect() as connection:
            connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)")
    waits: dict[str, Waits] = {}
    batches = Batches(Pace(round_s=float("inf")))
    with LogSize(log) as size, renewing(url, repository, waits):
        began_s = time.monotonic()
        if whole:
            forget_whole(engine)
        else:
            batches.run(lambda most: repository.forget_measurements(0, most, before_ns=NOW_NS))
        took_s = time.monotonic() - began_s
    with Session(engine) as session:
        assert session.scalar(select(func.count()).select_from(MeasurementRow)) == 0
    engine.dispose()
    print(f"forgotten {'in one transaction' if whole else 'in batches'} in {took_s:.0f} s")
    if not whole:
        print(f"longest batch {1e3 * batches.largest_s:.0f} ms")
    if size.largest_bytes:
        print(f"largest write-ahead log {size.largest_bytes / 1e6:.1f} MB")
    for what, each in waits.items():
        print(f"{what}: {each.text()}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rows", type=int, default=10_000_000)
    parser.add_argument("--postgresql", action="store_true")
    parser.add_argument("--whole", action="store_true")
    options = parser.parse_args()
    with ExitStack() as stack:
        if options.postgresql:
            folder = binaries()
            if folder is None:
                parser.error("no PostgreSQL server is installed: apt-get install postgresql")
            server = stack.enter_context(serving_postgresql(folder))
            url = stack.enter_context(server.database(migrated=False))
        else:
            url = sqlite_url(Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="forgetting-"))))
        measure(url, options.rows, whole=options.whole)


if __name__ == "__main__":
    main()
