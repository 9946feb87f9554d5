"""One relay of any profile in a simulator of its own, with its client."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from core.recordings import Recording, read
from ied_sim.errors import SimulatorError
from ied_sim.misbehaviour import Misbehaviour
from ied_sim.profiles.standalone import standalone
from ied_sim.relay.configuration import RelayConfiguration
from ied_sim.relay.event_recorder import RecorderSettings
from ied_sim.relay.relay import Relay
from ied_sim.scenario.scenario import healthy_reference
from ied_sim.simulator import Simulator
from mms import Client
from scl import Address, Scl
from testing.ports import LOOPBACK, free_port

IED = "R1"
SHORT = RecorderSettings(sample_rate_hz=1_600.0, pre_trigger_s=0.04, post_trigger_s=0.08, capacity=3)


@dataclass(frozen=True, slots=True)
class Simulated:
    """A relay being served, and how to reach it."""

    document: Scl
    simulator: Simulator

    @property
    def relay(self) -> Relay:
        return self.simulator.relays[IED]

    @property
    def address(self) -> Address:
        return self.simulator.addresses[IED]

    def client(self, request_timeout_s: float = 10.0) -> Client:
        return Client.connect(
            self.address.host, self.address.port, connect_timeout_s=10.0, request_timeout_s=request_timeout_s
        )

    def reference(self, inst_reference: str) -> str:
        return f"{IED}{inst_reference}"


@contextmanager
def simulated(files: Path, scenario: RelayConfiguration) -> Iterator[Simulated]:
    """R1 of the scenario's profile on a free port; another one where somebody was faster."""
    for _ in range(5):
        document = standalone(scenario.profile, IED, Address(LOOPBACK, free_port()))
        simulator = Simulator(document, {IED: scenario}, files=files)
        try:
            simulator.start()
        except SimulatorError:
            simulator.stop()
            continue
        try:
            yield Simulated(document, simulator)
        finally:
            simulator.stop()
        return
    raise AssertionError("no free port")


def scenario_of(
    profile: str, *misbehaviour: Misbehaviour, recorder: RecorderSettings = SHORT
) -> RelayConfiguration:
    """A healthy motor behind a relay of this kind, with short records."""
    return replace(healthy_reference(IED, profile), recorder=recorder, misbehaviour=misbehaviour)


def names(client: Client, folder: str) -> list[str]:
    return sorted(entry.name for entry in client.files(folder))


def fetch(client: Client, folder: str, directory: Path) -> list[Path]:
    """Every file of a folder, under the last part of its name."""
    directory.mkdir(parents=True, exist_ok=True)
    fetched = []
    for entry in client.files(folder):
        content = io.BytesIO()
        client.download(entry.name, content, expected_size=entry.size)
        path = directory / entry.name.replace("\\", "/").rpartition("/")[2]
        path.write_bytes(content.getvalue())
        fetched.append(path)
    return sorted(fetched)


def text(client: Client, name: str) -> str:
    content = io.BytesIO()
    client.download(name, content)
    return content.getvalue().decode("ascii")


def recordings(paths: list[Path]) -> list[Recording]:
    return [read(path) for path in paths if path.suffix in (".CFG", ".CFF", ".CEV")]
