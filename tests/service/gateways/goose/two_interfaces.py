"""Run by test_goose.py in a network namespace: simulated relays on one interface, the gateway on the other.

It prints what it found as JSON.
"""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import scl
from ied_sim.relay.protection import DefiniteTime, ProtectionSettings
from ied_sim.scenario.scenario import healthy_reference
from ied_sim.simulator import Simulator
from mms import BitString, Timestamp, Value
from mms.goose import PublishedBlock, Publisher, RawSocket
from scl import Address
from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings, GooseTrigger
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings, sqlite_url
from service.gateways.supervision import PlantGateways
from service.plant import read_plant
from service.storage import Repository, connect
from service.storage.records import Alarm, RecordingRequest
from testing.ports import LOOPBACK, free_port
from testing.relays.goose import APPLICATION_ID, BLOCK, DATA_SET, REVISION, with_goose
from testing.service.database import make_database
from testing.service.gateways import started_gateways
from testing.waiting import wait_until
from tests.service.gateways.goose.plant import MOTORS

TRIP = "A1_SEL710PRO/TRIPPTRC1.Tr.general"
TRIPS_AFTER_S = 2.0
MEMBERS = 9
SEEN_S = 0.7
"""Long enough for the gateway to do what it must not do."""
GOOD, BAD = BitString((False,) * 13), BitString((False, True, *(False,) * 11))


def main(directory: Path) -> None:
    """Let a relay trip, kill the gateway, and let another sender tell lies."""
    for words in ("lo up", "left up", "right up"):
        if words == "left up":
            _ip("link add left type veth peer name right")
        _ip(f"link set {words}")
    plain, sent = directory / "plain.scd", directory / "plant.scd"
    names = [ied.name for ied in scl.read(scl.DEMO_PLANT_SCD).ieds]
    scl.with_addresses(scl.DEMO_PLANT_SCD, plain, {name: Address(LOOPBACK, free_port()) for name in names})
    document = with_goose(plain, sent)
    goose = GooseSettings(interface="right", triggers=(GooseTrigger(signal=TRIP, motors=("FAN-A2",)),))
    settings = Settings(
        data_directory=directory, scd=sent, motors=MOTORS, gateways=GatewaysSettings(goose=goose)
    )
    make_database(directory)
    repository = Repository(connect(sqlite_url(directory)))
    repository.sync_plant(read_plant(settings))
    trips = replace(
        healthy_reference("A1_SEL710"),
        protection=ProtectionSettings(overcurrent=DefiniteTime(0.2, TRIPS_AFTER_S)),
    )
    found: dict[str, object] = {}
    relays = Simulator(document, {"A1_SEL710": trips}, files=directory / "relays", goose_interface="left")
    with started_gateways(settings) as gateways:
        # It listens before anybody tells: what a trip triggers is over for one that comes later.
        _problem(gateways, "not heard")
        with relays:
            wait_until(lambda: gateways.status()[0].problem is None, "all relays to be heard")
            _trip(gateways, repository, found)
    with started_gateways(settings) as gateways, RawSocket("left") as sender:
        found["silent"] = _problem(gateways, "not heard")
        _lie(sender, repository, found)
    print(json.dumps(found))  # noqa: T201 - the test reads it


def _trip(gateways: PlantGateways, repository: Repository, found: dict[str, object]) -> None:
    """Wait for what a relay's trip does, and kill the gateway."""
    found["capabilities"] = _capabilities(gateways.status()[0].process_id)
    wait_until(lambda: _alarms(repository), "the alarm of the trip")
    wait_until(lambda: _requests(repository), "the request that the trip triggers")
    (alarm,) = _alarms(repository)
    found["alarm"] = [alarm.motor, alarm.priority.value, alarm.reason.split(" since ")[0]]
    found["requests"] = [(one.motor, one.origin.value) for one in _requests(repository)]
    _kill(gateways)
    found["raises after the kill"] = [one.raises for one in _alarms(repository)]
    found["requests after the kill"] = len(_requests(repository))


def _lie(sender: RawSocket, repository: Repository, found: dict[str, object]) -> None:
    """Tell, as the relay, what does not count; then what does: that the trip has fallen."""
    sender.send(bytes.fromhex("010ccd010000") + bytes(6) + b"\x88\xb8" + os.urandom(200))
    for name, revision, quality in (("revision", REVISION + 1, GOOD), ("quality", REVISION, BAD)):
        publisher = _publisher(sender, revision, quality)
        for _ in range(5):
            sender.send(publisher.next_frame(0.0))
        time.sleep(SEEN_S)
        found[f"alarms after a wrong {name}"] = len(_alarms(repository))
    publisher = _publisher(sender, REVISION, GOOD)

    def is_cleared() -> bool:
        sender.send(publisher.next_frame(0.0))
        return not _alarms(repository)

    # A sender that begins anew is one that replays, until it was silent for as long as it promised.
    wait_until(is_cleared, "the alarm to be cleared")
    found["alarms after the truth"] = len(_alarms(repository))


def _publisher(sender: RawSocket, revision: int, quality: BitString) -> Publisher:
    """Return one that tells as A1_SEL710 that nothing has tripped."""
    block = PublishedBlock(
        reference=f"A1_SEL710CFG/LLN0$GO${BLOCK}",
        data_set=f"A1_SEL710CFG/LLN0${DATA_SET}",
        goose_id="A1_SEL710",
        configuration_revision=revision,
        destination=bytes.fromhex("010ccd010000"),
        application_id=APPLICATION_ID,
    )
    member: Value = (False, quality, Timestamp(time.time_ns()))
    return Publisher(block, sender.address, (member,) * MEMBERS, time.time_ns())


def _kill(gateways: PlantGateways) -> None:
    killed = gateways.status()[0].process_id
    assert killed is not None
    os.kill(killed, signal.SIGKILL)
    wait_until(
        lambda: (
            gateways.status()[0].process_id not in (None, killed) and gateways.status()[0].problem is None
        ),
        "the gateway to be back",
    )


def _problem(gateways: PlantGateways, words: str) -> str:
    wait_until(lambda: words in (gateways.status()[0].problem or ""), words)
    return gateways.status()[0].problem or ""


def _alarms(repository: Repository) -> list[Alarm]:
    items = repository.open_alarms(limit=50).items
    return [one for one in items if one.kind is AlarmKind.MOTOR_TRIPPED and one.cleared_ns is None]


def _requests(repository: Repository) -> list[RecordingRequest]:
    return list(repository.recording_requests(limit=10).items)


def _capabilities(process: int | None) -> str:
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return next(line.split()[1] for line in lines if line.startswith("CapEff"))


def _ip(words: str) -> None:
    subprocess.run(["ip", *words.split()], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
