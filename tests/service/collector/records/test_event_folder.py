"""Where a relay keeps its recordings: found over real MMS, however it is called."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from mms import Client
from service.collector.records.event_folder import Contents, EventFolder
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


def found(client: Client, folder: EventFolder) -> Contents:
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
        (["EVENTS/X.CEV", "COMTRADE/X.CFG"], "EVENTS"),
        (["FAULTS\x1b[2J/X.CFG", "GOOD/X.CFG"], "GOOD"),
        (["F" * 150 + "/X.CFG", "GOOD/X.CFG"], "GOOD"),
    ],
)
def test_the_folder_is_found(client: Client, relay: ScriptedRelay, names: list[str], directory: str) -> None:
    write(relay, *names)
    folder = EventFolder(NAME, "EVENTS")
    assert found(client, folder).directory == directory
    assert folder.missing is None
    assert found(client, folder).directory == directory


def test_the_setting_comes_first_and_an_override_alone(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CFG", "OTHER/HISTORY.TXT", "THIRD/HISTORY.TXT")
    assert found(client, EventFolder(NAME, "OTHER")).directory == "OTHER", "empty as it is"
    assert found(client, EventFolder(NAME, "NOWHERE")).directory == "EVENTS"
    assert found(client, EventFolder(NAME, "OTHER", "THIRD")).directory == "THIRD"
    nowhere = EventFolder(NAME, "OTHER", "FOURTH")
    assert found(client, nowhere).directory is None
    assert nowhere.missing == "no directory of event recordings: looked for FOURTH"
    assert not nowhere.no_files


def test_recordings_in_a_second_folder_are_told(client: Client, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CEV")
    folder = EventFolder(NAME, "EVENTS")
    assert found(client, folder).directory == "EVENTS"
    assert folder.unread is None
    write(relay, "COMTRADE/X.CFG")
    assert found(client, folder).directory == "EVENTS"
    assert "recordings in COMTRADE are not fetched, only those in EVENTS" in (folder.unread or "")
    (relay.root / "COMTRADE" / "X.CFG").unlink()
    (relay.root / "EVENTS" / "X.CEV").unlink()
    (relay.root / "COMTRADE").rmdir()
    (relay.root / "EVENTS").rmdir()
    assert found(client, folder).directory is None
    assert folder.unread is None
    write(relay, "COMTRADE/X.CFG")
    meant = EventFolder(NAME, "EVENTS", "COMTRADE")
    assert found(client, meant).directory == "COMTRADE"
    assert meant.unread is None, "somebody has decided"


def test_a_second_folder_is_told_of_the_relay(bench: Bench, relay: ScriptedRelay) -> None:
    write(relay, "EVENTS/X.CEV", "COMTRADE/X.CFG")
    with bench.session():
        assert eventually(
            lambda: "COMTRADE are not fetched" in (bench.repository.relay(NAME).link_reason or "")
        )
        assert bench.link() is LinkState.UP


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
    folder = EventFolder(NAME, "EVENTS")
    assert folder.contents(client).directory == "EVENTS"
    write(relay, "COMTRADE/X.CFG")
    assert folder.contents(client).directory == "COMTRADE", "without another search"
    write(relay, "EVENTS/Y.CFG")
    assert folder.contents(client).directory == "COMTRADE", "from now on"


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
