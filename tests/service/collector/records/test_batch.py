"""Records that are fetched together: each is kept once it is on disk, and one that the disk loses is not."""

import errno
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from mms import Client
from service.collector.records.batch import Batch
from service.collector.records.life import RecordState
from service.collector.records.listing import FolderListing, files_by_name, understand
from service.collector.records.pull import DailyAllowance
from service.recording_store.folder import FolderStore
from service.recording_store.recording import StoredRecording
from tests.service.collector.scripted_relay import ScriptedRelay

RECORDS = 12


@pytest.fixture
def client(relay: ScriptedRelay) -> Iterator[Client]:
    for number in range(RECORDS):
        relay.write_file(f"REC{number:02}.CEV", f"content of {number}".encode())
    with Client.connect("127.0.0.1", relay.port) as client:
        yield client


@pytest.fixture
def store(tmp_path: Path) -> FolderStore:
    return FolderStore(tmp_path / "store")


def taken(client: Client, store: FolderStore) -> dict[str, StoredRecording | OSError]:
    """What became of each of the relay's records when all were fetched, and then kept together."""
    folder = FolderListing("EVENTS", client.files("EVENTS"))
    allowance = DailyAllowance(10**9)
    with Batch(
        client, store, allowance, max_file_bytes=10**6, on_bytes=lambda _: None, listing_s=0.0
    ) as batch:
        for record in understand([folder]).records:
            batch.fetch(RecordState(record))
        confirmed, failed = batch.checked(files_by_name([folder]))
        assert not failed
        found: dict[str, StoredRecording | OSError] = {}
        for state, on_disk in batch.kept(confirmed):
            try:
                found[state.name] = on_disk()
            except OSError as error:
                found[state.name] = error
    return found


def test_all_are_kept_and_nothing_is_left_over(client: Client, store: FolderStore) -> None:
    found = taken(client, store)
    assert len(found) == RECORDS
    for stored in found.values():
        assert isinstance(stored, StoredRecording)
        assert store.find(stored.digest).files == stored.files
    assert store.discard_incoming() == 0


@pytest.mark.parametrize("lost", range(0, RECORDS, 5))
def test_a_record_that_the_disk_loses_is_not_kept_though_it_says_so_once_only(
    client: Client, store: FolderStore, monkeypatch: pytest.MonkeyPatch, lost: int
) -> None:
    """Linux tells of an error in writing to the first `fsync` after it, and then no more."""
    told: list[str] = []
    fsync = os.fsync

    def failing(descriptor: int) -> None:
        path = str(Path(f"/proc/self/fd/{descriptor}").readlink())
        if path.endswith(f"REC{lost:02}.CEV") and not told:
            told.append(path)
            raise OSError(errno.EIO, "Input/output error")
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", failing)
    found = taken(client, store)
    assert len(told) == 1
    assert {name for name, one in found.items() if isinstance(one, OSError)} == {f"REC{lost:02}"}
    assert len([one for one in found.values() if isinstance(one, StoredRecording)]) == RECORDS - 1
    assert store.discard_incoming() == 0
