"""The plant of a run: relays of all kinds with the demo's motors behind them, written as files.

Two SCD files of the same relays: the simulator listens where one says, the service connects where the other
does, and between the two stands the proxy.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

import scl
from ied_sim.profiles.profile import Profile, read_profile
from scl import Address
from scl.document import Document
from scl.instantiation import rename_ied, set_address, write
from service.demo import MOTORS, SCENARIO
from service.demo.addresses import LOOPBACK, free_ports

_ED2, _ED1 = "sel-710-ed2", "sel-710-ed1"
MIX = (_ED2, _ED1, "rdre", _ED2, _ED1, "rdre-readonly", _ED2, "files-none")
"""Kinds of relays, one after the other: all there are."""

RECORDER = """
[motor.recorder]
sample_rate_Hz = 1600
pre_trigger_s = 0.1
post_trigger_s = 0.2
capacity = 5000
"""
"""Short records, for many of them, and room for all: what a relay discards itself is nobody's loss."""

SWITCHED = {
    "relay-clock-jump": ("clock-offset", "offset_s = -86400.0", 27),
    "relay-off": ("restart", "for_s = 3.0", 28),
    "file-grows": ("growing-file", "grow_s = 2.0", 29),
    "reports-overflow": ("buffer-overflow", "", 30),
    "trigger-refused": ("refused-control", "", 31),
}
"""Faults a relay makes itself: its misbehaviour, with its number, and the remote bit that switches it."""

SWITCHABLE_EVERY = 4
"""One relay of so many, where it has remote bits, can misbehave by itself: it costs more to simulate."""

_TYPED = ("LN", "LN0", "DO", "SDO", "DA", "BDA")


@dataclass(frozen=True, slots=True)
class ChaosRelay:
    """One relay of the plant: `own` is where it listens, `seen` where the service finds it (the proxy)."""

    name: str
    motor: str
    profile: Profile
    own: Address
    seen: Address
    switchable: bool

    @property
    def triggers(self) -> tuple[str, ...]:
        """Controls whose rise makes a record, in turn: the relay's trigger, or a stop and a start."""
        points = self.profile.points
        given = points.trigger[:1] or (points.stop, points.start)
        return tuple(f"{self.name}{reference}" for reference in given if reference is not None)

    def switch(self, fault: str) -> str:
        """The control that switches one of SWITCHED."""
        return f"{self.name}CON/RBGGIO1.SPCSO{SWITCHED[fault][2]:02d}"

    def folder(self, files: Path) -> Path | None:
        """Where its records are, of the simulator's files; None where it offers none."""
        offered = self.profile.files
        return None if offered is None else files / self.name / offered.folder


@dataclass(frozen=True, slots=True)
class ChaosPlant:
    """The relays and the files that describe them."""

    relays: tuple[ChaosRelay, ...]
    simulator_scd: Path
    service_scd: Path
    scenario: Path
    motors: Path

    def relay(self, name: str) -> ChaosRelay:
        return next(relay for relay in self.relays if relay.name == name)


def make_plant(directory: Path, number: int) -> ChaosPlant:
    """A plant of so many relays, its files in `directory`."""
    ports = free_ports(2 * number)
    relays = tuple(_relay(k, ports[2 * k], ports[2 * k + 1]) for k in range(number))
    plant = ChaosPlant(
        relays,
        directory / "simulator.scd",
        directory / "service.scd",
        directory / "scenario.toml",
        directory / "motors.toml",
    )
    _write_scd(plant.simulator_scd, relays, {relay.name: relay.own for relay in relays})
    _write_scd(plant.service_scd, relays, {relay.name: relay.seen for relay in relays})
    plant.scenario.write_text("\n".join(_scenarios(relays)), encoding="utf-8")
    plant.motors.write_text("\n".join(_motors(relays)), encoding="utf-8")
    return plant


def _relay(number: int, own_port: int, seen_port: int) -> ChaosRelay:
    profile = read_profile(MIX[number % len(MIX)])
    remote_bits = any("RBGGIO" in reference for reference in profile.points.trigger)
    return ChaosRelay(
        name=f"R{number + 1:02d}",
        motor=f"MOTOR-{number + 1:02d}",
        profile=profile,
        own=Address(LOOPBACK, own_port),
        seen=Address(LOOPBACK, seen_port),
        switchable=remote_bits and profile.files is not None and number % SWITCHABLE_EVERY == 0,
    )


def _scenarios(relays: Sequence[ChaosRelay]) -> Iterator[str]:
    """Each relay with one of the demo's motors behind it."""
    demo = _tables(SCENARIO)
    for number, relay in enumerate(relays):
        kind = f'ied = "{relay.name}"\nprofile = "{relay.profile.name}"'
        table = re.sub(r'^ied = ".*"$', kind, demo[number % len(demo)], count=1, flags=re.MULTILINE)
        # A load and a frequency that never stand still cost more to simulate than all else of a relay.
        table = re.sub(r"^(swing|frequency_drift_Hz) = .*$", r"\1 = 0", table, flags=re.MULTILINE)
        yield table + RECORDER
        if relay.switchable:
            for fault, (misbehaviour, figure, _) in SWITCHED.items():
                switch = relay.switch(fault).removeprefix(relay.name)
                yield f'[[motor.misbehaviour]]\nkind = "{misbehaviour}"\nswitch = "{switch}"\n{figure}\n'


def _motors(relays: Sequence[ChaosRelay]) -> Iterator[str]:
    demo = _tables(MOTORS)
    for number, relay in enumerate(relays):
        name = f'name = "{relay.motor}"'
        yield re.sub(r'^name = ".*"$', name, demo[number % len(demo)], count=1, flags=re.MULTILINE)


def _tables(path: Path) -> list[str]:
    """The [[motor]] tables of one of the demo's files, as text."""
    return ["[[motor]]" + text for text in path.read_text(encoding="utf-8").split("[[motor]]")[1:]]


def _write_scd(path: Path, relays: Sequence[ChaosRelay], addresses: Mapping[str, Address]) -> None:
    """One substation, one subnetwork, the relays' IEDs, and the data types of their kinds."""
    plant = Document(scl.SEL710_ICD)
    for element in list(plant.root)[1:]:
        plant.root.remove(element)
    level = plant.add(plant.add(plant.root, "Substation", name="CHAOS"), "VoltageLevel", name="LV")
    plant.add(level, "Voltage", unit="V").text = "400"
    subnetwork = plant.add(plant.add(plant.root, "Communication"), "SubNetwork", name="S", type="8-MMS")
    types: dict[str, etree._Element] = {}
    for relay in relays:
        document = _own_types(Document(relay.profile.icd_path), relay.profile.name)
        rename_ied(document, relay.name)
        set_address(document, relay.name, addresses[relay.name])
        bay = plant.add(level, "Bay", name=relay.name)
        motor = plant.add(bay, "ConductingEquipment", name=relay.motor, type="MOT")
        metering = relay.profile.points.metering or ""
        device, _, _ = metering.partition("/")
        plant.add(motor, "LNode", iedName=relay.name, ldInst=device, prefix="MET", lnClass="MMXU", lnInst="1")
        subnetwork.append(next(document.descendants(document.root, "ConnectedAP")))
        plant.root.append(next(document.children(document.root, "IED")))
        types.setdefault(relay.profile.name, next(document.children(document.root, "DataTypeTemplates")))
    merged = plant.add(plant.root, "DataTypeTemplates")
    for kind in ("LNodeType", "DOType", "DAType", "EnumType"):
        for templates in types.values():
            merged.extend(list(plant.children(templates, kind)))
    etree.indent(plant.root)
    write(plant, path)


def _own_types(document: Document, kind: str) -> Document:
    """The data types of one kind of relay under names of their own: kinds share a file, not their types."""
    for templates in document.children(document.root, "DataTypeTemplates"):
        for named in templates.iterchildren(etree.Element):
            named.set("id", f"{kind}.{named.get('id')}")
    for tag in _TYPED:
        for element in document.descendants(document.root, tag):
            for attribute in ("lnType", "type"):
                name = element.get(attribute)
                if name is not None:
                    element.set(attribute, f"{kind}.{name}")
    return document
