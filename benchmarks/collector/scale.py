"""Many relays held by one service: python -m benchmarks.collector.scale [--relays 200] [--minutes 30]

Every relay is triggered once in --period-minutes, evenly spread; of many relays the first --triggered only.
Told: relays that were not heard of for two poll periods (missed polls), growth of the memory of all the
service's processes after a warm-up, time from a record made (its last file in the relay) to stored, and CPU.
--period-minutes 0 triggers nothing: connected and read only. Processes of 200 relays each simulate them, and
their CPU time is told apart. With --integrations the service runs its OPC UA, IEC 61850, IEC 104, Modbus and
MQTT gateways beside it. Ends with 1 and names each limit that was broken; a run without triggers, or
shorter than JUDGED_MINUTES, is told and not judged.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from lxml import etree

from benchmarks.processes import exit_when_terminated
from benchmarks.simulator.plant import cpu_s, plant_of, resident_mb
from core.units import NANOSECONDS_PER_SECOND
from scl.document import Document
from scl.instantiation import write
from service.client.rest_client import ServiceClient, ServiceError
from service.demo import MOTORS
from service.demo.addresses import free_ports
from testing.service import processes
from testing.service.mosquitto import running_mosquitto
from testing.service.processes import Service, descendants
from testing.waiting import eventually

POLL_PERIOD_S = 5.0
LOOK_S = 5.0
WARM_UP_SHARE = 0.2
START_LIMIT_S = 300.0
RELAYS_A_PROCESS = 200
"""Of the simulator."""
JUDGED_MINUTES = 10.0
"""In less the memory still warms up, and its slope says nothing."""

MOST_TOLD = 20
"""Missed polls that are told one by one."""

MEMORY_LIMIT_MB_A_MINUTE = 1.0
P95_LIMIT_S = 1.0
LIMITS = (
    f"limits: no missed poll, below {MEMORY_LIMIT_MB_A_MINUTE:g} MB a minute, p95 at most {P95_LIMIT_S:g} s"
)
UNDER_WAY = ("requested", "triggered", "recorded")


@dataclass
class Seen:
    """memory: (minutes, MB) of all the service's processes.  delays_s: from made to stored, by recording.
    missed: by relay and time of its last answer, the minute it was found and in words."""

    looks: int = 0
    missed: dict[tuple[str, str], str] = field(default_factory=dict)
    memory: list[tuple[float, float]] = field(default_factory=list)
    delays_s: dict[str, float] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)

    def memory_slope(self, since_minute: float) -> float | None:
        """[MB a minute]; None where it was hardly looked at since then."""
        warm = [(minute, memory) for minute, memory in self.memory if minute >= since_minute]
        if len(warm) <= 2:
            return None
        return float(statistics.linear_regression(*zip(*warm, strict=True)).slope)

    def p95_s(self) -> float | None:
        """Of the delays; None where there are hardly any."""
        if len(self.delays_s) <= 1:
            return None
        return statistics.quantiles(self.delays_s.values(), n=20, method="inclusive")[-1]


def broken_limits(seen: Seen, minutes: float, period_minutes: float) -> list[str]:
    """In words; a figure that is missing breaks its limit."""
    if period_minutes <= 0 or minutes < JUDGED_MINUTES:
        return []
    slope, p95_s = seen.memory_slope(WARM_UP_SHARE * minutes), seen.p95_s()
    broken = []
    if seen.looks == 0 or seen.missed:
        broken.append(f"missed polls: expected none, found {len(seen.missed)} in {seen.looks} looks")
    if slope is None or slope >= MEMORY_LIMIT_MB_A_MINUTE:
        found = "too few looks" if slope is None else f"{slope:+.2f}"
        broken.append(f"memory: expected below {MEMORY_LIMIT_MB_A_MINUTE:g} MB a minute, found {found}")
    if p95_s is None or p95_s > P95_LIMIT_S:
        found = f"{len(seen.delays_s)} recordings" if p95_s is None else f"{p95_s:.2f} s"
        broken.append(f"made to stored: expected p95 at most {P95_LIMIT_S:g} s, found {found}")
    return broken


def measure(
    seen: Seen,
    relays: int,
    minutes: float,
    period_minutes: float,
    relays_per_gateway: int | None = None,
    triggered: int | None = None,
    *,
    with_integrations: bool = False,
) -> Iterator[str]:
    with tempfile.TemporaryDirectory(prefix="statorwatch-scale-") as name:
        directory = Path(name)
        scd, motors, parts = _files(directory, relays)
        own = {} if relays_per_gateway is None else {"MCC_RELAYS_PER_GATEWAY": str(relays_per_gateway)}
        with ExitStack() as running:
            if with_integrations:
                own["MCC_GATEWAYS"] = json.dumps(running.enter_context(_integrations(directory)))
            simulators = [running.enter_context(_simulated(part, directory)) for part in parts]
            service = running.enter_context(_served(directory, scd, motors, own))
            begun_s = time.monotonic()
            with ServiceClient(service.url) as client:
                if not eventually(lambda: _links_up(client) == relays, START_LIMIT_S):
                    raise RuntimeError(f"expected {relays} links up, found {_links_up(client)}")
                up_s = time.monotonic() - begun_s
                yield f"{relays} relays: all links up {up_s:.1f} s after the service was ready"
                before_s, simulator_s = _cpu_s(service), sum(map(cpu_s, simulators))
                yield f"until then {before_s:.1f} s of CPU; {_gateways(service)}"
                _watch(seen, service, client, directory / "relays", minutes, period_minutes, triggered)
                spent_s = _cpu_s(service) - before_s
                simulated_s = sum(map(cpu_s, simulators)) - simulator_s
                yield from _told(seen, minutes, spent_s, simulated_s)
                yield from _outcome(client, seen)
                yield f"at the end {_gateways(service)}"
                for one in client.items("/integrations"):
                    yield f"{one['kind']}: {one['problem'] or 'works'}, started again {one['restarts']} times"
    yield LIMITS


def _watch(
    seen: Seen,
    service: Service,
    client: ServiceClient,
    files: Path,
    minutes: float,
    period_minutes: float,
    triggered: int | None,
) -> None:
    motors = sorted(str(motor["name"]) for motor in client.items("/motors"))[:triggered]
    begun_s = time.monotonic()
    while (elapsed_s := time.monotonic() - begun_s) < minutes * 60:
        due = int(elapsed_s / (period_minutes * 60) * len(motors)) if period_minutes else 0
        for number in range(len(seen.asked), due):
            request = client.request_recording(motors[number % len(motors)])
            seen.asked.append(str(request["id"]))
        if elapsed_s >= seen.looks * LOOK_S:
            seen.looks += 1
            _look(service, client, seen, elapsed_s / 60)
            _note_delays(client, files, seen)
        time.sleep(0.1)
    eventually(lambda: not _open(client, seen), 60)
    _note_delays(client, files, seen)


def _look(service: Service, client: ServiceClient, seen: Seen, minute: float) -> None:
    now_s = time.time()
    for ied in client.items("/ieds", limit="1000"):
        name, state, heard = (str(ied[key]) for key in ("name", "link_state", "last_success_time"))
        silent_s = now_s - _seconds(heard)
        if state != "up" or silent_s > 2 * POLL_PERIOD_S:
            seen.missed[name, heard] = (
                f"minute {minute:.1f}: {name} is {state}, last heard of {silent_s:.1f} s ago"
            )
    seen.memory.append((minute, sum(resident_mb(process_id) for process_id in _processes(service))))


def _note_delays(client: ServiceClient, files: Path, seen: Seen) -> None:
    """Of recordings stored since: how long after the relay had its last file."""
    for recording in client.items("/recordings", limit="200"):
        if str(recording["id"]) in seen.delays_s:
            return  # latest first: the others are known
        if recording["fetched_time"] is None:
            continue
        made = (files / str(recording["ied"]) / "EVENTS").glob(f"{recording['name']}.*")
        changed_s = [path.stat().st_ctime_ns / NANOSECONDS_PER_SECOND for path in made]
        if changed_s:
            seen.delays_s[str(recording["id"])] = _seconds(recording["fetched_time"]) - max(changed_s)


def _open(client: ServiceClient, seen: Seen) -> list[str]:
    """Return the recording requests that have no recording yet."""
    return [each for each in seen.asked if client.get_event_report(each)["state"] in UNDER_WAY]


def _told(seen: Seen, minutes: float, spent_s: float, simulated_s: float) -> Iterator[str]:
    yield f"missed polls: {len(seen.missed)} (looked {seen.looks} times at every relay)"
    yield from list(seen.missed.values())[:MOST_TOLD]
    begin = WARM_UP_SHARE * minutes
    slope = seen.memory_slope(begin)
    if slope is not None:
        last_MB = seen.memory[-1][1]
        yield f"memory: {last_MB:.0f} MB in all, {slope:+.2f} MB a minute after {begin:.1f} minutes"
    delays, p95_s = sorted(seen.delays_s.values()), seen.p95_s()
    if p95_s is not None:
        yield (
            f"made to stored: median {statistics.median(delays):.2f} s, p95 {p95_s:.2f} s, "
            f"most {delays[-1]:.2f} s ({len(delays)} recordings)"
        )
    service, relays = (100 * used_s / (60 * minutes) for used_s in (spent_s, simulated_s))
    yield f"CPU, of a core: {service:.0f} % the service with its diagnoses, {relays:.0f} % the relays"


def _outcome(client: ServiceClient, seen: Seen) -> Iterator[str]:
    states = Counter(str(client.get_event_report(each)["state"]) for each in seen.asked)
    if states:
        told = ", ".join(f"{number} {state}" for state, number in states.items())
        yield f"recording requests: {len(seen.asked)} asked, {told}"
    measured = [motor for motor in client.items("/motors") if _is_measured(client, str(motor["name"]))]
    yield f"read: {len(measured)} motors have measured values"


def _is_measured(client: ServiceClient, motor: str) -> bool:
    return bool(client.get(f"/motors/{motor}/measurements", step="0", limit="1")["items"])


def _links_up(client: ServiceClient) -> int:
    try:
        return sum(ied["link_state"] == "up" for ied in client.items("/ieds", limit="1000"))
    except ServiceError:
        return 0


def _processes(service: Service) -> list[int]:
    return [service.process_id, *descendants(service.process_id)]


def _gateways(service: Service) -> str:
    """What the gateway processes take, in words."""
    gateways = [
        process_id
        for process_id in _processes(service)
        if b"service.collector" in Path(f"/proc/{process_id}/cmdline").read_bytes()
    ]
    memory, spent_s = sum(map(resident_mb, gateways)), sum(map(cpu_s, gateways))
    return f"{len(gateways)} gateways of {memory:.0f} MB in all, {spent_s:.1f} s of CPU"


def _cpu_s(service: Service) -> float:
    return sum(cpu_s(process_id) for process_id in _processes(service))


def _seconds(time_text: object) -> float:
    """UNIX time of an RFC 3339 time; long ago where there is none."""
    if not isinstance(time_text, str):
        return 0.0
    whole, _, fraction = time_text.rstrip("Z").partition(".")
    return datetime.fromisoformat(whole).replace(tzinfo=UTC).timestamp() + float(f"0.{fraction or 0}")


def _files(directory: Path, relays: int) -> tuple[Path, Path, list[Path]]:
    """The SCD with a motor for each relay, the motors file, and an SCD for each process of the simulator."""
    scd, motors = directory / "plant.scd", directory / "motors.toml"
    ports = free_ports(relays)
    plant_of(ports, scd)
    parts = []
    for first in range(0, relays, RELAYS_A_PROCESS):
        parts.append(directory / f"relays-{first}.scd")
        plant_of(ports[first : first + RELAYS_A_PROCESS], parts[-1], first=first + 1)
    plant = Document(scd)
    substation = plant.add(plant.root, "Substation", name="SCALE")
    plant.root.insert(1, substation)  # behind the header
    level = plant.add(substation, "VoltageLevel", name="LV")
    plant.add(level, "Voltage", unit="V").text = "400"
    table = "[[motor]]" + MOTORS.read_text(encoding="utf-8").split("[[motor]]")[1]
    tables = []
    for ied in plant.children(plant.root, "IED"):
        name = str(ied.get("name"))
        motor = plant.add(
            plant.add(level, "Bay", name=name), "ConductingEquipment", name=f"M-{name}", type="MOT"
        )
        plant.add(motor, "LNode", iedName=name, ldInst="MET", prefix="MET", lnClass="MMXU", lnInst="1")
        tables.append(table.replace('name = "PUMP-A1"', f'name = "M-{name}"'))
    etree.indent(plant.root)
    write(plant, scd)
    motors.write_text("\n".join(tables), encoding="utf-8")
    return scd, motors, parts


@contextmanager
def _simulated(scd: Path, directory: Path) -> Iterator[int]:
    """A process of relays; its id."""
    command = [sys.executable, "-m", "ied_sim", "--scd", str(scd), "--files", str(directory / "relays")]
    with (
        (directory / f"{scd.stem}.log").open("w") as log,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True) as process,
    ):
        try:
            assert process.stdout is not None
            if not any(line.strip() == "ready" for line in process.stdout):
                raise RuntimeError((directory / f"{scd.stem}.log").read_text())
            yield process.pid
        finally:
            process.terminate()
            process.wait(30)


@contextmanager
def _integrations(directory: Path) -> Iterator[Mapping[str, object]]:
    """The table of gateways to other systems, and the broker that one of them needs."""
    iec104, iec61850, modbus, opcua = free_ports(4)
    with running_mosquitto(directory) as broker:
        yield {
            "iec104": {"port": iec104},
            "iec61850": {"port": iec61850},
            "modbus": {"port": modbus},
            "mqtt": {"port": broker.port, "sparkplug": {}},
            "opcua": {"port": opcua},
        }


@contextmanager
def _served(directory: Path, scd: Path, motors: Path, own: Mapping[str, str]) -> Iterator[Service]:
    settings = {"MCC_MOTORS": str(motors), "MCC_POLL_PERIOD_S": str(POLL_PERIOD_S), **own}
    processes.START_LIMIT_S = START_LIMIT_S
    with processes.running_service(directory, scd, **settings) as service:
        yield service


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.collector.scale", description=__doc__)
    parser.add_argument("--relays", type=int, default=200)
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--period-minutes", type=float, default=5.0)
    parser.add_argument("--relays-per-gateway", type=int, help="the setting; its default where left out")
    parser.add_argument("--triggered", type=int, help="so many relays are triggered; all where left out")
    parser.add_argument("--integrations", action="store_true", help="gateways to other systems run beside it")
    arguments = parser.parse_args()
    exit_when_terminated()
    seen = Seen()
    lines = measure(
        seen,
        arguments.relays,
        arguments.minutes,
        arguments.period_minutes,
        arguments.relays_per_gateway,
        arguments.triggered,
        with_integrations=arguments.integrations,
    )
    for line in lines:
        print(line, flush=True)
    broken = broken_limits(seen, arguments.minutes, arguments.period_minutes)
    for line in broken:
        print(f"limit broken: {line}", flush=True)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
