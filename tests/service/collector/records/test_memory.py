"""What is remembered of a relay's records: what it lists at present; the database knows the rest."""

import gc
import os
from collections.abc import Iterator
from dataclasses import asdict, replace

import pytest
from sqlalchemy import insert

from core.units import NANOSECONDS_PER_DAY
from mms import Client
from service.collector.records.directory import RecordDirectory
from service.collector.records.event_folders import EventFolders
from service.collector.records.ledger import MOST_NAMES, WrongListings
from service.collector.records.life import remote_of
from service.collector.records.listing import FolderListing, ListedRecord, understand
from service.collector.records.policy import RECORD_POLICY
from service.collector.records.pull import DailyAllowance
from service.collector.session.relay_alarms import RelayAlarms
from service.storage import connect
from service.storage.models import RecordingRow, RemoteRecordRow
from service.storage.records import RemoteRecord
from service.storage.states import RecordingSource, RecordingState
from testing.waiting import eventually
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

ROUNDS, RECORDS_A_ROUND = 25, 100


@pytest.fixture
def client(relay: ScriptedRelay) -> Iterator[Client]:
    with Client.connect("127.0.0.1", relay.port) as client:
        yield client


@pytest.fixture
def directory(bench: Bench) -> RecordDirectory:
    """It takes a record at the first look."""
    return RecordDirectory(
        bench.relay,
        MOTOR,
        bench.repository,
        bench.store,
        bench.settings,
        folders=EventFolders(NAME, "EVENTS"),
        alarms=RelayAlarms(NAME, bench.repository),
        allowance=DailyAllowance(10**9),
        on_bytes=lambda _number: None,
        policy=replace(RECORD_POLICY, settle_s=0.0),
    )


def scan(directory: RecordDirectory, client: Client) -> tuple[str, ...]:
    """Names of the records that were taken."""
    return directory.scan(client, lambda _name: None, expected=False).taken


def list_round(relay: ScriptedRelay, number: int) -> None:
    """The relay lists the records of this round alone."""
    for path in relay.events.iterdir():
        path.unlink()
    for record in range(RECORDS_A_ROUND):
        name = f"REC{number}{record:03}.CEV"
        relay.write_file(name, b"content")
        os.utime(relay.events / name, (1_700_000_000 + number, 1_700_000_000 + number))


def store_all_but_one(bench: Bench, listed: list[RemoteRecord]) -> None:
    """In the database these are stored, the last one excepted."""
    recordings = [
        {
            "id": f"of {remote.name}",
            "motor": MOTOR,
            "ied": NAME,
            "source": RecordingSource.RELAY,
            "name": remote.name,
            "size_bytes": remote.size_bytes,
            "state": RecordingState.FETCHED,
            "digest": remote.name,
            "attempts": 0,
            "announced_ns": 0,
        }
        for remote in listed[:-1]
    ]
    remotes = [{**asdict(remote), "ied": NAME, "recording_id": f"of {remote.name}"} for remote in listed[:-1]]
    with connect(bench.settings.database_url).begin() as connection:
        connection.execute(insert(RecordingRow), recordings)
        connection.execute(insert(RemoteRecordRow), remotes)


def remembered() -> int:
    """How many records this process holds, in whatever collection."""
    gc.collect()
    return sum(type(each) in (ListedRecord, RemoteRecord) for each in gc.get_objects())


def test_memory_does_not_grow_while_a_relay_lists_thousands_of_records(
    bench: Bench, relay: ScriptedRelay, client: Client, directory: RecordDirectory
) -> None:
    sizes = []
    for number in range(ROUNDS):
        list_round(relay, number)
        listed = [
            remote_of(record)
            for record in understand([FolderListing("EVENTS", client.files("EVENTS"))]).records
        ]
        store_all_but_one(bench, listed)
        assert scan(directory, client) == (listed[-1].name,)
        del listed
        if number in (0, ROUNDS // 2, ROUNDS - 1):  # counting takes longer than a round
            sizes.append(remembered())
    assert sizes == 3 * sizes[:1]
    opened = relay.opened
    assert opened == ROUNDS
    for number in range(3):  # records that come back are known, whoever stored them
        list_round(relay, number)
        assert scan(directory, client) == ()
    assert relay.opened == opened


def test_a_stored_record_that_comes_back_is_not_pulled_again(bench: Bench, relay: ScriptedRelay) -> None:
    relay.write_record("HR_1")
    relay.write_record("HR_2", b"x" * 200_000)  # larger than max_file_bytes
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.recording("HR_2") is not None)
        files = list(relay.events.iterdir())
        for path in files:
            path.rename(relay.root / path.name)
        relay.write_record("HR_3")
        assert eventually(lambda: bench.is_stored("HR_3"))
        before = bench.recordings()
        opened = relay.opened
        for path in files:
            (relay.root / path.name).rename(path)
        listings = relay.listings
        assert eventually(lambda: relay.listings > listings + 3)
        relay.write_record("HR_4")
        assert eventually(lambda: bench.is_stored("HR_4"))
    assert relay.opened == opened + 2, "the files of HR_4"
    assert [each for each in bench.recordings() if each.name != "HR_4"] == before


def test_wrong_listings_of_a_day_are_bounded() -> None:
    wrong = WrongListings()
    for number in range(3 * MOST_NAMES):
        wrong.note(f"HR_{number}", 0)
        wrong.note("HR_1", 0)
        wrong.prune([f"HR_{number}", "HR_1"])
    assert wrong.number("HR_1", 0) == 3 * MOST_NAMES + 1
    assert wrong.number("HR_2", 0) == 0
    wrong.note("HR_2", NANOSECONDS_PER_DAY)
    assert wrong.number("HR_1", NANOSECONDS_PER_DAY) == 0, "another day"
