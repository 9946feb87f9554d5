"""CPU time of one small record on its way: python -m benchmarks.collector.record_cost [--records 60]

A relay of the demo plant gets one record after the other, each a copy of one that it made itself, with a time
of its own. Told for each kind of process of the service: CPU time a record, and what the same time costs
without records, which is taken away. --backlog puts all of them there at once.
"""

import argparse
import re
import sqlite3
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import closing
from datetime import datetime, timedelta
from pathlib import Path

from benchmarks.simulator.plant import cpu_s
from service.client.rest_client import ServiceClient
from testing.service.processes import FORKED, Service, descendants, running_service, simulated_plant
from testing.waiting import eventually

RELAY, MOTOR = "A1_SEL710", "PUMP-A1"
DATE = re.compile(r"\d\d/\d\d/\d{4},\d\d:\d\d:\d\d\.\d+")
DATE_FORMAT = "%d/%m/%Y,%H:%M:%S.%f"
DATABASE = "statorwatch.sqlite"
WARM_UP = 8
"""Records before the first that counts: compilers, connections and caches are ready then."""

LONGEST_S = 300.0
KINDS = {"service.collector": "collector", FORKED.decode(): "workers", "service.cli": "service"}


def measure(records: int, period_s: float) -> Iterator[str]:
    """One line for each kind of process, and one for all of them."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-record-") as name:
        directory = Path(name)
        with (
            simulated_plant(directory, [RELAY]) as plant,
            running_service(directory, plant.scd, MCC_POLL_PERIOD_S="1") as service,
            ServiceClient(service.url) as client,
        ):
            client.request_recording(MOTOR)
            database = service.data / DATABASE
            _await_diagnosed(database, 1)
            events = plant.events(RELAY)
            made = _Copies(events)
            for _ in range(WARM_UP):
                made.add()
                time.sleep(0.2)
            _await_diagnosed(database, 1 + WARM_UP)
            yield f"{made.size_bytes} bytes a record"
            begun_s, before = time.monotonic(), _cpu_s(service)
            for _ in range(records):
                made.add()
                time.sleep(period_s)
            _await_diagnosed(database, 1 + WARM_UP + records)
            time.sleep(2.0)  # what follows a diagnosis: the motor's condition
            busy_s = time.monotonic() - begun_s
            after = _cpu_s(service)
            time.sleep(busy_s)
            idle = _cpu_s(service)
            yield from _told(before, after, idle, records, busy_s)


class _Copies:
    """Copies of the relay's first record, each a minute later than the one before."""

    def __init__(self, events: Path) -> None:
        self._events = events
        configuration = min(events.glob("*.CFG"))
        self._files = {path.suffix: path.read_bytes() for path in events.glob(f"{configuration.stem}.*")}
        self._number = 0
        self.size_bytes = sum(map(len, self._files.values()))

    def add(self) -> None:
        self._number += 1
        later = timedelta(minutes=self._number)

        def moved(match: re.Match[str]) -> str:
            return (datetime.strptime(match[0], DATE_FORMAT) + later).strftime(DATE_FORMAT)

        stem = f"HR_{20_000 + self._number}"
        for suffix, content in sorted(self._files.items(), reverse=True):
            text = DATE.sub(moved, content.decode("ascii")).encode("ascii") if suffix == ".CFG" else content
            (self._events / f"{stem}{suffix}").write_bytes(text)


def _await_diagnosed(database: Path, number: int) -> None:
    """Look into the database, so that the service is not asked."""

    def diagnosed() -> int:
        with closing(sqlite3.connect(f"file:{database}?mode=ro", uri=True)) as connection:
            (found,) = connection.execute(
                "SELECT count(*) FROM recordings WHERE state = 'diagnosed'"
            ).fetchone()
        return int(found)

    if not eventually(lambda: diagnosed() >= number, LONGEST_S):
        raise RuntimeError(f"expected {number} recordings diagnosed, found {diagnosed()}")


def _cpu_s(service: Service) -> Mapping[str, float]:
    spent: dict[str, float] = defaultdict(float)
    for process_id in (service.process_id, *descendants(service.process_id)):
        command = Path(f"/proc/{process_id}/cmdline").read_text().replace("\0", " ")
        kind = next((name for word, name in KINDS.items() if word in command), "others")
        spent[kind] += cpu_s(process_id)
    return spent


def _told(
    before: Mapping[str, float],
    after: Mapping[str, float],
    idle: Mapping[str, float],
    records: int,
    busy_s: float,
) -> Iterator[str]:
    all_ms = 0.0
    for kind, end_s in after.items():
        spent_s, rest_s = end_s - before[kind], idle[kind] - end_s
        each_ms = 1000 * (spent_s - rest_s) / records
        all_ms += each_ms
        yield f"{kind}: {each_ms:.1f} ms a record, {100 * rest_s / busy_s:.1f} % of a core without records"
    yield f"together: {all_ms:.1f} ms a record ({records} records in {busy_s:.0f} s)"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.collector.record_cost", description=__doc__)
    parser.add_argument("--records", type=int, default=60)
    parser.add_argument("--backlog", action="store_true")
    arguments = parser.parse_args()
    for line in measure(arguments.records, 0.0 if arguments.backlog else 0.5):
        print(line, flush=True)


if __name__ == "__main__":
    main()
