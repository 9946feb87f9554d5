"""What idle clients of a simulated relay cost one that reads: python -m benchmarks.simulator.idle_clients.

Time of a read while up to four other clients are connected and ask nothing.
"""

import statistics
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack

from mms import MOST_CONNECTIONS, Client, FunctionalConstraint, Server
from scl import SEL710_ICD, read
from scl.model_text import model_text
from service.demo.addresses import free_ports

HOST = "127.0.0.1"
READS = 300
HEALTH = "Beh.stVal"


def measure(reads: int = READS) -> Iterator[str]:
    document = read(SEL710_ICD)
    (ied,) = document.ieds
    node = next(iter(ied.logical_nodes())).reference
    (port,) = free_ports(1)
    yield "idle clients   median of a read [ms]   reads a second"
    with Server(model_text(document, ied.name), address=HOST, port=port), ExitStack() as connected:
        reader = connected.enter_context(Client.connect(HOST, port))
        for idle in range(MOST_CONNECTIONS):
            if idle:
                connected.enter_context(Client.connect(HOST, port))
            times_s = [_time_of_a_read(reader, f"{node}.{HEALTH}") for _ in range(reads)]
            yield f"{idle:12d}   {statistics.median(times_s) * 1e3:21.2f}   {reads / sum(times_s):14.0f}"


def _time_of_a_read(client: Client, reference: str) -> float:
    begin_s = time.perf_counter()
    client.read(reference, FunctionalConstraint.ST)
    return time.perf_counter() - begin_s


if __name__ == "__main__":
    for line in measure():
        sys.stdout.write(f"{line}\n")
