"""How long the API's lists and figures take on a database as large as years make it.

    python -m benchmarks.storage [--rows 10000000] [--database sqlite|postgresql] [--keep FILE] [--turns 40]

It fills a database, starts the API on it in a process of its own, and times every route that reads, with all
of its filters and far down in its pages. The exit code is 1 where a goal is missed, and where a statement
reads or sorts as much as a growing table holds. --keep: leave the SQLite file there, and take it next time.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from statistics import median

from fastapi import FastAPI
from sqlalchemy import Engine

from benchmarks.reporting import mark, table
from benchmarks.storage.filling import fill
from benchmarks.storage.plans import statements_of, whole_scans
from benchmarks.storage.requests import Ask, asks
from benchmarks.storage.rows import Amounts
from benchmarks.storage.server import api_on
from benchmarks.storage.timing import Times, measure
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect, migrate
from testing.service.postgresql import binaries, serving_postgresql

ROWS = 10_000_000
TURNS = 40
FEWEST_TURNS = 30


def main() -> int:
    """Fill, time and print; return 1 where a goal is missed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.storage", description=__doc__)
    parser.add_argument("--rows", type=int, default=ROWS)
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    parser.add_argument("--keep", type=Path, help="the SQLite file, which is left there and filled once")
    parser.add_argument("--turns", type=int, default=TURNS, help="requests of each kind")
    options = parser.parse_args()
    if options.turns < FEWEST_TURNS:
        parser.error(f"--turns: at least {FEWEST_TURNS}")
    with _database(options.database, options.keep) as (url, file):
        return _measured(url, file, options.rows, options.turns)


@contextmanager
def _database(kind: str, keep: Path | None) -> Iterator[tuple[str, Path | None]]:
    """Yield the URL of a database, and its file where it is one."""
    if kind == "postgresql":
        folder = binaries()
        if folder is None:
            raise SystemExit("no PostgreSQL server is installed: apt-get install postgresql")
        with serving_postgresql(folder) as server, server.database(migrated=False) as url:
            yield url, None
        return
    with tempfile.TemporaryDirectory(prefix="statorwatch-bench-") as directory:
        file = keep or Path(sqlite_url(Path(directory)).removeprefix("sqlite:///"))
        yield f"sqlite:///{file.absolute()}", file


def _measured(url: str, file: Path | None, rows: int, turns: int) -> int:
    begun = time.perf_counter()

    def progress(line: str) -> None:
        print(f"{time.perf_counter() - begun:5.0f} s: {line}", file=sys.stderr, flush=True)

    amounts = Amounts.of(rows)
    if file is not None and file.exists():
        migrate(url)
        progress("migrated")
    else:
        fill(url, amounts, progress)
    with tempfile.TemporaryDirectory() as directory:
        engine = connect(url)
        app = api_on(Repository(engine), Path(directory))
        asked = tuple(asks(app))
        times = measure(url, asked, amounts, turns=turns, file=file, progress=progress)
        _print_times(times)
        scans = list(_scans(app, engine, asked, amounts))
        engine.dispose()
    print("\n".join(scans) or "No statement reads or sorts a whole growing table.")
    missed = [one.ask.label for one in times if not one.is_within_goal]
    print(f"{len(times) - len(missed)} of {len(times)} kinds of requests keep their goals.")
    return 1 if missed or scans else 0


def _scans(app: FastAPI, engine: Engine, asked: Sequence[Ask], amounts: Amounts) -> Iterator[str]:
    """Yield each request and statement that reads or sorts a whole growing table, and how."""
    with engine.connect() as connection:
        for ask in asked:
            for statement in statements_of(app, engine, ask.at(0.5, amounts)):
                for step in whole_scans(statement, statement.plan(connection)):
                    yield f"{ask.label}: {step}: {' '.join(statement.text.split())}"


def _print_times(times: Sequence[Times]) -> None:
    header = ("request", "kB", "first, cold", "processor", "median", "p95", "longest", "of", "goal", "")
    rows = [
        (
            f"`{one.ask.label}`",
            f"{one.bytes / 1000:.0f}",
            _ms(one.cold_s),
            _ms(median(one.processor_s)),
            _ms(one.percentile_s(0.5)),
            _ms(one.percentile_s(0.95)),
            _ms(max(one.warm_s)),
            str(len(one.warm_s)),
            _ms(one.ask.goal_s),
            mark(one.is_within_goal),
        )
        for one in times
    ]
    print("\n".join(table(header, rows)), flush=True)


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.0f} ms" if seconds < 10.0 else f"{seconds:.1f} s"


if __name__ == "__main__":
    sys.exit(main())
