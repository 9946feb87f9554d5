"""The part of the cases that goes through a running service: real supervisor, real gateway, real API."""

import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import scl
from scl import Address
from service.client.rest_client import ServiceClient, ServiceError
from testing.ports import LOOPBACK
from testing.service import processes
from testing.service.processes import (
    RELAYS,
    Service,
    all_recordings,
    descendants,
    running_service,
    simulated_plant,
)
from testing.waiting import eventually
from tests.hostile.bulk import resident_MB
from tests.hostile.dialogue import Dialogue
from tests.hostile.relay import HostileRelay, serving
from tests.hostile.surroundings import Snapshot, strangers

GOOD, BAD = RELAYS[1:3], (RELAYS[0], *RELAYS[3:])
HONEST = 0.7
"""Share of good answers: a visit ends at the first bad one."""

GOOD_MOTORS = ("FAN-A2", "MILL-A3")
PROBE_S = 0.25
START_LIMIT_S = 300.0
SLOWEST_ANSWER_S = 5.0
CANARIES = ("x.CFG", "x.DAT", "relays.txt", "HR_10001.CFG")
SETTINGS = {
    "MCC_QUARANTINE_S": "0.5",
    "MCC_POLL_PERIOD_S": "0.5",
    "MCC_REQUEST_TIMEOUT_S": "1",
    "MCC_CONNECT_TIMEOUT_S": "1",
    "MCC_LEASE_S": "15",
    "MCC_RECORD_TIMEOUT_S": "30",
    "MCC_MAX_FILE_BYTES": "1000000",
    "MCC_WORKERS": "1",
}


@dataclass
class ServedOutcome:
    """What was seen of the service while the relay lied. Lists are empty where all was well."""

    cases: int = 0
    probes: int = 0
    failed_probes: list[str] = field(default_factory=list)
    slowest_probe_s: float = 0.0
    quarantines: dict[str, int] = field(default_factory=dict)
    gateways: int = 0
    most_memory_MB: float = 0.0
    unvisited: list[str] = field(default_factory=list)
    never_set_aside: list[str] = field(default_factory=list)
    good_recordings: int = 0
    strangers: list[str] = field(default_factory=list)
    changed_around: list[str] = field(default_factory=list)

    def faults(self, most_memory_MB: float) -> Iterator[str]:
        """What is not as it should be."""
        yield from (f"the API: {failed}" for failed in self.failed_probes)
        yield from (f"in the data directory: {name}" for name in self.strangers)
        yield from (f"around the data directory: {name}" for name in self.changed_around)
        yield from (f"{relay} is good and not visited" for relay in self.unvisited)
        yield from (f"{relay} is hostile and was never set aside" for relay in self.never_set_aside)
        if self.good_recordings < len(GOOD_MOTORS):
            yield f"expected recordings of {len(GOOD_MOTORS)} good relays, found {self.good_recordings}"
        if self.most_memory_MB > most_memory_MB:
            yield f"a gateway took {self.most_memory_MB:.0f} MB"


def run(dialogue: Dialogue, seed: int, directory: Path, *, cases: int, limit_s: float) -> ServedOutcome:
    """Until so many cases have gone through the service, or so much time."""
    outcome = ServedOutcome()
    processes.START_LIMIT_S = START_LIMIT_S
    for name in CANARIES:
        (directory / name).write_text(name)
    with simulated_plant(directory, GOOD) as plant, serving(_relays(dialogue, seed)) as relays:
        scd = directory / "hostile.scd"
        addresses = {name: Address(LOOPBACK, relay.port) for name, relay in relays.items()}
        scl.with_addresses(plant.scd, scd, addresses)
        with running_service(directory, scd, **SETTINGS) as service, ServiceClient(service.url) as client:
            good_are_up = eventually(lambda: all(_link(client, name) == "up" for name in GOOD), 60)
            assert good_are_up, service.log.read_text()[-2000:]
            before = Snapshot.of(directory, without=service.data)
            gateways: set[int] = set()
            deadline_s = time.monotonic() + limit_s
            while outcome.cases < cases and time.monotonic() < deadline_s:
                outcome.cases = sum(relay.cases for relay in relays.values())
                _probe(client, outcome)
                _look(service, outcome, gateways)
                time.sleep(PROBE_S)
            for motor in GOOD_MOTORS:
                client.request_recording(motor)
            eventually(lambda: _good_recordings(client) >= len(GOOD_MOTORS), 60)
            outcome.gateways = len(gateways)
            outcome.quarantines = _quarantines(client)
            outcome.good_recordings = _good_recordings(client)
            outcome.unvisited = [
                name
                for name in GOOD
                if not eventually(lambda name=name: _link(client, name) == "up", 30)  # type: ignore[misc]
            ]
            outcome.never_set_aside = [name for name in BAD if not _was_set_aside(client, name)]
            outcome.strangers = strangers(service.data)
            changed = before.changed(Snapshot.of(directory, without=service.data))
            outcome.changed_around = [
                name for name in changed if not name.startswith(("relays/", "service.log", "ied-sim.log"))
            ]
    return outcome


def _relays(dialogue: Dialogue, seed: int) -> dict[str, HostileRelay]:
    return {name: HostileRelay(dialogue, seed + number, HONEST) for number, name in enumerate(BAD)}


def _probe(client: ServiceClient, outcome: ServedOutcome) -> None:
    """The API answers, and soon."""
    begun_s = time.monotonic()
    outcome.probes += 1
    try:
        client.get(f"/ieds/{BAD[0]}")
    except ServiceError as error:
        outcome.failed_probes.append(str(error))
    taken_s = time.monotonic() - begun_s
    outcome.slowest_probe_s = max(outcome.slowest_probe_s, taken_s)
    if taken_s > SLOWEST_ANSWER_S:
        outcome.failed_probes.append(f"an answer took {taken_s:.1f} s")


def _look(service: Service, outcome: ServedOutcome, gateways: set[int]) -> None:
    """At the processes below the service."""
    for process_id in descendants(service.process_id):
        try:
            command = Path(f"/proc/{process_id}/cmdline").read_bytes()
        except OSError:
            continue
        if b"service.collector" in command:
            gateways.add(process_id)
            outcome.most_memory_MB = max(outcome.most_memory_MB, resident_MB(process_id))


def _quarantines(client: ServiceClient) -> dict[str, int]:
    """How often relays were set aside, by reason without what was answered."""
    reasons: dict[str, int] = {}
    for relay in BAD:
        for change in client.items(f"/ieds/{relay}/link-changes"):
            if change["state"] == "quarantined":
                reason = str(change["reason"]).partition(": ")[2].partition(", at last")[0]
                reasons[reason] = reasons.get(reason, 0) + 1
    return reasons


def _was_set_aside(client: ServiceClient, relay: str) -> bool:
    return any(each["state"] == "quarantined" for each in client.items(f"/ieds/{relay}/link-changes"))


def _link(client: ServiceClient, relay: str) -> str:
    return str(client.get(f"/ieds/{relay}")["link_state"])


def _good_recordings(client: ServiceClient) -> int:
    return sum(
        each["motor"] in GOOD_MOTORS and each["state"] != "announced" for each in all_recordings(client)
    )
