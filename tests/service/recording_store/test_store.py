"""What every store does: a folder, and a bucket of a real server."""

import os
import pickle
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.recording_store.contents import safe_name
from service.recording_store.errors import RecordingStoreError
from service.recording_store.store import RecordingStore
from tests.service.recording_store.conftest import StoreMaker

Known = Callable[[], set[str]]

FILES: dict[str, Path | bytes] = {"c_0001.cfg": b"config", "EVENTS/C_0001.DAT": b"samples"}


def contents(store: RecordingStore, digest: str) -> dict[str, bytes]:
    with store.opened(digest) as entry:
        return {path.name: path.read_bytes() for path in entry.parent.iterdir()}


def test_files_are_kept_under_their_content(store: RecordingStore) -> None:
    stored = store.store(FILES)
    assert [(f.name, f.size_bytes) for f in stored.files] == [("C_0001.CFG", 6), ("C_0001.DAT", 7)]
    assert (stored.name, stored.size_bytes, stored.entry_name) == ("C_0001", 13, "C_0001.CFG")
    assert contents(store, stored.digest) == {"C_0001.CFG": b"config", "C_0001.DAT": b"samples"}
    assert store.find(stored.digest) == stored
    assert stored.is_there()
    assert store.problem() is None


def test_the_same_files_are_stored_once(store: RecordingStore, known: Known, tmp_path: Path) -> None:
    copy = tmp_path / "copy.dat"
    copy.write_bytes(b"samples")
    first = store.store(FILES)
    assert store.store({"C_0001.DAT": copy, "C_0001.CFG": b"config"}) == first
    assert known() == {first.digest}
    assert store.store(FILES | {"EVENTS/C_0001.DAT": b"sample_"}).digest != first.digest


def test_many_at_once_store_one(store: RecordingStore) -> None:
    with ThreadPoolExecutor(8) as pool:
        stored = list(pool.map(lambda _: store.store(FILES), range(24)))
    assert len({s.digest for s in stored}) == 1
    assert store.find(stored[0].digest) == stored[0]


def test_whoever_reads_needs_its_name_alone(store: RecordingStore) -> None:
    """Tasks of other processes and hosts carry a source, and what was learnt is kept by it."""
    digest = store.store(FILES).digest
    source = store.source(digest)
    elsewhere = pickle.loads(pickle.dumps(source))  # noqa: S301 - our own
    assert elsewhere == source
    assert hash(elsewhere) == hash(source)
    assert elsewhere.is_seen_here()
    with elsewhere.opened() as entry:
        assert (entry.name, entry.read_bytes()) == ("C_0001.CFG", b"config")
    again: RecordingStore = pickle.loads(pickle.dumps(store))  # noqa: S301 - our own
    assert again.find(digest).name == "C_0001"


def test_what_is_not_kept_leaves_nothing(store: RecordingStore, known: Known) -> None:
    def interrupted_pull() -> None:
        with store.incoming() as incoming, incoming.create("A.CFG") as sink:
            sink.write(b"half of ")
            raise ConnectionError("relay went away")

    with pytest.raises(ConnectionError):
        interrupted_pull()
    assert known() == set()
    assert store.discard_incoming() == 0


def test_left_overs_of_a_killed_run_are_removed_and_nobody_elses(opened_by: StoreMaker) -> None:
    killed, other = opened_by("killed"), opened_by("gateway")
    with other.incoming() as incoming:
        with incoming.create("B.CFG") as sink:
            sink.write(b"config")
        left = killed.incoming()
        left.__enter__()  # and never left: the process was killed
        assert opened_by("killed").discard_incoming() == 1
        assert opened_by("killed").discard_incoming() == 0
        assert incoming.keep().name == "B"


def test_what_is_set_aside_is_gone(store: RecordingStore, known: Known) -> None:
    stored, other = store.store(FILES), store.store({"OTHER.CFF": b"other"})
    for _ in range(2):
        store.set_aside(stored.digest)
        store.remove_set_aside(stored.digest)
    store.remove_set_aside()
    assert not stored.is_there()
    with pytest.raises(RecordingStoreError, match="missing"):
        store.find(stored.digest)
    assert known() == {other.digest}
    assert store.store(FILES).is_there()


def test_what_the_database_does_not_know_is_moved_apart_and_put_back(
    store: RecordingStore, known: Known
) -> None:
    began_s = time.time()
    stored = store.store(FILES)
    (folder,) = store.unknown.stored(stored.digest[:2])
    assert (folder.digest, folder.size_bytes) == (stored.digest, 13)
    assert began_s - 2.0 <= folder.since_s <= time.time() + 2.0
    store.unknown.move_apart(stored.digest)
    assert not stored.is_there()
    (apart,) = store.unknown.set_apart()
    assert (apart.digest, apart.size_bytes) == (stored.digest, 13)
    with pytest.raises(FileNotFoundError):
        store.unknown.move_apart(stored.digest)
    store.unknown.put_back(stored.digest)
    assert store.find(stored.digest) == stored
    assert list(store.unknown.set_apart()) == []
    store.unknown.move_apart(stored.digest)
    store.unknown.remove(stored.digest)
    assert (known(), list(store.unknown.set_apart())) == (set(), [])


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


@pytest.mark.parametrize("digest", ["0" * 64, "../../etc", ""])
def test_an_unknown_digest(store: RecordingStore, digest: str) -> None:
    with pytest.raises(RecordingStoreError):
        store.find(digest)
