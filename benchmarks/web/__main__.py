"""What the pages cost at 500 motors: python -m benchmarks.web [--records N] [--keep DIR] [--quick].

It fills a database once and keeps it in DIR, runs the site in a process of its own, asks for each page, has a
browser paint it, looks at every page for errors, and lets 50 viewers follow the fleet. It ends with 1 where a
page misses its goal or has an error. With --home-assistant the pages of that program are measured, too
(benchmarks/web/home_assistant.py says how to get it).
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.reporting import table
from benchmarks.storage.plant import motor_name
from benchmarks.web.answers import Answers, Site, answers, serving
from benchmarks.web.beside import beside_home_assistant
from benchmarks.web.every_page import faults_of_pages
from benchmarks.web.filling import LONG, Plan, fill
from benchmarks.web.painting import Painting, painting
from benchmarks.web.recordings import store_long_recording
from benchmarks.web.viewers import load, raise_one_more
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect, migrate
from testing.web.chromium import INSTALL, chromium_path, running_browser

VIEWERS, VIEWERS_SHARE = 50, 0.20
TURNS, QUICK_TURNS = 40, 10
MEASURED_S, QUICK_MEASURED_S = 60.0, 15.0


@dataclass(frozen=True, slots=True)
class Goal:
    """A page and what it may cost, where there is a goal.

    answer_s: 95 % of its answers.  paint_s: its first contentful paint.  bytes: with all that it fetches.
    charts_s: from the data of its charts to their lines on the screen.  changes: before each answer.
    """

    name: str
    path: str
    answer_s: float | None = None
    paint_s: float | None = None
    bytes: int | None = None
    charts_s: float | None = None
    changes: bool = False


def main() -> None:
    arguments = _arguments()
    path = chromium_path()
    if path is None:
        sys.exit(f"no chromium: {INSTALL}")
    turns = QUICK_TURNS if arguments.quick else TURNS
    with _data(arguments) as data, serving(data) as site:
        goals = _goals(data)
        missed = _pages(site, path, goals, turns, data)
        missed += _looked_at(site, path, data)
        if arguments.home_assistant is not None:
            with running_browser(path) as browser:
                paths = {goal.name: goal.path for goal in goals}
                motor = motor_name(LONG), paths["motor, usual span"]
                lines = beside_home_assistant(browser, site, paths["fleet"], motor, arguments.home_assistant)
            print("\n".join(lines), flush=True)
        missed += _viewers(site, data, QUICK_MEASURED_S if arguments.quick else MEASURED_S)
    for words in missed:
        print(f"missed: {words}")
    sys.exit(1 if missed else 0)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=10_000, help="of each motor")
    parser.add_argument("--motors", type=int, default=500)
    parser.add_argument("--keep", type=Path, help="fill the database here, or use the one that is here")
    parser.add_argument(
        "--home-assistant", type=Path, metavar="HASS", help="measure this program's pages, too"
    )
    parser.add_argument("--quick", action="store_true", help="fewer turns")
    return parser.parse_args()


@contextmanager
def _data(arguments: argparse.Namespace) -> Iterator[Path]:
    if arguments.keep is not None:
        arguments.keep.mkdir(parents=True, exist_ok=True)
        if not any(arguments.keep.glob("*.sqlite")):
            _fill(arguments.keep, arguments)
        migrate(sqlite_url(arguments.keep))
        yield arguments.keep
        return
    with TemporaryDirectory(prefix="statorwatch-web-") as name:
        _fill(Path(name), arguments)
        yield Path(name)


def _fill(data: Path, arguments: argparse.Namespace) -> None:
    plan = Plan(arguments.motors, arguments.records, time.time_ns())
    begun_s = time.monotonic()
    fill(sqlite_url(data), plan, lambda line: print(f"  {line}", flush=True))
    store_long_recording(data)
    print(f"  filled in {time.monotonic() - begun_s:.0f} s", flush=True)


def _goals(data: Path) -> Sequence[Goal]:
    """Return the pages that are measured."""
    engine = connect(sqlite_url(data))
    try:
        recording = next(
            one.id
            for one in Repository(engine).recordings(limit=10, motor=motor_name(3)).items
            if one.name == "LONG"
        )
    finally:
        engine.dispose()
    motor = motor_name(LONG)
    return (
        Goal("fleet", "/", answer_s=0.150, paint_s=0.8, bytes=250_000),
        Goal("fleet, after a change each", "/", answer_s=0.150, changes=True),
        Goal("motor, 100,000 points", f"/motors/{motor}?days=all", answer_s=0.200),
        Goal("motor, usual span", f"/motors/{motor}", answer_s=0.200, paint_s=0.8),
        Goal("starts", f"/motors/{motor}/starts"),
        Goal("alarms", "/alarms"),
        Goal("relays", "/relays"),
        Goal("recording, 60,000 samples", f"/recordings/{recording}", charts_s=0.150),
        Goal("recordings", "/recordings"),
        Goal("plant", "/plant"),
        Goal("reports", "/reports"),
    )


def _pages(site: Site, chromium: str, goals: Sequence[Goal], turns: int, data: Path) -> list[str]:
    rows: list[Sequence[str]] = []
    missed: list[str] = []
    engine = connect(sqlite_url(data))
    change = partial(raise_one_more, Repository(engine))
    with running_browser(chromium) as browser:
        for goal in goals:
            found = answers(site, goal.path, turns=turns, change=change if goal.changes else None)
            painted = painting(browser, site, goal.path)
            rows.append(
                (
                    goal.name,
                    f"{1000 * found.percentile_s(0.5):.0f} ms",
                    f"{1000 * found.percentile_s(0.95):.0f} ms",
                    f"{1000 * found.processor_s:.0f} ms",
                    f"{found.bytes / 1000:.0f} kB",
                    f"{1000 * painted.median_s:.0f} ms",
                    f"{1000 * painted.slowest_s:.0f} ms",
                    "" if painted.charts_median_s is None else f"{1000 * painted.charts_median_s:.0f} ms",
                    f"{painted.bytes / 1000:.0f} kB",
                    str(painted.files),
                )
            )
            missed += _missed(goal, found, painted)
    engine.dispose()
    times = ("Answer", "95 %", "Of a core", "Size", "First paint", "Slowest", "Charts")
    header = ("Page", *times, "With all files", "Files")
    print("\n".join(table(header, rows)), flush=True)
    return missed


def _missed(goal: Goal, found: Answers, painted: Painting) -> Iterator[str]:
    """Yield the goals that a page misses, in words."""
    paint_s, size, charts_s = painted.slowest_s, painted.bytes, painted.charts_median_s
    p95_s = found.percentile_s(0.95)
    if goal.answer_s is not None and p95_s > goal.answer_s:
        yield f"{goal.name}: 95 % of the answers within {1000 * p95_s:.0f} ms, not {1000 * goal.answer_s:.0f}"
    if goal.paint_s is not None and paint_s > goal.paint_s:
        yield f"{goal.name}: first paint after {1000 * paint_s:.0f} ms, not {1000 * goal.paint_s:.0f}"
    if goal.charts_s is not None and (charts_s is None or charts_s > goal.charts_s):
        seen = "never" if charts_s is None else f"{1000 * charts_s:.0f} ms after their data"
        yield f"{goal.name}: charts are drawn {seen}, not {1000 * goal.charts_s:.0f}"
    if goal.bytes is not None and size > goal.bytes:
        yield f"{goal.name}: {size / 1000:.0f} kB, not {goal.bytes / 1000:.0f}"


def _looked_at(site: Site, chromium: str, data: Path) -> list[str]:
    engine = connect(sqlite_url(data))
    try:
        with running_browser(chromium) as browser:
            found = dict(faults_of_pages(browser, site, Repository(engine)))
    finally:
        engine.dispose()
    wrong = [f"{path}: {fault}" for path, faults in found.items() for fault in faults]
    print(f"{len(found)} pages looked at on a desktop and a phone: {len(wrong)} errors", flush=True)
    return wrong


def _viewers(site: Site, data: Path, seconds: float) -> list[str]:
    engine = connect(sqlite_url(data))
    repository = Repository(engine)
    alone = load(site, repository, 0, seconds=seconds)
    watched = load(site, repository, VIEWERS, seconds=seconds)
    engine.dispose()
    added = watched.cores - alone.cores
    print(
        f"{VIEWERS} viewers of the fleet add {100 * added:.1f} % of a core, with a change every 5 s; "
        f"the last of them is told after {watched.longest_told_s:.2f} s"
    )
    return [] if added < VIEWERS_SHARE else [f"{VIEWERS} viewers add {100 * added:.0f} % of a core"]


if __name__ == "__main__":
    main()
