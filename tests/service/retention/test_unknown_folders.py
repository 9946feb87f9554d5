"""Nothing that the database does not know stays in the store, and nothing that it knows leaves it."""

import json
import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from threading import Event, Thread

import httpx
import pytest
from structlog.testing import capture_logs

from core.units import SECONDS_PER_DAY
from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.retention.deletion import delete_recording, remove_discarded_folders
from service.retention.unknown_folders import KEPT_DAYS, SETTLED_S, Ages, UnknownFolderSweep
from service.storage import Repository
from service.storage.errors import FolderGoneError
from service.timing.undo_time import UNDO_NS
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving

REPEATS = 19
ON_SQLITE = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)


def folders(store: FolderStore) -> set[str]:
    return {path.name for path in store.root.glob("??/*")}


def known(repository: Repository) -> set[str | None]:
    return {entry.digest for entry in repository.recordings(limit=1000).items}


def sweep(repository: Repository, store: FolderStore, ages: Ages | None = None) -> UnknownFolderSweep:
    return UnknownFolderSweep(repository, store.unknown, ages or Ages())


def test_a_known_record_under_other_headers_leaves_nothing(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    """Nineteen uploads of a record of 10 MB, each with another header, left 190 MB."""
    context = ApiContext(Settings(data_directory=tmp_path), repository, store)
    record = {"E.CFG": b"config", "E.DAT": bytes(100_000)}

    def upload(header: bytes) -> httpx.Response:
        files = [("files", (name, content)) for name, content in {**record, "E.HDR": header}.items()]
        return client.post("/api/v1/recordings", data={"motor": "PUMP-A1"}, files=files)

    with serving(create_app(context)) as client:
        assert upload(b"0").status_code == 201
        assert {upload(b"header %d" % number).status_code for number in range(REPEATS)} == {200}
        with ThreadPoolExecutor(REPEATS) as pool:
            at_once = list(pool.map(upload, [b"the same", b"another"] * (REPEATS // 2)))
        assert {answer.status_code for answer in at_once} == {200}
    assert folders(store) == known(repository)
    assert len(folders(store)) == 1
    assert sum(path.stat().st_size for path in store.root.rglob("*") if path.is_file()) < 110_000


def store_and_be_killed(directory: Path) -> None:
    store = FolderStore(directory / "recordings")
    store.store({"K.CFF": b"killed"})
    os.kill(os.getpid(), signal.SIGKILL)


@ON_SQLITE
def test_what_a_killed_service_leaves_is_moved_apart_and_deleted_later(
    repository: Repository, store: FolderStore, tmp_path: Path
) -> None:
    repository.add_recording(store.store({"E.CFF": b"known"}), motor="PUMP-A1", now_ns=NOW_NS)
    process = get_context("fork").Process(target=store_and_be_killed, args=(tmp_path,))
    process.start()
    process.join(60)
    assert process.exitcode == -signal.SIGKILL
    (unknown,) = folders(store) - known(repository)
    sweeping = sweep(repository, store)
    now_s = time.time()
    sweeping.sweep(now_s + SETTLED_S - 60)
    assert unknown in folders(store), "its row may come yet"
    with capture_logs() as logs:
        sweeping.sweep(now_s + SETTLED_S + 60)
    assert folders(store) == known(repository)
    assert [(entry["folder"], entry["size_bytes"]) for entry in logs] == [(unknown, 6)]
    assert (store.root / "unknown" / unknown / "K.CFF").read_bytes() == b"killed"
    sweeping.sweep(now_s + (KEPT_DAYS - 1) * SECONDS_PER_DAY)
    assert (store.root / "unknown" / unknown).is_dir()
    sweeping.sweep(now_s + (KEPT_DAYS + 1) * SECONDS_PER_DAY)
    assert list((store.root / "unknown").iterdir()) == []


def test_what_the_database_knows_again_is_put_back(repository: Repository, store: FolderStore) -> None:
    """The service ran for an hour with an old back-up of its database."""
    stored = store.store({"E.CFF": b"samples"})
    sweeping = sweep(repository, store, Ages(settled_s=0.0))
    sweeping.sweep(time.time() + 1)
    assert folders(store) == set()
    back = store.store({"E.CFF": b"samples"})
    repository.add_recording(back, motor="PUMP-A1", now_ns=NOW_NS)
    (store.root / back.digest[:2] / back.digest).rename(store.root / "elsewhere")
    sweeping.sweep(time.time() + 1)
    assert store.find(stored.digest).files == stored.files
    assert list((store.root / "unknown").iterdir()) == []


def test_a_folder_that_is_discarded_is_left_to_whoever_discards_it(
    repository: Repository, store: FolderStore
) -> None:
    record = {"E.CFG": b"config", "E.DAT": b"samples"}
    repository.add_recording(store.store(record), motor="PUMP-A1", now_ns=NOW_NS)
    late = store.store({**record, "E.HDR": b"header"})
    assert not repository.add_recording(late, motor="PUMP-A1", now_ns=NOW_NS).created
    sweep(repository, store, Ages(settled_s=0.0)).sweep(time.time() + 1)
    assert late.digest in folders(store)
    remove_discarded_folders(repository, store, NOW_NS + UNDO_NS + 1)
    assert folders(store) == known(repository)


def test_a_sweep_in_the_midst_of_uploads_takes_no_recordings_files(
    repository: Repository, store: FolderStore
) -> None:
    """With no hour of grace: a folder may be moved between the moment it is stored and that it is added."""
    ended = Event()

    def sweep_on_and_on() -> None:
        sweeping = sweep(repository, store, Ages(settled_s=-1.0))
        while not ended.is_set():
            sweeping.sweep(time.time())

    sweeping = Thread(target=sweep_on_and_on)
    sweeping.start()
    added = 0
    try:
        for number in range(30):
            stored = store.store({"E.CFF": b"%d" % number})
            try:
                entry = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS + number).recording
            except FolderGoneError:
                continue
            added += 1
            assert entry.digest in folders(store)
            if number % 3 == 0:
                delete_recording(repository, entry.id, "a test", now_ns=NOW_NS)
                remove_discarded_folders(repository, store, NOW_NS + UNDO_NS + 1)
    finally:
        ended.set()
        sweeping.join()
    sweep(repository, store, Ages(settled_s=-1.0)).sweep(time.time())
    assert added > 0
    assert folders(store) == known(repository)


@ON_SQLITE
def test_what_a_person_puts_there_is_found_too(repository: Repository, store: FolderStore) -> None:
    (store.root / "ab").mkdir()
    (store.root / "ab" / "notes of somebody").mkdir()
    sweeping = sweep(repository, store, Ages(settled_s=-1.0))
    sweeping.sweep(time.time())
    assert (store.root / "ab" / "notes of somebody").is_dir(), "it is no record: left alone"


@ON_SQLITE
def test_the_command_shows_and_moves_what_is_unknown(
    repository: Repository,
    store: FolderStore,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    repository.add_recording(store.store({"E.CFF": b"known"}), motor="PUMP-A1", now_ns=NOW_NS)
    store.store({"U.CFF": bytes(1_500_000)})
    config = tmp_path / "mcc.toml"
    config.write_text('data_directory = "."\n')
    later_s = time.time() + SETTLED_S + 60
    monkeypatch.setattr(time, "time", lambda: later_s)
    assert main(["retention", "--dry-run", "--config", str(config)]) == 0
    shown = "folders of the recording store that the database does not know: 1, 1.5 MB"
    assert f"{shown}\n" in capsys.readouterr().out
    assert len(folders(store)) == 2
    assert main(["retention", "--config", str(config)]) == 0
    assert f"{shown}, moved to its folder unknown, where" in capsys.readouterr().out
    assert folders(store) == known(repository)
    assert main(["retention", "--json", "--config", str(config)]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["unknown_folders"] == {"number": 0, "bytes": 0, "moved": True}
