"""Pull speed: 20 MB of one server by libiec61850's own client in C, by ours, and into the store, in turns."""

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from benchmarks.interoperability.peers import PeerError, linked
from mms import Client, TlsConfiguration, filter_tls_log_from_stderr
from mms.binding.library import shared_library
from service.collector.records.listing import FolderListing, understand
from service.collector.records.pull import pull
from service.recording_store.folder import FolderStore
from testing.ports import LOOPBACK
from testing.relays.pki import Pki
from testing.relays.serving import RelayProcess
from testing.service.small_record import CFG

FILE_BYTES = 20_000_000
ROUNDS, TLS_ROUNDS = 15, 3
FOLDER, STEM = "EVENTS", "HR_10001"
DATA_FILE = f"{FOLDER}/{STEM}.DAT"
IN_C, OURS, STORED = "libiec61850's client in C", "mms.Client", "collector into the store (fsync, SHA-256)"


class _Counted:
    """Takes bytes and keeps their number, as the client in C does."""

    def __init__(self) -> None:
        self.received = 0

    def write(self, chunk: bytes, /) -> None:
        self.received += len(chunk)


def measure() -> Iterator[str]:
    """Median of the rounds by each way, in clear and over TLS, and each one's share of the speed in C."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-pull-") as name:
        directory = Path(name)
        pki = Pki.make(directory)
        for channel, rounds, certificates in (("clear", ROUNDS, None), ("TLS", TLS_ROUNDS, pki)):
            seconds = _rounds(directory / channel, certificates, rounds)
            yield from _told(channel, rounds, seconds)


def _told(channel: str, rounds: int, seconds: Mapping[str, list[float]]) -> Iterator[str]:
    medians = {way: statistics.median(times) for way, times in seconds.items()}
    megabytes = FILE_BYTES / 1e6
    if IN_C not in medians:
        yield "no C compiler, so nothing to compare with"
    for way, median in medians.items():
        line = f"{channel}, {way}: {megabytes / median:.3g} MB/s, {median:.3f} s (median of {rounds})"
        if way != IN_C and IN_C in medians:
            line += f", {medians[IN_C] / median:.0%} of C's"
        yield line


def _rounds(directory: Path, pki: Pki | None, rounds: int) -> dict[str, list[float]]:
    """Seconds of each way, which take turns; the first round is not counted."""
    events = directory / "relay" / FOLDER
    events.mkdir(parents=True)
    (events / f"{STEM}.CFG").write_bytes(CFG)
    (events / f"{STEM}.DAT").write_bytes(bytes(range(250)) * (FILE_BYTES // 250))
    relay = RelayProcess(directory / "relay", None if pki is None else pki.folder)
    try:
        ways = _ways(directory, relay.port, pki)
        seconds: dict[str, list[float]] = {way: [] for way in ways}
        for turn in range(rounds + 1):
            for way, fetch in ways.items():
                taken_s = fetch()
                if turn:
                    seconds[way].append(taken_s)
    finally:
        relay.end()
    return seconds


def _ways(directory: Path, port: int, pki: Pki | None) -> Mapping[str, Callable[[], float]]:
    """Each connects anew, fetches once and tells how long the fetching took [s]."""
    ways: dict[str, Callable[[], float]] = {}
    tls = None if pki is None else pki.of_client()
    try:
        program = linked(shared_library(), directory / "c_client")
        ways[IN_C] = lambda: _in_c(program, port, tls)
    except PeerError as error:
        print(error, file=sys.stderr)
    ways[OURS] = lambda: _ours(port, tls)
    ways[STORED] = lambda: _stored(directory, port, tls)
    return ways


def _in_c(program: Path, port: int, tls: TlsConfiguration | None) -> float:
    command = [str(program), "pull", LOOPBACK, str(port), DATA_FILE, "1"]
    if tls is not None:
        command += [str(path) for path in (tls.certificate, tls.key, tls.ca, *tls.pinned)]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    received, taken_s = answer.stdout.split()
    assert int(received) == FILE_BYTES
    return float(taken_s)


def _ours(port: int, tls: TlsConfiguration | None) -> float:
    with Client.connect(LOOPBACK, port, tls=tls) as client:
        sink = _Counted()
        begun_s = time.perf_counter()
        client.download(DATA_FILE, sink, expected_size=FILE_BYTES)
        taken_s = time.perf_counter() - begun_s
    assert sink.received == FILE_BYTES
    return taken_s


def _stored(directory: Path, port: int, tls: TlsConfiguration | None) -> float:
    """Both files of the record, as the collector pulls them."""
    with (
        Client.connect(LOOPBACK, port, tls=tls) as client,
        tempfile.TemporaryDirectory(dir=directory) as root,
    ):
        store = FolderStore(Path(root))
        (record,) = understand([FolderListing(FOLDER, client.files(FOLDER))]).records
        begun_s = time.perf_counter()
        with store.incoming() as incoming:
            pull(client, record, incoming, max_file_bytes=FILE_BYTES, on_bytes=lambda _: None)
            stored = incoming.keep()
        taken_s = time.perf_counter() - begun_s
    assert stored.size_bytes == FILE_BYTES + len(CFG)
    return taken_s


if __name__ == "__main__":
    filter_tls_log_from_stderr()
    for line in measure():
        print(line)
