"""What many links cost: python -m benchmarks.collector.links [--relays N] [--seconds S].

So many relays run in two processes of their own; this process connects to each, leaves all idle, and then
reads a value of one after the other on eight threads. It prints what that costs this process.
"""

import argparse
import multiprocessing
import resource
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection

import numpy as np

from mms import Client, FunctionalConstraint, Server, ServerPump
from service.demo.addresses import free_ports
from testing.ports import LOOPBACK
from testing.relays.model import MODEL_TEXT

RELAYS, SECONDS = 200, 10.0
HOSTS = 2
THREADS = 8
REFERENCE = "T1PRO/GGIO1.AnIn1.mag.f"


@dataclass(frozen=True, slots=True)
class Cost:
    """What one stretch of work cost this process."""

    wall_s: float
    cpu_s: float

    @property
    def of_a_core(self) -> float:
        """Part of one core."""
        return self.cpu_s / self.wall_s


@contextmanager
def _counted() -> Iterator[list[Cost]]:
    cost: list[Cost] = []
    wall_s, cpu_s = time.perf_counter(), time.process_time()
    yield cost
    cost.append(Cost(time.perf_counter() - wall_s, time.process_time() - cpu_s))


def _host(ports: Sequence[int], told: Connection) -> None:
    """Serve relays at these ports until the other end closes."""
    with ServerPump(Server(MODEL_TEXT, port=port) for port in ports):
        told.send(None)
        try:
            told.recv()
        except EOFError:
            return


@contextmanager
def _relays(number: int) -> Iterator[Sequence[int]]:
    """Serve relays in processes of their own; gives their ports."""
    ports = free_ports(number)
    context = multiprocessing.get_context("spawn")
    with ExitStack() as stack:
        for host in range(HOSTS):
            ours, theirs = context.Pipe()
            process = context.Process(target=_host, args=(ports[host::HOSTS], theirs), daemon=True)
            process.start()
            stack.callback(process.join)
            stack.callback(ours.close)
            theirs.close()
            ours.recv()
        yield ports


def _read_in_turns(clients: Sequence[Client], stop: threading.Event) -> list[float]:
    """Read of one relay after the other; returns how long each took [s]."""
    taken_s = []
    while not stop.is_set():
        for client in clients:
            begun_s = time.perf_counter()
            client.read(REFERENCE, FunctionalConstraint.MX)
            taken_s.append(time.perf_counter() - begun_s)
    return taken_s


def _read_all(clients: Sequence[Client], seconds: float) -> list[float]:
    stop = threading.Event()
    timer = threading.Timer(seconds, stop.set)
    with ThreadPoolExecutor(THREADS) as threads:
        readers = [threads.submit(_read_in_turns, clients[at::THREADS], stop) for at in range(THREADS)]
        timer.start()
        return [each for reader in readers for each in reader.result()]


def measure(relays: int, seconds: float) -> Iterator[str]:
    """Measure connecting, idling and reading, one line each."""
    with _relays(relays) as ports, ExitStack() as stack:
        with _counted() as connecting, ThreadPoolExecutor(THREADS) as threads:
            clients = list(
                threads.map(lambda port: stack.enter_context(Client.connect(LOOPBACK, port)), ports)
            )
        cost = connecting[0]
        each_ms = 1000 * cost.cpu_s / relays
        yield f"{relays} relays connected in {cost.wall_s:.1f} s, {each_ms:.1f} ms of CPU each"
        with _counted() as idle:
            time.sleep(seconds)
        yield f"idle: {100 * idle[0].of_a_core:.2f} % of a core, {threading.active_count()} threads of Python"
        with _counted() as reading:
            taken_s = _read_all(clients, seconds)
        cost = reading[0]
        low, high = 1000 * np.percentile(taken_s, [50, 95])
        yield (
            f"read: {len(taken_s) / cost.wall_s:,.0f} a second, "
            f"median {low:.2f} ms, 95 % within {high:.2f} ms, "
            f"{1e6 * cost.cpu_s / len(taken_s):.0f} us of CPU each"
        )
        memory_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        yield f"memory: {memory_mb:.0f} MB at most"


def main() -> int:
    """Print what links cost."""
    parser = argparse.ArgumentParser(prog="benchmarks.collector.links", description=__doc__)
    parser.add_argument("--relays", type=int, default=RELAYS)
    parser.add_argument("--seconds", type=float, default=SECONDS)
    arguments = parser.parse_args()
    for line in measure(arguments.relays, arguments.seconds):
        print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
