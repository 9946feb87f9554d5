import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.recording_store.store import RecordingStore, RecordingStoreError, safe_name
from tests.service.fixtures import store

__all__ = ["store"]
FILES: dict[str, Path | bytes] = {"c_0001.cfg": b"config", "EVENTS/C_0001.DAT": b"samples"}


def test_files_are_kept_in_a_folder_of_their_content(store: RecordingStore) -> None:
    stored = store.store(FILES)
    assert stored.directory == store.root / stored.digest[:2] / stored.digest
    assert [(f.name, f.size_bytes) for f in stored.files] == [("C_0001.CFG", 6), ("C_0001.DAT", 7)]
    assert (stored.name, stored.size_bytes) == ("C_0001", 13)
    assert stored.entry.read_bytes() == b"config"
    assert store.find(stored.digest) == stored
    assert store.entry(stored.digest) == stored.entry
    assert list((store.root / "incoming" / "service").iterdir()) == []


def test_the_same_files_are_stored_once(store: RecordingStore, tmp_path: Path) -> None:
    copy = tmp_path / "copy.dat"
    copy.write_bytes(b"samples")
    first = store.store(FILES)
    assert store.store({"C_0001.DAT": copy, "C_0001.CFG": b"config"}) == first
    assert store.store(FILES | {"EVENTS/C_0001.DAT": b"sample_"}).digest != first.digest


def test_many_at_once_store_one(store: RecordingStore) -> None:
    with ThreadPoolExecutor(8) as pool:
        stored = list(pool.map(lambda _: store.store(FILES), range(24)))
    assert len({s.digest for s in stored}) == 1
    assert store.find(stored[0].digest) == stored[0]


def test_all_is_on_disk_before_the_folder_has_its_name(
    store: RecordingStore, monkeypatch: pytest.MonkeyPatch
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
    assert target == str(stored.directory)
    assert {*calls[:named]} == {
        ("fsync", f"{incoming}/C_0001.CFG", len(b"config")),
        ("fsync", f"{incoming}/C_0001.DAT", len(b"samples")),
        ("fsync", incoming, 0),
        ("fsync", str(store.root), 0),
    }
    assert calls[named - 2][1] == incoming, "a folder after the files in it"
    assert calls[named + 1 :] == [("fsync", str(stored.directory.parent), 0)]


def test_what_is_not_kept_leaves_nothing(store: RecordingStore) -> None:
    def interrupted_pull() -> None:
        with store.incoming() as incoming, incoming.create("A.CFG") as sink:
            sink.write(b"half of ")
            raise ConnectionError("relay went away")

    with pytest.raises(ConnectionError):
        interrupted_pull()
    assert [path for path in store.root.rglob("*") if path.is_file()] == []


def test_left_overs_of_a_killed_run_are_removed_and_nobody_elses(store: RecordingStore) -> None:
    killed = store.root / "incoming" / "service" / "killed"
    killed.mkdir()
    (killed / "A.CFG").write_bytes(b"half")
    gateway = RecordingStore(store.root, "gateway")
    with gateway.incoming() as incoming:
        with incoming.create("B.CFG") as sink:
            sink.write(b"config")
        assert store.discard_incoming() == 1
        assert store.discard_incoming() == 0
        assert incoming.keep().name == "B"


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ({"A.DAT": b""}, "exactly one file"),
        ({"A.CFG": b"", "B.CFG": b""}, "found A.CFG, B.CFG"),
        ({"A.CFG": b"", "a.cfg": b""}, "already has a file A.CFG"),
        ({"../..": b""}, "expected a file name"),
        ({".CFG": b""}, "expected a file name"),
        ({"": b""}, "expected a file name"),
        ({"A" * 100 + ".CFG": b""}, "expected a file name"),
    ],
)
def test_what_is_no_record_is_refused(
    store: RecordingStore, files: dict[str, Path | bytes], message: str
) -> None:
    with pytest.raises(RecordingStoreError, match=message):
        store.store(files)


@given(st.text(max_size=120))
def test_no_name_leaves_its_folder(name: str) -> None:
    try:
        safe = safe_name(name)
    except RecordingStoreError:
        return
    folder = Path("/records/one")
    assert Path(os.path.normpath(folder / safe)).parent == folder
    assert safe.isascii()
    assert safe.isprintable()


def test_damage_is_noticed(store: RecordingStore) -> None:
    stored = store.store(FILES)
    stored.entry.write_bytes(b"konfig")
    with pytest.raises(RecordingStoreError, match="are not those stored"):
        store.find(stored.digest)
    stored.entry.unlink()
    with pytest.raises(RecordingStoreError, match="exactly one file"):
        store.entry(stored.digest)


@pytest.mark.parametrize("digest", ["0" * 64, "../../etc", ""])
def test_an_unknown_digest(store: RecordingStore, digest: str) -> None:
    with pytest.raises(RecordingStoreError):
        store.find(digest)
