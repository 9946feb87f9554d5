"""Ten years of a plant of 500 motors: how long answers take, the size on disk, and vacuum.

    python -m benchmarks.storage.ten_years --directory DIR [--database sqlite|postgresql] [--part 1.0]
                                           [--turns 100] [--pause 0.5] [--processes 1]

The whole are ten million diagnoses and a hundred million measured values; --part 0.1 is a tenth of both. It
fills a database in DIR and starts the service's site on it in a process of its own. Eight clients then ask at
once, each again and again after a pause that is drawn for it (half to one and a half times --pause), since
nobody waits for the others. The service answers with one process; --processes spreads the clients over more,
to see what a second one would give. The exit code is 1 where a goal is missed. The database stays in DIR, and
the next run takes it as it is.
"""

import argparse
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from random import Random

from sqlalchemy import Engine, text

from benchmarks.reporting import mark, table
from benchmarks.storage.bulk_filling import fill_ten_years
from benchmarks.storage.bulk_rows import BEGIN_NS, END_NS, MOTORS, YEARS_NS
from benchmarks.storage.plant import motor_name
from benchmarks.web.answers import Site, serving
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_SECOND
from service.storage import connect
from testing.service.postgresql import PostgresServer, binaries

DIAGNOSES = 10_000_000
MEASUREMENTS = 100_000_000
CLIENTS = 8
POSTGRESQL = {
    "listen_addresses": "",
    "max_connections": "100",
    "shared_buffers": "1GB",
    "max_wal_size": "8GB",
    # What fills a table that is new is not logged: ten years are filled in a day's time.
    "wal_level": "minimal",
    "max_wal_senders": "0",
}


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked of one motor, and how long 95 of 100 answers may take [s]; None without a goal."""

    label: str
    path: str
    goal_s: float | None

    def of(self, motor: int) -> str:
        begin_s, end_s = BEGIN_NS // NANOSECONDS_PER_SECOND, END_NS // NANOSECONDS_PER_SECOND
        year_ago = rfc3339(END_NS - YEARS_NS // 10)
        return self.path.format(motor=motor_name(motor), begin_s=begin_s, end_s=end_s, year_ago=year_ago)


QUESTIONS = (
    Question("trend, 100 points", "/api/v1/motors/{motor}/trend?limit=100", 0.020),
    Question("trend, 1000 points", "/api/v1/motors/{motor}/trend?limit=1000", 0.020),
    Question("trend of ten years, thinned", "/motors/{motor}/trend?from_s={begin_s}&to_s={end_s}", 0.020),
    Question("fleet, 100 motors with health", "/api/v1/motors?health=true", 0.100),
    Question("page of the fleet, 500 motors", "/", 0.100),
    Question("health of a motor", "/api/v1/motors/{motor}/health", None),
    Question(
        "1000 quarters of an hour from a year ago",
        "/api/v1/motors/{motor}/measurements?step=900&limit=1000&from={year_ago}",
        None,
    ),
    Question("the first 1000 of ten years", "/api/v1/motors/{motor}/measurements?step=900&limit=1000", None),
)


@dataclass(frozen=True, slots=True)
class Answered:
    """How long the answers to a question took, in ascending order, and the processor time of one [s]."""

    question: Question
    each_s: Sequence[float]
    processor_s: float

    def percentile_s(self, share: float) -> float:
        return self.each_s[max(ceil(share * len(self.each_s)) - 1, 0)]

    @property
    def is_within_goal(self) -> bool:
        return self.question.goal_s is None or self.percentile_s(0.95) <= self.question.goal_s


def ask(sites: Sequence[Site], question: Question, *, turns: int, pause_s: float) -> Answered:
    """Have CLIENTS clients ask at once, each `turns` times and each time of another motor.

    sites: processes on the same database, which the clients are spread over.

    With one pause for all they would come back in the order of their answers, each while the one before it
    is still answered.
    """

    def one(client: int) -> list[float]:
        pauses_s = Random(client)  # noqa: S311 - the same pauses in each run
        times = []
        with sites[client % len(sites)].client() as http:
            for turn in range(turns + 1):
                path = question.of((client + turn * CLIENTS) * 7 % MOTORS)
                begun_s = time.perf_counter()
                http.get(path).raise_for_status()
                times.append(time.perf_counter() - begun_s)
                time.sleep(pause_s * pauses_s.uniform(0.5, 1.5))
        return times[1:]  # the first one connects

    used_s = sum(site.processor_s() for site in sites)
    with ThreadPoolExecutor(CLIENTS) as pool:
        each = sorted(took for times in pool.map(one, range(CLIENTS)) for took in times)
    asked = CLIENTS * (turns + 1)
    return Answered(question, each, (sum(site.processor_s() for site in sites) - used_s) / asked)


@contextmanager
def database(kind: str, directory: Path) -> Iterator[str]:
    """Yield the URL of a database in a directory, new or as it is there."""
    directory.mkdir(parents=True, exist_ok=True)
    if kind == "sqlite":
        yield f"sqlite:///{(directory / 'statorwatch.sqlite').absolute()}"
        return
    programs = binaries()
    if programs is None:
        raise SystemExit("no PostgreSQL server is installed: apt-get install postgresql")
    server = PostgresServer(programs, directory, POSTGRESQL)
    is_new = not (directory / "data").exists()
    if is_new:
        server.make()
    server.start()
    try:
        if is_new:
            server.execute("CREATE DATABASE ten_years")
        yield server.url("ten_years")
    finally:
        server.close()


def sizes(engine: Engine) -> Iterator[tuple[str, float]]:
    """Yield the size of the tables that grow, with their indexes, and of the whole database [MB]."""
    with engine.connect() as connection:
        if engine.dialect.name == "sqlite":
            pages = "SELECT page_count * page_size FROM pragma_page_count, pragma_page_size"
            yield "all", (connection.scalar(text(pages)) or 0) / 1e6
            return
        size = text(
            "SELECT coalesce((SELECT sum(pg_total_relation_size(relid)) FROM pg_partition_tree(:name)),"
            " pg_total_relation_size(CAST(:name AS regclass)))"
        )
        for name in ("recordings", "jobs", "diagnoses", "observations", "condition_days", "measurements"):
            yield name, float(connection.scalar(size, {"name": name}) or 0) / 1e6
        yield "all", (connection.scalar(text("SELECT pg_database_size(current_database())")) or 0) / 1e6


def has_room_for_vacuum(engine: Engine, directory: Path) -> bool:
    """Tell whether the disk holds what vacuum writes: SQLite writes its file anew, beside the old one."""
    if engine.dialect.name != "sqlite":
        return True
    return shutil.disk_usage(directory).free > dict(sizes(engine))["all"] * 1e6


def vacuum(engine: Engine) -> None:
    """Give back the room of what was deleted."""
    if engine.dialect.name == "sqlite":  # ours begins a transaction in each connection
        with engine.connect() as connection:
            driver = connection.connection.driver_connection
            assert driver is not None
            connection.rollback()
            driver.execute("VACUUM")
        return
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        connection.execute(text("VACUUM ANALYZE"))


def run(url: str, arguments: argparse.Namespace, directory: Path) -> int:
    """Fill, ask and vacuum; print tables; return 1 where a goal is missed."""
    begun_s = time.perf_counter()

    def progress(line: str) -> None:
        print(f"{time.perf_counter() - begun_s:6.0f} s: {line}", file=sys.stderr, flush=True)

    diagnoses, measurements = (round(arguments.part * one) for one in (DIAGNOSES, MEASUREMENTS))
    noted = directory / "filled"
    if not noted.exists():
        fill_ten_years(url, diagnoses, measurements, progress)
        noted.touch()
    print(f"{diagnoses:,} diagnoses, {measurements:,} measured values, {MOTORS} motors")
    engine = connect(url)
    found = []
    with ExitStack() as running:
        sites = [running.enter_context(serving(directory, url)) for _ in range(arguments.processes)]
        for question in QUESTIONS:
            found.append(ask(sites, question, turns=arguments.turns, pause_s=arguments.pause))
            progress(question.label)
    _print(found)
    print("\n".join(table(("table", "MB"), [(name, f"{size:,.0f}") for name, size in sizes(engine)])))
    if has_room_for_vacuum(engine, directory):
        _timed("vacuum", lambda: vacuum(engine))
    else:
        print("vacuum: not run, since the disk does not hold the file twice")
    engine.dispose()
    return 0 if all(one.is_within_goal for one in found) else 1


def _timed(what: str, work: Callable[[], object]) -> None:
    begun_s = time.perf_counter()
    work()
    print(f"{what}: {time.perf_counter() - begun_s:.1f} s", flush=True)


def _print(found: Sequence[Answered]) -> None:
    rows = [
        (
            one.question.label,
            f"{one.percentile_s(0.5) * 1e3:.0f} ms",
            f"{one.percentile_s(0.95) * 1e3:.0f} ms",
            f"{one.each_s[-1] * 1e3:.0f} ms",
            f"{one.processor_s * 1e3:.1f} ms",
            "" if one.question.goal_s is None else f"{one.question.goal_s * 1e3:.0f} ms",
            "" if one.question.goal_s is None else mark(one.is_within_goal),
        )
        for one in found
    ]
    header = ("asked by eight clients", "median", "p95", "longest", "processor", "goal", "")
    print("\n".join(table(header, rows)), flush=True)


def main() -> int:
    """Measure; return 1 where a goal is missed."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.storage.ten_years",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--directory", type=Path, required=True)
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    parser.add_argument("--part", type=float, default=1.0, help="of ten million diagnoses")
    parser.add_argument("--turns", type=int, default=100, help="questions of each client")
    parser.add_argument("--pause", type=float, default=0.5, help="of a client, in the middle [s]")
    parser.add_argument("--processes", type=int, default=1, help="of the site")
    arguments = parser.parse_args()
    with database(arguments.database, arguments.directory) as url:
        return run(url, arguments, arguments.directory)


if __name__ == "__main__":
    sys.exit(main())
