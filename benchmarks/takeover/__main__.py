"""Take-over times between hosts: python -m benchmarks.takeover [--services] [--lease-seconds 30] [--write].

Two hosts of gateways, and then two of workers, beside a service on one PostgreSQL server; with --services two
more services in their place. Ends with 1 where a record is lost or comes twice.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from benchmarks.reporting import Section, table
from benchmarks.takeover import jobs, relays
from benchmarks.takeover.hosts import SERVE, Fault, serving_site
from benchmarks.takeover.page import PAGE, of_lease, of_services, write
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import read_plant

Times = dict[tuple[str, Fault], list[float]]


def main() -> None:
    """Measure, print the table, and write it into the page where that is asked for."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--repeats", type=int, default=3, help="of each fault")
    options.add_argument("--lease-seconds", type=float, default=30.0, help="setting lease_s of all hosts")
    options.add_argument("--services", action="store_true", help="the hosts are services")
    options.add_argument("--write", action="store_true", help=f"write the table into {PAGE.name}")
    asked = options.parse_args()
    times: Times = {}
    try:
        for work, fault, took_s in _measured(asked.repeats, asked.lease_seconds, services=asked.services):
            print(f"{work}, a host is {fault}: {took_s:.1f} s", file=sys.stderr, flush=True)
            times.setdefault((work, fault), []).append(took_s)
    except AssertionError as error:
        sys.exit(f"falls short: {error}")
    section = _section(times, asked.repeats, asked.lease_seconds, services=asked.services)
    print("\n".join(section.lines))
    if asked.write:
        write(section)


def _measured(repeats: int, lease_s: float, *, services: bool) -> Iterator[tuple[str, Fault, float]]:
    with (
        tempfile.TemporaryDirectory(prefix="takeover-") as directory,
        serving_site(Path(directory), lease_s) as site,
    ):
        plant = read_plant(Settings(scd=site.plant.scd, motors=MOTORS))
        for fault, took_s in relays.take_over_times(site, plant, repeats, SERVE if services else "collect"):
            yield "relays", fault, took_s
        for fault, took_s in jobs.take_over_times(site, repeats, SERVE if services else "work"):
            yield "jobs", fault, took_s


def _section(times: Times, repeats: int, lease_s: float, *, services: bool) -> Section:
    rows = [
        [work, str(fault), ", ".join(f"{one:.1f}" for one in sorted(took)), f"{median(took):.1f}"]
        for (work, fault), took in times.items()
    ]
    header = ["Of the host's", "It is", "Taken over after [s]", "Median [s]"]
    options = f"{'--services ' if services else ''}--repeats {repeats} --lease-seconds {lease_s:g} --write"
    subject, title = (
        (of_services(lease_s), f"Services, lease {lease_s:g} s")
        if services
        else (of_lease(lease_s), f"Lease {lease_s:g} s")
    )
    command = f"python -m benchmarks.takeover {options}"
    return Section(subject, title, command, ("", *table(header, rows), ""))


if __name__ == "__main__":
    main()
