"""What a record costs in a folder and in a bucket: python -m benchmarks.storage.recording_stores.

The server of the bucket is moto's, a process of its own on this machine: its time is part of the waiting and
not of the processor time. A real store has a network before it and disks behind it.
"""

import argparse
import os
import platform
import statistics
import textwrap
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.reporting import Section, table, write_sections
from service.configuration.recordings_url import BucketPlace
from service.recording_store.bucket import BucketStore
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from testing.service.s3_server import BUCKET, serving_s3

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "recording-stores.md"
PREAMBLE = """\
# What a record costs in a folder and in a bucket

Recordings are kept in a folder, or
[in a bucket of an S3-compatible store](../how-to/several-hosts.md#recordings-in-an-s3-compatible-store).
Asked:
what does each cost? A record of 200 kB is stored in 1.8 ms in a folder and 8.2 ms in a bucket, and read in
0.08 and 9.8 ms; one of 20 MB is stored in 23 and 89 ms, and read in 1.8 and 42 ms. **Falls short**: the
bucket is moto's on the same machine, so that neither a network nor a store's disks are in the figures.
"""
COMMAND = "python -m benchmarks.storage.recording_stores [--write]"
SIZES = {"200 kB": (200_000, 40), "20 MB": (20_000_000, 12)}
"""Of a record's samples [bytes], and how many records are measured."""
WARM_UP = 2
"""So many records are not counted."""
KINDS = ("folder", "bucket")
MILLISECONDS = 1000.0
QUIET_LOAD = 0.5
WIDTH = 110


@dataclass(frozen=True, slots=True)
class Cost:
    """Of one call: how long it took, and the processor time of this process [s]."""

    took_s: float
    cpu_s: float


def cost(call: Callable[[], object]) -> Cost:
    began_s, cpu_s = time.perf_counter(), time.process_time()
    call()
    return Cost(time.perf_counter() - began_s, time.process_time() - cpu_s)


def median(costs: Iterable[Cost]) -> Cost:
    each = list(costs)
    return Cost(statistics.median(one.took_s for one in each), statistics.median(one.cpu_s for one in each))


def costs_of_a_record(store: RecordingStore, files: dict[str, Path | bytes]) -> dict[str, Cost]:
    """Store, read and delete one record."""
    digests: list[str] = []

    def delete() -> None:
        store.set_aside(digests[0])
        store.remove_set_aside(digests[0])

    def read() -> None:
        with store.opened(digests[0]) as entry:
            entry.with_suffix(".DAT").read_bytes()

    stored = cost(lambda: digests.append(store.store(files).digest))
    return {"store": stored, "read": cost(read), "delete": cost(delete)}


def costs(both: dict[str, RecordingStore], size: int, number: int) -> dict[str, dict[str, Cost]]:
    """Return what a record of a size costs in each store: medians, the stores in turns."""
    found: dict[str, list[dict[str, Cost]]] = {kind: [] for kind in both}
    for k in range(WARM_UP + number):
        files: dict[str, Path | bytes] = {"E.CFG": b"config %d" % k, "E.DAT": os.urandom(size)}
        for kind, store in both.items():
            found[kind].append(costs_of_a_record(store, files))
    return {
        kind: {call: median(one[call] for one in each[WARM_UP:]) for call in each[0]}
        for kind, each in found.items()
    }


@contextmanager
def stores(directory: Path) -> Iterator[dict[str, RecordingStore]]:
    with serving_s3(directory) as server:
        os.environ.update(server.environment)
        yield {
            "folder": FolderStore(directory / "recordings"),
            "bucket": BucketStore(BucketPlace(BUCKET, "benchmark/"), directory / "arriving"),
        }


def section(found: dict[str, dict[str, dict[str, Cost]]], load: tuple[float, float]) -> Section:
    rows = [
        [size, call, *(words for kind in KINDS for words in _milliseconds(each[kind][call]))]
        for size, each in found.items()
        for call in each[KINDS[0]]
    ]
    header = ["Samples", "Call", *(f"{kind}: {what}" for kind in KINDS for what in ("time [ms]", "CPU [ms]"))]
    quiet = "" if max(load) < QUIET_LOAD else ": it was not quiet, and times of a quiet one are shorter"
    counted = ", ".join(f"{number} of {size}" for size, (_, number) in SIZES.items())
    lines = (
        *table(header, rows),
        "",
        *textwrap.wrap(
            f"Medians of records ({counted}), the folder and the bucket in turns, by one process. The "
            "bucket's server is moto's, a process of its own on the same machine: its work is in the time, "
            "not in the CPU. Neither a network nor a store's disks are in the figures. The folder is on the "
            "machine's disk, with fsync, and what goes to the bucket lies there on its way, with fsync too. "
            "Reading from a bucket fetches the record and compares its hash; from a folder it does neither, "
            "and the file is in the system's cache.",
            WIDTH,
        ),
        "",
        *textwrap.wrap(
            f"Python {platform.python_version()}, {os.cpu_count()} cores. Load average of the machine at the "
            f"beginning and the end: {load[0]:.1f} and {load[1]:.1f}{quiet}.",
            WIDTH,
        ),
    )
    return Section("stores", "A record", COMMAND, lines)


def _milliseconds(one: Cost) -> tuple[str, str]:
    took_ms, cpu_ms = one.took_s * MILLISECONDS, one.cpu_s * MILLISECONDS
    return f"{took_ms:{_digits(took_ms)}}", f"{cpu_ms:{_digits(cpu_ms)}}"


def _digits(number: float) -> str:
    return ".0f" if number >= 10.0 else ".1f" if number >= 1.0 else ".2f"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    options = parser.parse_args()
    load_before = os.getloadavg()[0]
    found = {}
    with TemporaryDirectory() as directory, stores(Path(directory)) as both:
        for size, (size_bytes, number) in SIZES.items():
            found[size] = costs(both, size_bytes, number)
    measured = section(found, (load_before, os.getloadavg()[0]))
    print(measured.text())
    if options.write:
        write_sections(PAGE, PREAMBLE, ("stores",), (measured,))


if __name__ == "__main__":
    main()
