"""Many small records, fetched alone and into the store: python -m benchmarks.collector.small_records.

The relay runs in a process of its own and gives as fast as it can. What the collector does beside, such as
its rows in the database, is told by record_cost.
"""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from mms import Client
from service.collector.records.batch import Batch
from service.collector.records.life import RecordState
from service.collector.records.listing import FolderListing, ListedRecord, files_by_name, understand
from service.collector.records.pull import DailyAllowance
from service.recording_store.folder import FolderStore
from testing.ports import LOOPBACK
from testing.relays.serving import RelayProcess
from testing.service.small_record import CFG

FOLDER = "EVENTS"
SAMPLES_BYTES = 50_000
"""Of a record: a quarter of a second of six channels at 10 kHz."""


class _Discarded:
    """Takes bytes and keeps none."""

    def write(self, chunk: bytes, /) -> None:
        pass


def measure(records: int, rounds: int) -> Iterator[str]:
    """Yield how long all records take by each way, in turns: a line for each."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-small-") as name:
        directory = Path(name)
        events = directory / "relay" / FOLDER
        events.mkdir(parents=True)
        for number in range(records):
            (events / f"HR_{10_000 + number}.CFG").write_bytes(CFG)
            # No two records alike: the store keeps each content once.
            content = number.to_bytes(4) * (SAMPLES_BYTES // 4)
            (events / f"HR_{10_000 + number}.DAT").write_bytes(content)
        relay = RelayProcess(directory / "relay", None)
        try:
            with Client.connect(LOOPBACK, relay.port) as client:
                listed = understand([FolderListing(FOLDER, client.files(FOLDER))]).records
                assert len(listed) == records
                yield from _told(client, listed, directory, rounds)
        finally:
            relay.end()


def _told(client: Client, listed: Sequence[ListedRecord], directory: Path, rounds: int) -> Iterator[str]:
    fetched, stored = [], []
    for _ in range(rounds + 1):
        fetched.append(_fetched_s(client, listed))
        stored.append(_stored_s(client, listed, directory))
    alone_s, into_s = (statistics.median(times[1:]) for times in (fetched, stored))
    number = len(listed)
    yield f"{number} records fetched: {alone_s:.2f} s, {1000 * alone_s / number:.1f} ms each"
    yield (
        f"{number} records into the store: {into_s:.2f} s, {1000 * into_s / number:.1f} ms each, "
        f"{alone_s / into_s:.0%} of that speed"
    )


def _fetched_s(client: Client, listed: Sequence[ListedRecord]) -> float:
    begun_s = time.perf_counter()
    for record in listed:
        for file in record.files:
            client.download(file.remote_name, _Discarded(), expected_size=file.size)
    return time.perf_counter() - begun_s


def _stored_s(client: Client, listed: Sequence[ListedRecord], directory: Path) -> float:
    with tempfile.TemporaryDirectory(dir=directory) as root:
        begun_s = time.perf_counter()
        with Batch(
            client,
            FolderStore(Path(root)),
            DailyAllowance(sys.maxsize),
            max_file_bytes=SAMPLES_BYTES,
            on_bytes=lambda _: None,
            listing_s=0.0,
        ) as batch:
            for record in listed:
                if batch.is_due():
                    _keep(client, batch)
                batch.fetch(RecordState(record))
            _keep(client, batch)
        return time.perf_counter() - begun_s


def _keep(client: Client, batch: Batch) -> None:
    confirmed, failed = batch.checked(files_by_name([FolderListing(FOLDER, client.files(FOLDER))]))
    assert not failed
    for _, on_disk in batch.kept(confirmed):
        on_disk()
    batch.clear()


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.collector.small_records", description=__doc__)
    parser.add_argument("--records", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    for line in measure(arguments.records, arguments.rounds):
        print(line, flush=True)


if __name__ == "__main__":
    main()
