"""How long a queued job waits for a host: python -m benchmarks.takeover.wake_up [--jobs 100] [--write].

A service and two hosts of workers on one PostgreSQL server, all idle, are given one job after the other.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from benchmarks.reporting import Section, table
from benchmarks.takeover.hosts import Site, serving_site
from benchmarks.takeover.jobs import START_LIMIT_S, WORK_LIMIT_S, Records, runner_of
from benchmarks.takeover.page import PAGE, WAKE_UP, write
from core.units import NANOSECONDS_PER_SECOND
from service.jobs.listening import TOLD_POLL_PERIOD_S
from service.storage.models import JobRow
from testing.waiting import wait_until

LEASE_S = 30.0


def main() -> None:
    """Measure, print the table, and write it into the page where that is asked for."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--jobs", type=int, default=100, help="one after the other")
    options.add_argument("--write", action="store_true", help=f"write the table into {PAGE.name}")
    asked = options.parse_args()
    section = _section(_waits_s(asked.jobs), asked.jobs)
    print("\n".join(section.lines))
    if asked.write:
        write(section)


def _waits_s(jobs: int) -> np.ndarray:
    """Return from when each record was added until a host had its job [s]."""
    with (
        tempfile.TemporaryDirectory(prefix="wake-up-") as directory,
        serving_site(Path(directory), LEASE_S) as site,
        site.hosts("work") as hosts,
    ):
        wait_until(lambda: all(runner_of(site, host) for host in hosts), "hosts with runners", START_LIMIT_S)
        records = Records(site)
        for _ in range(jobs):
            records.add(1)
            wait_until(records.are_diagnosed, "the diagnosis of a record", WORK_LIMIT_S)
        return _waited_s(site)


def _waited_s(site: Site) -> np.ndarray:
    with Session(site.engine) as session:
        rows = session.scalars(select(JobRow)).all()
        waited_ns = [row.started_ns - row.created_ns for row in rows if row.started_ns is not None]
    return np.array(waited_ns) / NANOSECONDS_PER_SECOND


def _section(waits_s: np.ndarray, jobs: int) -> Section:
    half_s, most_s, longest_s = np.quantile(waits_s, [0.5, 0.95, 1.0])
    rows = [[str(len(waits_s)), *(f"{1000 * one:.0f}" for one in (half_s, most_s, longest_s))]]
    header = ["Jobs", "Half within [ms]", "95 % within [ms]", "Longest [ms]"]
    told = (
        "One job after the other is queued, in a process of its own. What is counted begins as its record is",
        "added, and ends as an idle host takes it: the commit, the notice (`NOTIFY`), a look into the queue.",
        f"Without notices each host looks every {TOLD_POLL_PERIOD_S:g} s.",
        "",
    )
    command = f"python -m benchmarks.takeover.wake_up --jobs {jobs} --write"
    return Section(WAKE_UP, "How long a job waits for a host", command, (*told, *table(header, rows), ""))


if __name__ == "__main__":
    main()
