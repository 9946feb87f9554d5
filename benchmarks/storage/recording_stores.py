"""What a record costs in a folder and in a bucket: python -m benchmarks.storage.recording_stores.

The server of the bucket is moto's, a process of its own on this machine: its time is part of the waiting and
not of the processor time. A real store has a network before it and disks behind it.
"""

import argparse
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
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

[Where recordings are kept](../how-to/several-hosts.md#recordings-in-an-s3-compatible-store): in a folder, or
in a bucket of an S3-compatible store.
"""
COMMAND = "python -m benchmarks.storage.recording_stores"
SIZES = {"200 kB": (200_000, 40), "20 MB": (20_000_000, 4)}
"""Of a record's samples [bytes], and how many records are measured."""
MILLISECONDS = 1000.0


@dataclass(frozen=True, slots=True)
class Cost:
    """Of one call: how long it took, and the processor time of this process [s]."""

    took_s: float
    cpu_s: float


def measured(calls: list[Callable[[], object]]) -> Cost:
    began_s, cpu_s = time.perf_counter(), time.process_time()
    for call in calls:
        call()
    number = len(calls)
    return Cost((time.perf_counter() - began_s) / number, (time.process_time() - cpu_s) / number)


def costs(store: RecordingStore, size: int, number: int) -> dict[str, Cost]:
    """Return what storing, reading and deleting records of a size costs."""
    records: list[dict[str, Path | bytes]] = [
        {"E.CFG": b"config %d" % k, "E.DAT": os.urandom(size)} for k in range(number)
    ]
    digests: list[str] = []

    def keep(record: dict[str, Path | bytes]) -> None:
        digests.append(store.store(record).digest)

    def delete(digest: str) -> None:
        store.set_aside(digest)
        store.remove_set_aside(digest)

    def read(digest: str) -> None:
        with store.opened(digest) as entry:
            entry.with_suffix(".DAT").read_bytes()

    store.set_aside(store.store({"W.CFF": b"warm up"}).digest)
    stored = measured([partial(keep, one) for one in records])
    opened = measured([partial(read, one) for one in digests])
    deleted = measured([partial(delete, one) for one in digests])
    return {"store": stored, "read": opened, "delete": deleted}


@contextmanager
def stores(directory: Path) -> Iterator[dict[str, RecordingStore]]:
    with serving_s3(directory) as server:
        os.environ.update(server.environment)
        yield {
            "folder": FolderStore(directory / "recordings"),
            "bucket": BucketStore(BucketPlace(BUCKET, "benchmark/"), directory / "arriving"),
        }


def section(found: dict[tuple[str, str], dict[str, Cost]], load: tuple[float, float]) -> Section:
    rows = [
        [size, kind, what, f"{cost.took_s * MILLISECONDS:.1f}", f"{cost.cpu_s * MILLISECONDS:.1f}"]
        for (size, kind), each in found.items()
        for what, cost in each.items()
    ]
    lines = (
        *table(["samples", "kept in", "call", "time [ms]", "CPU [ms]"], rows),
        "",
        "Means of one process that does nothing else. The bucket's server is moto's, a process of its own "
        f"on the same {os.cpu_count()} cores, without a network: its own work is in the time, not the CPU. "
        "The folder is on the disk of temporary files, with fsync. Reading from a bucket compares the "
        "hash, from a folder it does not. Load average of the machine when it began and ended: "
        f"{load[0]:.1f} and {load[1]:.1f}.",
    )
    return Section("stores", "A record", COMMAND, lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    options = parser.parse_args()
    load_before = os.getloadavg()[0]
    found = {}
    with TemporaryDirectory() as directory, stores(Path(directory)) as both:
        for size, (size_bytes, number) in SIZES.items():
            for kind, store in both.items():
                found[size, kind] = costs(store, size_bytes, number)
                print(size, kind, found[size, kind])
    if options.write:
        write_sections(PAGE, PREAMBLE, ("stores",), (section(found, (load_before, os.getloadavg()[0])),))


if __name__ == "__main__":
    main()
