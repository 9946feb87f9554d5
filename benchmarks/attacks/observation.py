"""What a service uses while it is attacked, seen from a process of its own: memory, CPU time, /healthz."""

import multiprocessing
import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Self

import numpy as np

from benchmarks.attacks.attack import Target
from testing.service.processes import descendants

MEMORY_PERIOD_S = 0.05
PROBE_PERIOD_S = 0.02
_TICKS_A_SECOND = os.sysconf("SC_CLK_TCK")


def tree(process_id: int) -> list[int]:
    """Return the process and all below it."""
    return [process_id, *descendants(process_id)]


def memory_mb(process_id: int) -> float:
    """Return the memory of the process and all below it [MB]; shared pages are counted once (PSS)."""
    kib = 0
    for one in tree(process_id):
        with suppress(OSError):  # it ended meanwhile
            lines = Path(f"/proc/{one}/smaps_rollup").read_text().splitlines()
            kib += sum(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    return kib * 1024 / 1e6


def cpu_s(process_id: int) -> float:
    """Return the CPU time of the process and all below it, those that ended included [s]."""
    ticks = 0
    for one in tree(process_id):
        with suppress(OSError):
            fields = Path(f"/proc/{one}/stat").read_text().rpartition(")")[2].split()
            ticks += sum(int(used) for used in fields[11:15])
    return ticks / _TICKS_A_SECOND


@dataclass
class Seen:
    """Most memory [MB], and how long /healthz took [s]; a time limit where it did not answer."""

    most_memory_mb: float = 0.0
    probes_s: list[float] = field(default_factory=list)

    def probe_s(self, percentile: float) -> float:
        return float(np.percentile(self.probes_s, percentile)) if self.probes_s else float("nan")


class Observer:
    """Watches from the beginning of the block to its end; `seen` is there afterwards."""

    def __init__(self, process_id: int, target: Target) -> None:
        # A process of its own: the attackers' threads would hold up the probes.
        spawning = multiprocessing.get_context("spawn")
        self._end = spawning.Event()
        self._result, sender = spawning.Pipe(duplex=False)
        self._process = spawning.Process(target=_observe, args=(process_id, target, self._end, sender.send))
        self.seen = Seen()

    def __enter__(self) -> Self:
        self._process.start()
        self._result.recv()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self.seen = self._result.recv()
        self._process.join()


def _observe(process_id: int, target: Target, end: Event, send: Callable[[object], None]) -> None:
    seen = Seen()
    weigher = threading.Thread(target=_weigh, args=(process_id, end, seen))
    weigher.start()
    send("begun")
    while True:
        begun = time.monotonic()
        target.ask("GET", "/healthz")
        took_s = time.monotonic() - begun
        # One who asks meanwhile waits for the rest of it: a standstill counts for as long as it lasts.
        seen.probes_s += list(np.arange(took_s, 0.0, -PROBE_PERIOD_S))
        if end.wait(PROBE_PERIOD_S):
            break
    weigher.join()
    send(seen)


def _weigh(process_id: int, end: Event, seen: Seen) -> None:
    while not end.wait(MEMORY_PERIOD_S):
        seen.most_memory_mb = max(seen.most_memory_mb, memory_mb(process_id))
