"""python -m benchmarks.gateways.goose: 500 relays tell their state by GOOSE, and one trips each second.

It runs in a network namespace of its own, with a pair of Ethernet interfaces (unshare, iproute2). The frames
are those of simulated relays; tests/mms/goose tries such frames with another stack.
"""

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import scl
from benchmarks.gateways.load import argument_parser, measure
from benchmarks.simulator.plant import plant_of
from ied_sim.relay.goose import GooseOutlet, Held, RelayGoose
from mms import Timestamp
from mms.goose import PublisherThread, RawSocket
from scl.ied_model import Ied
from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import read_plant
from service.storage import Repository, connect
from testing.service.database import make_database
from testing.service.gateways import running_gateways
from testing.waiting import wait_until

INSIDE = "STATORWATCH_BENCHMARK_INSIDE"
NAMESPACE = ("unshare", "--user", "--map-root-user", "--net")
IP = "/sbin/ip"
FIRST_PORT = 10_000


class TrippingPlant:
    """Simulated relays that tell their state, of which one trips or is reset."""

    def __init__(self, relays: Mapping[str, Ied], sender: RawSocket) -> None:
        """relays: by motor."""
        self.motors = tuple(relays)
        self._thread = PublisherThread(sender.send)
        outlet = GooseOutlet(self._thread, sender.address)
        self._relays = {motor: RelayGoose(ied, outlet, {}, time.time_ns()) for motor, ied in relays.items()}
        self._trips = {motor: _trip_of(ied) for motor, ied in relays.items()}

    def start(self) -> None:
        """Begin to tell."""
        self._thread.start()

    def stop(self) -> None:
        """Tell nothing more."""
        self._thread.stop()

    def change(self, name: str, number: int) -> None:
        """Let a relay trip and be reset in turns."""
        now_ns = time.time_ns()
        trip = self._trips[name]
        changes: dict[str, Held] = {f"{trip}.general": number % 2 == 0, f"{trip}.t": Timestamp(now_ns)}
        self._relays[name].update(changes, now_ns)


def _trip_of(ied: Ied) -> str:
    (placed,) = ied.data_objects(ln_class="PTRC", name="Tr")
    return placed.reference


def main() -> None:
    """Print the figures."""
    wanted = argument_parser(__doc__).parse_args()
    if INSIDE not in os.environ:
        command = [*NAMESPACE, sys.executable, "-m", "benchmarks.gateways.goose", *sys.argv[1:]]
        sys.exit(subprocess.run(command, env={**os.environ, INSIDE: "1"}, check=False).returncode)
    for words in ("link add left type veth peer name right", "link set left up", "link set right up"):
        subprocess.run([IP, *words.split()], check=True)
    with TemporaryDirectory(prefix="statorwatch-") as directory, RawSocket("left") as sender:
        _measure(Path(directory), sender, wanted)


def _measure(directory: Path, sender: RawSocket, wanted: argparse.Namespace) -> None:
    file, motors = directory / "plant.scd", directory / "motors.toml"
    plant_of(range(FIRST_PORT, FIRST_PORT + wanted.motors), file)
    document = scl.read(file)
    table = "[[motor]]" + MOTORS.read_text(encoding="utf-8").split("[[motor]]")[1]
    motors.write_text(
        "\n".join(
            table.replace('name = "PUMP-A1"', f'name = "M-{ied.name}"\nrelay = "{ied.name}"')
            for ied in document.ieds
        ),
        encoding="utf-8",
    )
    goose = GatewaysSettings(goose=GooseSettings(interface="right"))
    settings = Settings(data_directory=directory, scd=file, motors=motors, gateways=goose)
    repository = Repository(connect(make_database(directory)))
    repository.sync_plant(read_plant(settings))
    plant = TrippingPlant({f"M-{ied.name}": ied for ied in document.ieds}, sender)
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
