"""How long the server takes for a page, and how large its answer is."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil
from pathlib import Path

import httpx

from service.api.access.cookies import NAME

HEADERS = {"Accept": "text/html,*/*;q=0.8", "Accept-Encoding": "gzip"}


@dataclass(frozen=True, slots=True)
class Site:
    """A running site and a session at it."""

    url: str
    session: str
    process_id: int

    def client(self) -> httpx.Client:
        """Return a client that is logged in."""
        cookies = {NAME: self.session}
        return httpx.Client(
            base_url=self.url, headers=HEADERS, cookies=cookies, trust_env=False, timeout=60.0
        )

    def processor_s(self) -> float:
        """Return how much of a processor the service has used [s]."""
        return time.clock_gettime((~self.process_id << 3) | 2)  # the process's own clock, as Linux numbers it


@contextmanager
def serving(data: Path, url: str | None = None) -> Iterator[Site]:
    """Run the site on a data directory, and yield it. url: of its database, where that lies elsewhere."""
    command = [sys.executable, "-m", "benchmarks.web.server", str(data), *([url] if url else [])]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port, session = process.stdout.readline().split()
            yield Site(f"http://127.0.0.1:{port}", session, process.pid)
        finally:
            process.terminate()


@dataclass(frozen=True, slots=True)
class Answers:
    """Of one address: how long the answers took [s], and how large one is as transferred.

    processor_s: of a processor that the service used for one, whatever else the machine does.
    """

    times_s: Sequence[float]
    bytes: int
    processor_s: float

    def percentile_s(self, share: float) -> float:
        """Return the time that so many of the answers kept [s]."""
        ordered = sorted(self.times_s)
        return ordered[max(ceil(share * len(ordered)) - 1, 0)]


def answers(site: Site, path: str, *, turns: int, change: Callable[[], None] | None = None) -> Answers:
    """Ask for an address so many times, after a first time that does not count.

    change: changes the plant before each time, so that no answer is one that the service has made before.
    """
    times_s, size, used_s = [], 0, 0.0
    with site.client() as client:
        for turn in range(turns + 1):
            if change is not None:
                change()
            begun_s, before_s = time.perf_counter(), site.processor_s()
            with client.stream("GET", path) as answer:
                size = sum(len(part) for part in answer.iter_raw())
            if turn:
                times_s.append(time.perf_counter() - begun_s)
                used_s += site.processor_s() - before_s
            assert answer.is_success, f"{path}: {answer.status_code}"
    return Answers(times_s, size, used_s / turns)
