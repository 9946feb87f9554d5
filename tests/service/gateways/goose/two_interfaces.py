"""Run by test_goose.py in a network namespace: simulated relays on one interface, the gateway on the other.

It prints what it found as JSON.
"""

import json
import os
import signal
import sqlite3
import sys
import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from sqlalchemy import make_url

from core.warm_up import warm_up
from ied_sim.relay.protection import DefiniteTime, ProtectionSettings
from ied_sim.scenario.scenario import healthy_reference
from ied_sim.simulator import Simulator
from mms import BitString, Quality, Timestamp, Value
from mms.goose import PublishedBlock, Publisher, RawSocket, decode_frame, encode_frame
from mms.goose.publisher import LIVES
from scl.goose_blocks import GooseBlock, goose_blocks
from service.configuration.gateways.goose import GooseSettings, GooseTrigger
from service.configuration.gateways.modbus import ModbusSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.supervision import PlantGateways
from service.jobs.worker_pool import WorkerPool
from service.plant import read_plant
from service.storage import Repository, connect
from service.storage.records import RecordingRequest
from testing.ports import free_port
from testing.service.database import make_database
from testing.service.gateways import started_gateways
from testing.waiting import wait_until
from tests.service.gateways.goose.on_the_wire import (
    alarms,
    all_frames_are_read,
    goose,
    ip,
    make_interfaces,
    plant_here,
    problem,
    tripped,
)
from tests.service.gateways.goose.plant import MOTORS

TRIP = "A1_SEL710PRO/TRIPPTRC1.Tr.general"
TRIPS_AFTER_S = 2.0
MISSED = 4
"""States of a relay that are left out."""
LONGEST_S = 60.0
GOOD, BAD = BitString((False,) * 13), BitString((False, True, *(False,) * 11))
OF_A_TEST = Quality(test=True).bits
LIVES_SHORT_MS, LIVES_LONG_MS = 500, 60_000
"""How long a message lives: it is waited for the end of the one, and the other does not end in the test."""


def main(directory: Path) -> None:
    """Let a relay trip, kill the gateway, and let another sender tell lies."""
    make_interfaces()
    file, patient_file = directory / "plant.scd", directory / "patient.scd"
    document = plant_here(file)
    # What is to live through a part of the test does so on a slow machine too.
    text = file.read_text(encoding="utf-8")
    patient_file.write_text(text.replace(">1000</MaxTime>", f">{LIVES_LONG_MS}</MaxTime>"), encoding="utf-8")
    (block,), (other_block,), (third_block,), (fourth_block,), (fifth_block,) = (
        goose_blocks(document.ied(f"{name}_SEL710")) for name in ("A1", "A2", "B1", "B2", "B3")
    )
    listening = GooseSettings(interface="right", triggers=(GooseTrigger(signal=TRIP, motors=("FAN-A2",)),))
    settings = Settings(
        data_directory=directory,
        scd=file,
        motors=MOTORS,
        gateways=GatewaysSettings(goose=listening, modbus=ModbusSettings(port=free_port())),
    )
    repository = Repository(connect(make_database(directory)))
    repository.sync_plant(read_plant(settings))
    trips = replace(
        healthy_reference("A1_SEL710"),
        protection=ProtectionSettings(overcurrent=DefiniteTime(0.2, TRIPS_AFTER_S)),
    )
    found: dict[str, object] = {}
    relays = Simulator(document, {"A1_SEL710": trips}, files=directory / "relays", goose_interface="left")
    with started_gateways(settings) as gateways:
        # It listens before anybody tells: what a trip triggers is over for one that comes later.
        problem(gateways, "not heard")
        with relays:
            wait_until(lambda: goose(gateways).problem is None, "all relays to be heard")
            _trip(gateways, repository, found)
    patient = settings.model_copy(update={"scd": patient_file})
    with started_gateways(patient) as gateways, RawSocket("left") as sender:
        found["silent"] = problem(gateways, "not heard")
        _lie(gateways, sender, block, other_block, repository, found)
        with closing(sqlite3.connect(make_url(settings.database_url).database or "")) as database:
            _trip_while_neither_answers(gateways, sender, third_block, database, repository, found)
        _fall_silent(gateways, sender, fourth_block, repository)
        _replay(sender, fourth_block, fifth_block, repository, found)
    print(json.dumps(found))  # noqa: T201 - the test reads it


def _trip(gateways: PlantGateways, repository: Repository, found: dict[str, object]) -> None:
    """Wait for what a relay's trip does, and kill the gateway."""
    wait_until(lambda: all(one.process_id for one in gateways.status()), "the gateways' processes")
    found["capabilities"] = {one.kind: _capabilities(one.process_id) for one in gateways.status()} | {
        "worker": _of_job_worker()
    }
    wait_until(lambda: alarms(repository), "the alarm of the trip")
    wait_until(lambda: _requests(repository), "the request that the trip triggers")
    (alarm,) = alarms(repository)
    found["alarm"] = [alarm.motor, alarm.priority.value, alarm.reason.split(" since ")[0]]
    found["requests"] = [(one.motor, one.origin.value) for one in _requests(repository)]
    _kill(gateways)
    found["raises after the kill"] = [one.raises for one in alarms(repository)]
    found["requests after the kill"] = len(_requests(repository))


def _lie(
    gateways: PlantGateways,
    sender: RawSocket,
    block: GooseBlock,
    other_block: GooseBlock,
    repository: Repository,
    found: dict[str, object],
) -> None:
    """Tell, as the relay, what does not count; then what does: that the trip has fallen."""
    sender.send(bytes.fromhex("010ccd010000") + bytes(6) + b"\x88\xb8" + os.urandom(200))
    wrong = _Relay(sender, block, GOOD, revision=block.control.configuration_revision + 1)
    reason = "another confRev than configured"
    wait_until(lambda: wrong.tells() and reason in (goose(gateways).problem or ""), reason)
    found["after a wrong revision"] = [reason, len(alarms(repository))]

    bad = _Relay(sender, block, BAD)
    heard = "5 of 6"
    wait_until(lambda: bad.tells() and heard in (goose(gateways).problem or ""), "the relay to be heard")
    # What is written after it shows that it was written, if it was.
    other = _Relay(sender, other_block, GOOD, trip=True)
    wait_until(lambda: other.tells() and "FAN-A2" in tripped(repository), "the trip of another relay")
    found["after a bad quality"] = "PUMP-A1" in tripped(repository)

    good = _Relay(sender, block, GOOD)
    # A sender that begins anew is one that replays, until it was silent for as long as it promised.
    wait_until(lambda: good.tells() and "PUMP-A1" not in tripped(repository), "the alarm to be cleared")
    found["after the truth"] = tripped(repository)


def _trip_while_neither_answers(
    gateways: PlantGateways,
    sender: RawSocket,
    block: GooseBlock,
    database: sqlite3.Connection,
    repository: Repository,
    found: dict[str, object],
) -> None:
    """Trip while somebody else writes to the database, and let the interface fall before that ends."""
    database.execute("BEGIN IMMEDIATE")
    relay = _Relay(sender, block, GOOD, trip=True)
    assert relay.tells()
    wait_until(all_frames_are_read, "the gateway to have the trip")
    ip("link set right down")
    database.rollback()
    wait_until(lambda: len(alarms(repository)) == 2, "the alarm of the trip")
    found["while it is down"] = ["CONVEYOR-B1" in tripped(repository), problem(gateways, "right: ")]
    ip("link set right up")
    wait_until(lambda: relay.tells() and "5 of 6" in (goose(gateways).problem or ""), "it to hear again")


def _fall_silent(
    gateways: PlantGateways, sender: RawSocket, block: GooseBlock, repository: Repository
) -> None:
    """Trip and say nothing more; then begin anew, with a lower number, as a relay that was switched off."""
    relay = _Relay(sender, block, GOOD, lives_ms=LIVES_SHORT_MS)
    relay.turns(trip=True)
    wait_until(lambda: "COMPRESSOR-B2" in tripped(repository), "the trip")
    problem(gateways, "6 of 6")
    anew = _Relay(sender, block, GOOD, lives_ms=LIVES_LONG_MS)
    wait_until(lambda: anew.tells() and "COMPRESSOR-B2" not in tripped(repository), "the end of the trip")


def _replay(
    sender: RawSocket,
    block: GooseBlock,
    other_block: GooseBlock,
    repository: Repository,
    found: dict[str, object],
) -> None:
    """Tell, while a relay is heard, what it told before, what tests tell, and a state after missed ones."""
    other = _Relay(sender, other_block, GOOD)

    def is_tripped_after(*frames: bytes) -> bool:
        for octets in frames:
            sender.send(octets)
        # What another relay tells after them shows that they were taken, if they were.
        trip = "PUMP-B3" not in tripped(repository)
        other.turns(trip=trip)
        wait_until(lambda: ("PUMP-B3" in tripped(repository)) is trip, "the other relay's trip, or its end")
        return "COMPRESSOR-B2" in tripped(repository)

    # Its first state is the one that is heard already.
    relay = _Relay(sender, block, GOOD, lives_ms=LIVES_LONG_MS)
    risen = relay.turns(trip=True)
    found["once it trips"] = is_tripped_after()
    fallen = relay.turns(trip=False)
    on, number = decode_frame(risen).message.values, decode_frame(fallen).message.state_number
    found["after replays"] = is_tripped_after(
        risen, _changed(fallen, values=on), _changed(fallen, values=on, sequence_number=1)
    )
    later = _changed(risen, state_number=number + 1)
    found["after tests"] = is_tripped_after(
        _changed(later, simulation=True),
        encode_frame(replace(decode_frame(later), simulated=True)),
        _changed(later, values=_members(block, OF_A_TEST, trip=True)),
    )
    found["after missed states"] = is_tripped_after(_changed(later, state_number=number + 1 + MISSED + 1))


def _changed(octets: bytes, **changes: object) -> bytes:
    """Return a frame with other fields of its message."""
    frame = decode_frame(octets)
    message = replace(frame.message, **changes)  # type: ignore[arg-type] # fields by name
    return encode_frame(replace(frame, message=message))


def _members(block: GooseBlock, quality: BitString, *, trip: bool) -> tuple[Value, ...]:
    member: Value = (trip, quality, Timestamp(time.time_ns()))
    return (member,) * len(block.members)


class _Relay:
    """Tells as a relay that all of its protection has tripped, or nothing.

    lives_ms: how long a message lives; None for as long as the block says.
    """

    def __init__(
        self,
        sender: RawSocket,
        block: GooseBlock,
        quality: BitString,
        *,
        revision: int | None = None,
        trip: bool = False,
        lives_ms: int | None = None,
    ) -> None:
        self._sender, self._block, self._quality = sender, block, quality
        address = block.control.address
        assert address is not None
        published = PublishedBlock(
            reference=block.reference,
            data_set=block.data_set,
            goose_id=block.control.application_id,
            configuration_revision=revision or block.control.configuration_revision,
            destination=address.mac,
            application_id=address.application_id,
        )
        if lives_ms is not None:
            interval_ms = lives_ms // LIVES
            published = replace(published, minimum_time_ms=interval_ms, maximum_time_ms=interval_ms)
        values = _members(block, quality, trip=trip)
        self._publisher = Publisher(published, sender.address, values, time.time_ns())

    def tells(self) -> bool:
        """Send its state once more."""
        self._sender.send(self._publisher.next_frame(0.0))
        return True

    def turns(self, *, trip: bool) -> bytes:
        """Begin another state, and send it once; return the frame."""
        self._publisher.change(_members(self._block, self._quality, trip=trip), time.time_ns())
        octets = self._publisher.next_frame(0.0)
        self._sender.send(octets)
        return octets


def _kill(gateways: PlantGateways) -> None:
    killed = goose(gateways).process_id
    assert killed is not None
    os.kill(killed, signal.SIGKILL)
    wait_until(
        lambda: goose(gateways).process_id not in (None, killed) and goose(gateways).problem is None,
        "the gateway to be back",
    )


def _requests(repository: Repository) -> list[RecordingRequest]:
    return list(repository.recording_requests(limit=10).items)


def _capabilities(process: int | str | None) -> str:
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return next(line.split()[1] for line in lines if line.startswith("CapEff"))


def _of_job_worker() -> str:
    """Return the capabilities of a worker that evaluates records."""
    pool = WorkerPool(1, warm_up, is_ending=lambda: False)
    pool.renew()
    try:
        wait_until(lambda: not pool.has_ended() and not pool.loading(), "a worker", LONGEST_S)
        return pool.schedule(_capabilities, "self", LONGEST_S).result()
    finally:
        pool.stop()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
