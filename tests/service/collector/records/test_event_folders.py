"""Where a relay keeps its recordings: found over real MMS, however it is called."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from mms import Client
from service.collector.records.event_folders import Contents, EventFolders
from service.collector.records.policy import RECORD_POLICY
from service.plant import Overrides
from service.storage.states import LinkState, RecordingRequestState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.expectations import overriding
from tests.service.collector.scripted_relay import NAME, ScriptedRelay


@pytest.fixture
def client(relay: ScriptedRelay) -> Iterator[Client]:
    """Of a relay that has no folder yet."""
    relay.events.rmdir()
    with Client.connect("127.0.0.1", relay.port) as client:
        yield client


def write(relay: ScriptedRelay, *names: str) -> None:
    for name in names:
        path = relay.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"content")


def found(client: Client, folder: EventFolders) -> Contents:
    folder.begin()
    return folder.contents(client)


@pytest.mark.parametrize(
    ("names", "directory"),
    [
        (["EVENTS/X.CFG"], "EVENTS"),
        (["COMTRADE/X.CFG"], "COMTRADE"),
        (["Comtrade/X.CFG"], "Comtrade"),
        (["events/X.cev", "REPORTS/SER.TXT"], "events"),
        (["RECORDS/FAULTS/X.CFF"], "RECORDS/FAULTS"),
        (["X.CFG", "X.DAT"], ""),
        (["EVENTS/HISTORY.TXT", "COMTRADE/X.CFG"], "COMTRADE"),
        (["EVENTS/X.CEV", "COMTRADE/X.CFG"], "EVENTS, COMTRADE"),
        (["FAULTS\x1b[2J/X.CFG", "GOOD/X.CFG"], "GOOD"),
        (["F" * 150 + "/X.CFG", "GOOD/X.CFG"], "GOOD"),
    ],
)
def test_the_folder_is_found(client: Client, relay: ScriptedRelay, names: list[str], directory: str) -> None:
    write(relay, *names)
    folder = EventFolders(NAME, "EVENTS")
    assert found(client, folder).directory == directory
    assert folder.missing is None
    assert found(client, folder).directory == directory


def test_the_setting_comes_first_and_an_override_alone(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CFG", "OTHER/HISTORY.TXT", "THIRD/HISTORY.TXT")
    assert found(client, EventFolders(NAME, "OTHER")).directory == "OTHER", "empty as it is"
    assert found(client, EventFolders(NAME, "NOWHERE")).directory == "EVENTS"
    assert found(client, EventFolders(NAME, "OTHER", "THIRD")).directory == "THIRD"
    nowhere = EventFolders(NAME, "OTHER", "FOURTH")
    assert found(client, nowhere).directory is None
    assert nowhere.missing == "no directory of event recordings: looked for FOURTH"
    assert not nowhere.no_files


def test_two_folders_are_read_as_one(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CEV")
    folders = EventFolders(NAME, "EVENTS")
    assert found(client, folders).directory == "EVENTS"
    write(relay, "COMTRADE/X.CFG")
    assert found(client, folders).directory == "EVENTS, COMTRADE"
    listed = {entry.name for folder in folders.contents(client).folders for entry in folder.entries}
    assert listed == {"EVENTS/X.CEV", "COMTRADE/X.CFG"}
    (relay.root / "EVENTS" / "X.CEV").unlink()
    assert found(client, folders).directory == "COMTRADE"
    meant = EventFolders(NAME, "EVENTS", "EVENTS")
    assert found(client, meant).directory == "EVENTS", "somebody has decided"


def test_a_second_folder_that_comes_later_is_found(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CEV")
    hurried = replace(RECORD_POLICY, other_folder_s=0.2)
    folders = EventFolders(NAME, "EVENTS", policy=hurried)
    assert folders.contents(client).directory == "EVENTS"
    write(relay, "COMTRADE/X.CFG")
    assert eventually(lambda: folders.contents(client).directory == "EVENTS, COMTRADE", 2)


def test_records_of_both_folders_are_stored(bench: Bench, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/HR_1.CFG", "EVENTS/HR_1.DAT", "COMTRADE/HR_2.CFG", "COMTRADE/HR_2.DAT")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1") and bench.is_stored("HR_2"))
        assert bench.repository.relay(NAME).link_reason is None


def test_a_trigger_without_a_folder_names_what_was_looked_for(bench: Bench, relay: ScriptedRelay) -> None:
    relay.silent = True
    relay.events.rmdir()
    request_id = bench.request()
    with bench.session():
        assert bench.reaches(request_id, RecordingRequestState.FAILED)
    reason = bench.requested(request_id).reason or ""
    assert "expected a record within 2 s of the trigger; no directory of event recordings" in reason
    assert relay.edges == 1, "the folder may come with the first record"


def test_of_empty_folders_the_one_that_gets_a_recording_is_it(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/HISTORY.TXT", "COMTRADE/README.TXT")
    folder = EventFolders(NAME, "EVENTS")
    assert folder.contents(client).directory == "EVENTS, COMTRADE"
    write(relay, "COMTRADE/X.CFG")
    assert folder.contents(client).directory == "COMTRADE", "without another search"
    write(relay, "EVENTS/Y.CFG")
    folder.begin()
    assert folder.contents(client).directory == "COMTRADE, EVENTS"


def test_a_folder_that_goes_and_comes(bench: Bench, relay: ScriptedRelay) -> None:
    relay.events.rmdir()
    with bench.with_record_policy(replace(RECORD_POLICY, folder_search_s=0.1)).session():
        assert eventually(lambda: "looked for" in (bench.repository.relay(NAME).link_reason or ""))
        assert bench.link() is LinkState.UP
        relay.events.mkdir()
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.repository.relay(NAME).link_reason is None)


def test_an_announced_record_hurries_the_search_for_its_folder(bench: Bench, relay: ScriptedRelay) -> None:
    """A relay that makes its folder with its first record: that record waited 9.5 s once."""
    relay.events.rmdir()
    assert RECORD_POLICY.folder_search_s >= 10
    with bench.with_settings(record_timeout_s=30.0).session():
        assert eventually(lambda: "looked for" in (bench.repository.relay(NAME).link_reason or ""))
        relay.events.mkdir()
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"), 5)


def test_records_are_pulled_from_where_they_are(bench: Bench, relay: ScriptedRelay, tmp_path: Path) -> None:
    write(relay, "COMTRADE/HR_1.CFG", "COMTRADE/HR_1.DAT")
    with bench.session():
        assert eventually(lambda: bench.is_stored("HR_1"))
    write(relay, "DEEP/ER/HR_2.CFG", "DEEP/ER/HR_2.DAT")
    with overriding(bench, Overrides(events_directory="DEEP/ER")).session():
        assert eventually(lambda: bench.is_stored("HR_2"))
