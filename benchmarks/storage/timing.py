"""Times of requests to a running API: the first one on a cold machine, and those of a warm one."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from http import HTTPStatus
from math import ceil
from pathlib import Path

import httpx

from benchmarks.storage.requests import Ask
from benchmarks.storage.rows import Amounts
from service.client.credentials import bearer

LONGEST_S = 30.0
"""A request that has taken so long in all is not asked again: its goal is missed anyway."""

Progress = Callable[[str], None]


@dataclass(slots=True)
class Times:
    """How long one request took [s].

    cold_s: the first time, with nothing of the database in memory. processor_s: of the service alone, which
    other work on the machine does not lengthen.
    """

    ask: Ask
    cold_s: float = 0.0
    warm_s: list[float] = field(default_factory=list)
    processor_s: list[float] = field(default_factory=list)
    bytes: int = 0

    def percentile_s(self, share: float) -> float:
        """Return the time that so many of the requests kept [s]."""
        ordered = sorted(self.warm_s)
        return ordered[max(ceil(share * len(ordered)) - 1, 0)]

    @property
    def is_within_goal(self) -> bool:
        return self.percentile_s(0.95) <= self.ask.goal_s


@dataclass(frozen=True, slots=True)
class Api:
    """The API in a process of its own."""

    client: httpx.Client
    process_id: int

    def get(self, path: str) -> tuple[float, float, int]:
        """Return how long an answer took, how much of the processor [s], and how many bytes it has."""
        used_s, begun_s = self._processor_s(), time.perf_counter()
        answer = self.client.get(path)
        took_s = time.perf_counter() - begun_s
        assert answer.status_code == HTTPStatus.OK, f"{path}: {answer.status_code} {answer.text[:300]}"
        return took_s, self._processor_s() - used_s, len(answer.content)

    def _processor_s(self) -> float:
        return time.clock_gettime((~self.process_id << 3) | 2)  # the process's own clock, as Linux numbers it


@contextmanager
def serving(url: str) -> Iterator[Api]:
    """Run the API on this database, and yield it."""
    command = [sys.executable, "-m", "benchmarks.storage.server", url]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port, token = process.stdout.readline().split()
            url = f"http://127.0.0.1:{port}"
            with httpx.Client(base_url=url, headers=bearer(token), trust_env=False, timeout=600.0) as client:
                api = Api(client, process.pid)
                api.get("/healthz")
                yield api
        finally:
            process.terminate()


def measure(
    url: str, asked: Sequence[Ask], amounts: Amounts, *, turns: int, file: Path | None, progress: Progress
) -> Sequence[Times]:
    """Time every request `turns` times, each time at another position, in turns with all others.

    Each is asked once before, with a service that has just started. file: the database's, whose pages are put
    out of the system's memory before each of these; None where that is not possible.
    """
    times = [Times(ask) for ask in asked]
    with serving(url) as api:
        for one in times:
            if file is not None:
                _forget(file)
            one.cold_s, _, one.bytes = api.get(one.ask.at(0.5, amounts))
        progress("each request once, cold")
        for turn in range(turns):
            for one in times:
                if sum(one.warm_s) < LONGEST_S:
                    warm_s, processor_s, _ = api.get(one.ask.at((turn + 0.5) / turns, amounts))
                    one.warm_s.append(warm_s)
                    one.processor_s.append(processor_s)
            if turn % 10 == 9:
                progress(f"{turn + 1} of {turns} turns")
    return times


def _forget(file: Path) -> None:
    """Put a file out of the system's memory; what is written and not on the disk yet stays there."""
    descriptor = os.open(file, os.O_RDONLY)
    try:
        os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)
    finally:
        os.close(descriptor)
