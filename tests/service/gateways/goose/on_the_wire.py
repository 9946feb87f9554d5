"""What programs in a network namespace of their own ask of the gateway there, and of the interfaces."""

import subprocess
from pathlib import Path

import scl
from scl import Address
from service.alarms.kinds import AlarmKind
from service.gateways.supervision import PlantGateways, PlantGatewayStatus
from service.storage import Repository
from service.storage.records import Alarm
from testing.ports import LOOPBACK, free_port
from testing.waiting import wait_until


def ip(words: str) -> None:
    """Run iproute2."""
    subprocess.run(["ip", *words.split()], check=True)


def make_interfaces() -> None:
    """Make a pair of Ethernet interfaces, `left` and `right`."""
    for words in ("link set lo up", "link add left type veth peer name right"):
        ip(words)
    for name in ("left", "right"):
        ip(f"link set {name} up")


def plant_here(file: Path) -> scl.Scl:
    """Write the demo plant's SCD with addresses of this network."""
    names = [ied.name for ied in scl.read(scl.DEMO_PLANT_SCD).ieds]
    scl.with_addresses(scl.DEMO_PLANT_SCD, file, {name: Address(LOOPBACK, free_port()) for name in names})
    return scl.read(file)


def all_frames_are_read() -> bool:
    """Tell whether no frame waits in a socket of this network that hears GOOSE."""
    return not any(int(waiting) for protocol, waiting in _sockets() if protocol == "88b8")


def is_captured() -> bool:
    """Tell whether somebody captures all frames of this network."""
    return any(protocol == "0003" for protocol, _ in _sockets())


def _sockets() -> list[tuple[str, str]]:
    """Return protocol and waiting octets of each packet socket."""
    rows = [line.split() for line in Path("/proc/net/packet").read_text().splitlines()[1:]]
    return [(row[3], row[6]) for row in rows]


def goose(gateways: PlantGateways) -> PlantGatewayStatus:
    """Return the GOOSE gateway's status."""
    return next(one for one in gateways.status() if one.kind == "goose")


def problem(gateways: PlantGateways, words: str) -> str:
    """Wait for a problem with these words."""
    wait_until(lambda: words in (goose(gateways).problem or ""), words)
    return goose(gateways).problem or ""


def alarms(repository: Repository) -> list[Alarm]:
    """Return the standing alarms of trips."""
    return [one for one in trip_alarms(repository) if one.cleared_ns is None]


def trip_alarms(repository: Repository) -> list[Alarm]:
    """Return the open alarms of trips, also of those that have fallen."""
    return [one for one in repository.open_alarms(limit=50).items if one.kind is AlarmKind.MOTOR_TRIPPED]


def tripped(repository: Repository) -> list[str | None]:
    """Return the motors whose relays have tripped."""
    return [alarm.motor for alarm in alarms(repository)]
