"""Run by test_peers.py in a network namespace: open61850 and tshark, which are not ours, on interfaces there.

It prints what it found as JSON.
"""

import json
import subprocess
import sys
import time
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from open61850 import data as peer_data
from open61850 import goose as peer

from ied_sim.relay.protection import DefiniteTime, ProtectionSettings
from ied_sim.scenario.scenario import healthy_reference
from ied_sim.simulator import Simulator
from mms.goose import RawSocket
from scl.goose_blocks import GooseBlock, goose_blocks
from service.configuration.gateways.goose import GooseSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.plant import read_plant
from service.storage import Repository, connect
from testing.service.database import make_database
from testing.service.gateways import started_gateways
from testing.waiting import wait_until
from tests.service.gateways.goose.on_the_wire import (
    all_frames_are_read,
    is_captured,
    make_interfaces,
    plant_here,
    problem,
    trip_alarms,
    tripped,
)
from tests.service.gateways.goose.plant import MOTORS

PRIORITY = 4
FAR = 10**9
LONG_MS = 600_000
TOGGLES = 600
EVERY_S = 0.25
"""Between messages of the publisher while it waits to be believed."""
TRIPS_AFTER_S = 1.0
FIELDS = (
    "vlan.priority",
    "vlan.id",
    "goose.gocbRef",
    "goose.stNum",
    "goose.sqNum",
    "goose.boolean",
    "goose.bit_string",
)


def main(what: str, directory: Path) -> None:
    """Let open61850 publish, or tshark capture."""
    make_interfaces()
    found = _published(directory) if what == "published" else _captured(directory)
    print(json.dumps(found))  # noqa: T201 - the test reads it


class Peer:
    """Publishes a control block with open61850, under a tag with the priority alone."""

    def __init__(self, sender: RawSocket, block: GooseBlock) -> None:
        self._sender, self._block = sender, block
        self._state, self._sequence, self._trip = 1, 0, False

    def turns(self, *, trip: bool) -> None:
        """Begin another state, and send it once."""
        self._state, self._sequence, self._trip = self._state + 1, 0, trip
        self.tells()

    def tells(self) -> bool:
        """Send its state once more."""
        self._send(self._state, self._sequence, 2000)
        self._sequence += 1
        return True

    def forge(self) -> None:
        """Send what somebody else makes up: a state far ahead, without the trip, for ten minutes."""
        trip, self._trip = self._trip, False
        self._send(self._state + FAR, 0, LONG_MS)
        self._trip = trip

    def _send(self, state: int, sequence: int, lives_ms: int) -> None:
        control, address, now = self._block.control, self._block.control.address, datetime.now(UTC)
        assert address is not None
        member = peer_data.StructureData(
            [
                peer_data.BoolData(value=self._trip),
                peer_data.BitStringData(bytes(2), 3),
                peer_data.TimestampData(now),
            ]
        )
        pdu = peer.GoosePDU(
            gocb_ref=self._block.reference,
            time_allowed_to_live=lives_ms,
            dat_set=self._block.data_set,
            go_id=control.application_id,
            timestamp=now,
            st_num=state,
            sq_num=sequence,
            simulation=False,
            conf_rev=control.configuration_revision,
            nds_com=False,
            num_dat_set_entries=len(self._block.members),
            all_data=[member] * len(self._block.members),
        )
        octets = peer.encode_goose_frame(
            pdu,
            dst_mac=address.mac.hex(":"),
            src_mac=self._sender.address.hex(":"),
            app_id=address.application_id,
            vlan_id=0,
            vlan_priority=PRIORITY,
        )
        assert octets[12:16] == bytes.fromhex("81008000")
        self._sender.send(octets)


def _published(directory: Path) -> dict[str, object]:
    """Trip as a relay of another make; forge a state, and trip again; then toggle as fast as it is heard."""
    file = directory / "plant.scd"
    (block,) = goose_blocks(plant_here(file).ied("A1_SEL710"))
    settings = Settings(
        data_directory=directory,
        scd=file,
        motors=MOTORS,
        gateways=GatewaysSettings(goose=GooseSettings(interface="right")),
    )
    repository = Repository(connect(make_database(directory)))
    repository.sync_plant(read_plant(settings))
    found: dict[str, object] = {}
    with started_gateways(settings) as gateways, RawSocket("left") as sender:
        relay = Peer(sender, block)
        problem(gateways, "6 of 6")
        wait_until(lambda: relay.tells() and "5 of 6" in problem(gateways, "not heard"), "it to be heard")
        relay.turns(trip=True)
        wait_until(lambda: tripped(repository), "the alarm")
        found["the peer's trip"] = tripped(repository)
        relay.turns(trip=False)
        wait_until(lambda: not tripped(repository), "its end")

        relay.forge()
        began_s = time.monotonic()
        relay.turns(trip=True)
        told: list[str] = []

        def is_told() -> bool:
            relay.tells()
            told.append(problem(gateways, "not heard"))
            return bool(tripped(repository))

        while not is_told():
            time.sleep(EVERY_S)
        found["told after the forged state [s]"] = time.monotonic() - began_s
        found["named meanwhile"] = [one for one in told if "two states at once" in one][:1]

        raises = trip_alarms(repository)[0].raises
        for number in range(TOGGLES):
            relay.turns(trip=number % 2 == 1)
            wait_until(all_frames_are_read, "the gateway to have it")
        relay.turns(trip=False)
        found["it toggles"] = problem(gateways, "change too often").split("; ")[-1]
        wait_until(lambda: not tripped(repository), "the end of the last trip")
        found["raised"] = trip_alarms(repository)[0].raises - raises
        found["toggled for [s]"] = time.monotonic() - began_s
    return found


def _captured(directory: Path) -> dict[str, object]:
    """Return what tshark makes of a simulated relay before it trips and when it does: each of the fields."""
    document = plant_here(directory / "plant.scd")
    trips = replace(
        healthy_reference("A1_SEL710"),
        protection=ProtectionSettings(overcurrent=DefiniteTime(0.2, TRIPS_AFTER_S)),
    )
    shown = [word for field in FIELDS for word in ("-e", field)]
    words = ["tshark", "-n", "-l", "-i", "right", "-Y", "goose", "-T", "fields", "-E", "separator=|", *shown]
    output = directory / "captured.txt"
    with output.open("wb") as file, subprocess.Popen(words, stdout=file, stderr=subprocess.PIPE) as tshark:
        try:
            wait_until(is_captured, "tshark to capture")
            with Simulator(
                document, {"A1_SEL710": trips}, files=directory / "relays", goose_interface="left"
            ):
                wait_until(lambda: any("1" in one[5].split(",") for one in _told(output)), "the trip")
        finally:
            tshark.terminate()
    first = [one for one in _told(output) if one[4] == "0"]
    return {"before": first[0], "trip": next(one for one in first if "1" in one[5].split(","))}


def _told(output: Path) -> list[list[str]]:
    """Return what was captured of the relay that trips."""
    lines = output.read_text(encoding="utf-8").split("\n")[:-1]
    told = [line.split("|") for line in lines]
    return [one for one in told if one[2].startswith("A1_")]


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
