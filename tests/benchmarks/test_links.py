"""The benchmark of links: it connects to all relays and reads them, and says what that cost."""

import re

from benchmarks.collector.links import measure


def test_it_tells_what_links_cost_idle_and_read() -> None:
    connected, idle, read, memory = measure(4, 0.3)
    assert connected.startswith("4 relays connected in ")
    assert re.fullmatch(r"idle: \d+\.\d\d % of a core, \d+ threads of Python", idle)
    reads = re.match(r"read: ([\d,]+) a second, median (\S+) ms, 95 % within (\S+) ms", read)
    assert reads is not None
    assert float(reads[1].replace(",", "")) > 10
    assert 0 < float(reads[2]) <= float(reads[3])
    assert memory.startswith("memory: ")
