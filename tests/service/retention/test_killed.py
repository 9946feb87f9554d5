"""A service killed at any step of a deletion loses track of nothing, and ends it when it starts again."""

import os
import signal
from multiprocessing import get_context
from pathlib import Path

import pytest

from service.configuration.settings import sqlite_url
from service.recording_store.folder import FolderStore
from service.retention.deletion import delete_recording, remove_discarded_folders
from service.storage import Repository, connect
from service.timing.undo_time import UNDO_NS
from testing.service.plants import NOW_NS

AFTER_NS = NOW_NS + UNDO_NS + 1
"""When no deletion of this test can be undone any more."""
STEPS = ("nothing", "rows", "set aside", "released", "half removed")


class KilledStore(FolderStore):
    """Its process is killed after it has set a folder aside, or has removed half of what was set aside."""

    step = ""

    def set_aside(self, digest: str) -> None:
        if self.step == "rows":
            kill_myself()
        super().set_aside(digest)
        if self.step == "set aside":
            kill_myself()

    def remove_set_aside(self, digest: str | None = None) -> None:
        if self.step == "released":
            kill_myself()
        if self.step == "half removed":
            next(path for path in self.root.glob("deleted/*/*")).unlink()
            kill_myself()
        super().remove_set_aside(digest)


def kill_myself() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def delete_and_be_killed(directory: Path, recording_id: str, step: str) -> None:
    repository = Repository(connect(sqlite_url(directory)))
    store = KilledStore(directory / "recordings")
    store.step = step
    if step == "nothing":
        kill_myself()
    delete_recording(repository, recording_id, "a test", now_ns=NOW_NS)
    remove_discarded_folders(repository, store, AFTER_NS)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_killed_at_each_step(repository: Repository, store: FolderStore, tmp_path: Path) -> None:
    for step in STEPS:
        files = {"U.CFG": step.encode(), "U.DAT": b"samples"}
        stays = repository.add_recording(store.store({"S.CFF": b"x"}), motor="PUMP-A1", now_ns=NOW_NS)
        added = repository.add_recording(store.store(files), motor="PUMP-A1", now_ns=NOW_NS).recording
        process = get_context("fork").Process(target=delete_and_be_killed, args=(tmp_path, added.id, step))
        process.start()
        process.join(60)
        assert process.exitcode == -signal.SIGKILL, step
        known = {entry.digest for entry in repository.recordings(limit=10).items}
        assert (added.digest in known) == (step == "nothing"), step
        present = {path.name for path in store.root.glob("??/*")}
        assert known <= present, f"{step}: nothing is missing that the database knows"
        assert present <= known | set(repository.discarded_folders()), f"{step}: nothing is unknown"
        if step == "nothing":
            delete_recording(repository, added.id, "a test", now_ns=NOW_NS)
        remove_discarded_folders(repository, store, AFTER_NS)  # as every service does when it starts
        assert {path.name for path in store.root.glob("??/*")} == {stays.recording.digest}, step
        assert list(store.root.glob("deleted/*")) == [], step
        assert repository.discarded_folders() == (), step
    assert len(repository.deletions(limit=10).items) == len(STEPS)
