"""What a folder does beside what every store does."""

import os
from pathlib import Path

import pytest

from service.recording_store.errors import RecordingStoreError
from service.recording_store.folder import FolderStore

FILES: dict[str, Path | bytes] = {"c_0001.cfg": b"config", "EVENTS/C_0001.DAT": b"samples"}


@pytest.fixture
def store(tmp_path: Path) -> FolderStore:
    return FolderStore(tmp_path / "recordings")


def test_files_are_kept_in_a_folder_of_their_content(store: FolderStore) -> None:
    stored = store.store(FILES)
    assert store.directory(stored.digest) == store.root / stored.digest[:2] / stored.digest
    assert store.entry(stored.digest).read_bytes() == b"config"
    assert list((store.root / "incoming" / "service").iterdir()) == []


def test_all_is_on_disk_before_the_folder_has_its_name(
    store: FolderStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a power cut leaves cannot be seen here; the order of the system's calls can."""
    calls: list[tuple[str, str, int]] = []
    fsync, rename = os.fsync, os.rename

    def syncing(descriptor: int) -> None:
        found = os.fstat(descriptor)
        path = Path(f"/proc/self/fd/{descriptor}").readlink()
        calls.append(("fsync", str(path), 0 if path.is_dir() else found.st_size))
        fsync(descriptor)

    def renaming(source: Path, target: Path) -> None:
        calls.append(("rename", f"{source} {target}", 0))
        rename(source, target)

    monkeypatch.setattr(os, "fsync", syncing)
    monkeypatch.setattr(os, "rename", renaming)
    stored = store.store(FILES)
    (named,) = [number for number, call in enumerate(calls) if call[0] == "rename"]
    incoming, target = calls[named][1].split(" ")
    assert target == str(store.directory(stored.digest))
    assert {*calls[:named]} == {
        ("fsync", f"{incoming}/C_0001.CFG", len(b"config")),
        ("fsync", f"{incoming}/C_0001.DAT", len(b"samples")),
        ("fsync", incoming, 0),
        ("fsync", str(store.root), 0),
    }
    assert calls[named - 2][1] == incoming, "a folder after the files in it"
    assert calls[named + 1 :] == [("fsync", str(store.directory(stored.digest).parent), 0)]


def test_damage_is_noticed(store: FolderStore) -> None:
    stored = store.store(FILES)
    store.entry(stored.digest).write_bytes(b"konfig")
    with pytest.raises(RecordingStoreError, match="are not those stored"):
        store.find(stored.digest)
    store.entry(stored.digest).unlink()
    with pytest.raises(RecordingStoreError, match="exactly one file"):
        store.entry(stored.digest)


def test_a_folder_that_is_not_mounted_is_a_problem(store: FolderStore) -> None:
    assert store.problem() is None
    store.root.rename(store.root.with_name("elsewhere"))
    assert "is it mounted?" in (store.problem() or "")
