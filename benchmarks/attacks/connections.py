"""Connections that keep the service waiting: python -m benchmarks.attacks.connections [--seconds 20]

A service of its own may open 1,024 descriptors, as Linux grants by default. Each attack holds 1,300
connections to it (--connections), and opens each again half a second after the service has closed it.
Meanwhile others ask for /healthz and for the list of motors, each time on a new connection, from another
address (--same-address: from that of the attack). Told: the time within which 95 % of them had an answer and
how many had none, descriptors and memory of the service above rest, growth of its log, and how many
descriptors are left over ten seconds after the end. Ends with 1 where a limit is broken.
"""

import argparse
import asyncio
import http.client
import math
import multiprocessing
import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from multiprocessing.synchronize import Event
from pathlib import Path

from benchmarks.reporting import table
from service.client.credentials import headers_for
from testing.ports import LOOPBACK
from testing.service.processes import Service, running_service, switched_off_plant

DESCRIPTORS_OF_SERVICE = 1024
ADDRESS_OF_OTHERS = "127.0.0.2"
PROBE_PERIOD_S = 0.1
PROBE_TIMEOUT_S = 5.0
REOPEN_AFTER_S = 0.5
DRIBBLE_PERIOD_S = 1.0
SETTLING_S = 10.0

HEALTHZ_P95_LIMIT_S = 0.5
MEMORY_LIMIT_MB = 300.0
LOG_LIMIT_BYTES = 100_000

HOST = b"Host: 127.0.0.1\r\n"
HEADER = b"POST /api/v1/recordings HTTP/1.1\r\n" + HOST
FORM = b"Content-Type: multipart/form-data; boundary=x\r\n"
GET = b"GET %s HTTP/1.1\r\n" + HOST + b"\r\n"


@dataclass(frozen=True, slots=True)
class Attack:
    """What each connection sends: at first, and then again and again every second. reads: takes answers."""

    name: str
    first: bytes = b""
    then: bytes = b""
    reads: bool = True


ATTACKS = (
    Attack("silent"),
    Attack("a byte of the header a second", first=HEADER, then=b"x"),
    Attack("a header without end", first=HEADER, then=b"X-More: 1\r\n"),
    Attack("a body announced, not sent", first=HEADER + FORM + b"Content-Length: 1000000\r\n\r\n"),
    Attack("a byte of the body a second", first=HEADER + FORM + b"Content-Length: 9000\r\n\r\n", then=b"x"),
    Attack("a request, then idle", first=GET % b"/healthz"),
    Attack("answers not read", first=GET % b"/api/v1/openapi.json" * 20, reads=False),
    Attack("nonsense", first=b"\x16\x03\x01\r\n\r\n"),
)


@dataclass
class Figures:
    """times_s: until each answer; infinite where there was none, and `failures` says why."""

    times_s: dict[str, list[float]] = field(default_factory=lambda: {"/healthz": [], "/api/v1/motors": []})
    failures: list[str] = field(default_factory=list)
    descriptors: int = 0
    memory_mb: float = 0.0
    log: bytes = b""
    left_over: int = 0

    def p95_s(self, path: str) -> float:
        ordered = sorted(self.times_s[path])
        return ordered[math.ceil(0.95 * len(ordered)) - 1]

    def failed(self, path: str) -> int:
        return sum(each == float("inf") for each in self.times_s[path])

    def broken(self) -> list[str]:
        """The limits that were not kept."""
        return [
            limit
            for limit, kept in (
                ("an answer of /healthz", self.failed("/healthz") == 0),
                (f"/healthz p95 {HEALTHZ_P95_LIMIT_S:g} s", self.p95_s("/healthz") <= HEALTHZ_P95_LIMIT_S),
                ("an answer of /api/v1/motors", self.failed("/api/v1/motors") == 0),
                (f"memory {MEMORY_LIMIT_MB:g} MB", self.memory_mb <= MEMORY_LIMIT_MB),
                (f"log {LOG_LIMIT_BYTES} bytes", len(self.log) <= LOG_LIMIT_BYTES),
            )
            if not kept
        ]


def main() -> int:
    """Run every attack on a service of its own, print a table, and return 1 where a limit is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.attacks.connections", description=__doc__)
    parser.add_argument("--connections", type=int, default=1300)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument(
        "--same-address", action="store_true", help="the others ask from the attack's address"
    )
    parser.add_argument("--only", help="the attack of this name alone")
    arguments = parser.parse_args()
    others = LOOPBACK if arguments.same_address else ADDRESS_OF_OTHERS
    rows, broken = [], []
    for attack in ATTACKS:
        if arguments.only in (None, attack.name):
            figures = measure(attack, arguments.connections, arguments.seconds, others)
            rows.append(_row(attack, figures))
            print(f"{attack.name}: {figures.broken() or 'all limits kept'}", file=sys.stderr, flush=True)
            for failure in figures.failures:
                print(f"  no answer of {failure}", file=sys.stderr, flush=True)
            broken.extend(figures.broken())
    head = (
        "attack",
        "/healthz p95",
        "no answer",
        "motors p95",
        "no answer",
        "descriptors",
        "memory",
        "log",
        "left",
    )
    print("\n".join(table(head, rows)))
    return 1 if broken else 0


def measure(attack: Attack, connections: int, seconds: float, others: str = ADDRESS_OF_OTHERS) -> Figures:
    """Attack a service for so long, and ask from the address of the others."""
    figures = Figures()
    with (
        tempfile.TemporaryDirectory(prefix="statorwatch-attack-") as directory,
        _few_descriptors(),
        running_service(Path(directory), switched_off_plant(Path(directory))) as service,
    ):
        _raise_limit()
        attack = _as_somebody(attack, service.url)
        port = int(service.url.rpartition(":")[2])
        for path in figures.times_s:
            _ask(port, path, others)
        resting, memory_kb = _descriptors(service), _memory_kb(service)
        log_bytes = service.log.stat().st_size
        with _attackers(port, attack, connections):
            _probe(service, port, figures, seconds, others)
        figures.log = service.log.read_bytes()[log_bytes:]
        figures.descriptors -= resting
        figures.memory_mb -= memory_kb / 1024
        time.sleep(SETTLING_S)
        figures.left_over = _descriptors(service) - resting
    return figures


def _as_somebody(attack: Attack, url: str) -> Attack:
    """Return the same attack by somebody who may do everything: others are turned away before it begins."""
    said = "".join(f"{name}: {value}\r\n" for name, value in headers_for(url).items()).encode()
    return replace(attack, first=attack.first.replace(HOST, HOST + said))


def _probe(service: Service, port: int, figures: Figures, seconds: float, others: str) -> None:
    """Ask like others do, while the attack goes on."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        for path, times_s in figures.times_s.items():
            begun_s = time.monotonic()
            failure = _ask(port, path, others)
            times_s.append(math.inf if failure else time.monotonic() - begun_s)
            if failure:
                figures.failures.append(f"{path}, after {time.monotonic() - begun_s:.2f} s: {failure}")
        figures.descriptors = max(figures.descriptors, _descriptors(service))
        figures.memory_mb = max(figures.memory_mb, _memory_kb(service) / 1024)
        time.sleep(PROBE_PERIOD_S)


def _ask(port: int, path: str, address: str) -> str:
    """Ask like a new client, and return why there was no good answer; "" where there was one."""
    client = http.client.HTTPConnection(LOOPBACK, port, timeout=PROBE_TIMEOUT_S, source_address=(address, 0))
    try:
        client.request("GET", path, headers=headers_for(f"http://{LOOPBACK}:{port}"))
        answer = client.getresponse()
        content = answer.read()
    except (OSError, http.client.HTTPException) as error:
        return repr(error)
    finally:
        client.close()
    return "" if answer.status == http.client.OK else f"{answer.status} {content.decode(errors='replace')}"


@contextmanager
def _attackers(port: int, attack: Attack, connections: int) -> Iterator[None]:
    """Hold the connections from another process while the block runs."""
    spawning = multiprocessing.get_context("spawn")
    begun, stop = spawning.Event(), spawning.Event()
    process = spawning.Process(target=_hold_all, args=(port, attack, connections, begun, stop))
    process.start()
    try:
        begun.wait()
        yield
    finally:
        stop.set()
        process.join()


def _hold_all(port: int, attack: Attack, connections: int, begun: Event, stop: Event) -> None:
    _raise_limit()

    async def hold_all() -> None:
        holding = [asyncio.create_task(_hold(port, attack)) for _ in range(connections)]
        begun.set()
        await asyncio.to_thread(stop.wait)
        for each in holding:
            each.cancel()
        await asyncio.gather(*holding, return_exceptions=True)

    asyncio.run(hold_all())


async def _hold(port: int, attack: Attack) -> None:
    """One connection, opened again and again."""
    while True:
        with suppress(OSError):
            reader, writer = await asyncio.open_connection(LOOPBACK, port, limit=1024)
            try:
                writer.write(attack.first)
                sending = asyncio.create_task(_dribble(writer, attack.then))
                try:
                    while attack.reads and await reader.read(4096):
                        pass
                    await sending
                finally:
                    sending.cancel()
            finally:
                writer.transport.abort()
        await asyncio.sleep(REOPEN_AFTER_S)


async def _dribble(writer: asyncio.StreamWriter, text: bytes) -> None:
    while not writer.is_closing():
        await asyncio.sleep(DRIBBLE_PERIOD_S)
        writer.write(text)


@contextmanager
def _few_descriptors() -> Iterator[None]:
    """Start processes with the limit of the service; this process takes its own back with _raise_limit."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS_OF_SERVICE, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def _raise_limit() -> None:
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))


def _descriptors(service: Service) -> int:
    return sum(1 for _ in Path(f"/proc/{service.process_id}/fd").iterdir())


def _memory_kb(service: Service) -> int:
    status = Path(f"/proc/{service.process_id}/status").read_text()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS:"))


def _row(attack: Attack, figures: Figures) -> tuple[str, ...]:
    answers = [
        text
        for path in figures.times_s
        for text in (
            _in_words(figures.p95_s(path)),
            f"{figures.failed(path)} of {len(figures.times_s[path])}",
        )
    ]
    return (
        attack.name,
        *answers,
        f"+{figures.descriptors}",
        f"+{figures.memory_mb:.0f} MB",
        f"{len(figures.log.splitlines())} lines, {len(figures.log) / 1000:.1f} kB",
        f"{figures.left_over}",
    )


def _in_words(time_s: float) -> str:
    return "never" if math.isinf(time_s) else f"{1000 * time_s:.0f} ms"


if __name__ == "__main__":
    sys.exit(main())
