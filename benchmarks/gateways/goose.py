"""python -m benchmarks.gateways.goose: 500 relays tell their state by GOOSE, and one trips each second.

It runs in a network namespace of its own, with a pair of Ethernet interfaces (unshare, iproute2). The frames
are sent by the project's publisher; tests/mms/goose tries such frames with another stack.
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.gateways.load import measure
from benchmarks.simulator.plant import plant_of
from mms import Quality, Timestamp, Value
from mms.goose import PublishedBlock, Publisher, PublisherThread, RawSocket
from scl.goose_blocks import GooseBlock, goose_blocks
from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import read_plant
from service.storage import Repository, connect
from testing.relays.goose import with_goose
from testing.service.database import make_database
from testing.service.gateways import running_gateways
from testing.waiting import wait_until

INSIDE = "STATORWATCH_BENCHMARK_INSIDE"
NAMESPACE = ("unshare", "--user", "--map-root-user", "--net")
IP = "/sbin/ip"
FIRST_PORT = 10_000
SECOND_MS = 1000


class TrippingPlant:
    """Relays that tell their state, of which one trips or is reset."""

    def __init__(self, blocks: dict[str, GooseBlock], sender: RawSocket) -> None:
        """blocks: by motor."""
        self.motors = tuple(blocks)
        self._thread = PublisherThread(sender.send)
        self._members = {motor: len(block.members) for motor, block in blocks.items()}
        self._publishers = {
            motor: Publisher(
                _published(block), sender.address, self._values(motor, trip=False), time.time_ns()
            )
            for motor, block in blocks.items()
        }

    def start(self) -> None:
        """Begin to tell."""
        for publisher in self._publishers.values():
            self._thread.add(publisher)
        self._thread.start()

    def stop(self) -> None:
        """Tell nothing more."""
        self._thread.stop()

    def change(self, name: str, number: int) -> None:
        """Let a relay trip and be reset in turns."""
        now_ns = time.time_ns()
        self._thread.change(self._publishers[name], self._values(name, trip=number % 2 == 0), now_ns)

    def _values(self, motor: str, *, trip: bool) -> tuple[Value, ...]:
        stamp = (Quality().bits, Timestamp(time.time_ns()))
        return ((trip, *stamp), *((False, *stamp),) * (self._members[motor] - 1))


def _published(block: GooseBlock) -> PublishedBlock:
    address = block.control.address
    assert address is not None
    return PublishedBlock(
        reference=block.reference,
        data_set=block.data_set,
        goose_id=block.control.application_id,
        configuration_revision=block.control.configuration_revision,
        destination=address.mac,
        application_id=address.application_id,
        maximum_time_ms=SECOND_MS,
    )


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--motors", type=int, default=500)
    parser.add_argument("--changes", type=int, default=60)
    parser.add_argument("--idle-s", type=float, default=60.0)
    wanted = parser.parse_args()
    if INSIDE not in os.environ:
        command = [*NAMESPACE, sys.executable, "-m", "benchmarks.gateways.goose", *sys.argv[1:]]
        sys.exit(subprocess.run(command, env={**os.environ, INSIDE: "1"}, check=False).returncode)
    for words in ("link add left type veth peer name right", "link set left up", "link set right up"):
        subprocess.run([IP, *words.split()], check=True)
    with TemporaryDirectory(prefix="statorwatch-") as directory, RawSocket("left") as sender:
        _measure(Path(directory), sender, wanted)


def _measure(directory: Path, sender: RawSocket, wanted: argparse.Namespace) -> None:
    plain, sent, motors = (directory / name for name in ("plain.scd", "plant.scd", "motors.toml"))
    plant_of(range(FIRST_PORT, FIRST_PORT + wanted.motors), plain)
    document = with_goose(plain, sent)
    table = "[[motor]]" + MOTORS.read_text(encoding="utf-8").split("[[motor]]")[1]
    motors.write_text(
        "\n".join(
            table.replace('name = "PUMP-A1"', f'name = "M-{ied.name}"\nrelay = "{ied.name}"')
            for ied in document.ieds
        ),
        encoding="utf-8",
    )
    goose = GatewaysSettings(goose=GooseSettings(interface="right"))
    settings = Settings(data_directory=directory, scd=sent, motors=motors, gateways=goose)
    repository = Repository(connect(make_database(directory)))
    repository.sync_plant(read_plant(settings))
    plant = TrippingPlant({f"M-{ied.name}": goose_blocks(ied)[0] for ied in document.ieds}, sender)
    plant.start()

    def wait_for(motor: str, *, is_faulty: bool) -> None:
        wait_until(lambda: _is_tripped(repository, motor) is is_faulty, f"the alarm of {motor}")

    with running_gateways(settings) as gateways:
        (status,) = gateways.status()
        assert status.process_id is not None
        load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
    plant.stop()
    print(f"{wanted.motors} relays, a message a second each: {load}")


def _is_tripped(repository: Repository, motor: str) -> bool:
    found = repository.open_alarms(limit=10, motor=motor).items
    return any(one.kind is AlarmKind.MOTOR_TRIPPED and one.cleared_ns is None for one in found)


if __name__ == "__main__":
    main()
