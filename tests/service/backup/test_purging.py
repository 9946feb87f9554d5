"""`mcc purge`: nothing of a plant is left, and nothing goes that nobody was told of."""

import fcntl
import json
from pathlib import Path

import pytest
from sqlalchemy import inspect

from service.audit.entries import START
from service.audit.exports import read_export
from service.audit.verification import verify
from service.cli.app import main
from service.configuration.recordings_url import BucketPlace
from service.process.sealing import Seal
from service.recording_store.bucket import BucketStore
from service.recording_store.bucket_client import Bucket
from service.storage import connect
from testing.service.s3_server import BUCKET, Fault, S3Server
from tests.service.backup.conftest import Data, files_below


@pytest.fixture(autouse=True)
def the_state_counts_are_right() -> None:
    """There are none where nothing is left."""


@pytest.fixture
def config(data: Data, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A service that has run: database, recordings, back-ups, key, marks, and files that people gave it."""
    for text in ("R1", "R2"):
        data.record(text)
    data.back_up()
    root = data.store.root.parent
    Seal(root / "secrets.key")
    (root / "installation").write_text("an id")
    (root / "visiting").mkdir()
    (root / "visiting" / "1").write_text("A1_SEL710")
    folder = tmp_path_factory.mktemp("given")
    (folder / "motors.toml").write_text("# given by people")
    file = folder / "mcc.toml"
    file.write_text(
        f'data_directory = "{root}"\nrecordings_directory = "{data.store.root}"\n'
        f'database_url = "{_written(data.url)}"\nmotors = "motors.toml"\n'
        f'[backup]\ndirectory = "{data.directory}"\n'
    )
    data.engine.dispose()
    return file


def _written(url: str) -> str:
    return url.replace("\\", "\\\\")


def _tables(url: str) -> list[str]:
    if url.startswith("sqlite") and not Path(url.removeprefix("sqlite:///")).exists():
        return []
    engine = connect(url)
    try:
        return inspect(engine).get_table_names()
    finally:
        engine.dispose()


def _purge(config: Path, *more: object) -> int:
    return main(["purge", "--config", str(config), *map(str, more)])


def test_nothing_of_a_plant_is_left(
    data: Data, config: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = data.store.root.parent
    outside = config.with_name("audit.jsonl")
    assert _tables(data.url)
    assert _purge(config, "--audit", outside, "--backups", "--yes", "--json") == 0
    told = capsys.readouterr()
    document = json.loads(told.out)
    assert document["files"] > 8
    assert document["size_bytes"] > 0
    for path in (str(root), str(data.directory), "given by people"):
        assert path in " ".join(told.err.split()), "told before"
    assert _tables(data.url) == []
    assert [*tmp_path.rglob("*")] == [], "the data directory itself stays, empty"
    assert sorted(config.parent.iterdir()) == sorted([config, config.with_name("motors.toml"), outside])
    entries = list(read_export(outside))
    assert entries[-1].action == "plant-purged"
    assert verify(lambda: read_export(outside), start=START).fault is None
    assert outside.stat().st_mode & 0o077 == 0


def test_back_ups_stay_unless_they_are_asked_for(
    data: Data, config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = files_below(data.directory)
    assert _purge(config, "--without-audit", "--yes") == 0
    told = capsys.readouterr()
    assert "the audit trail goes too" in told.err
    assert "nothing is left" in told.out
    assert files_below(data.directory) == before
    assert not data.store.root.exists() or not files_below(data.store.root)


def test_a_service_that_runs_keeps_its_data(
    data: Data, config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = data.store.root.parent
    before = files_below(data.store.root)
    for name in ("service.lock", "gateway-0.lock", "rediagnosis.lock"):
        with (root / name).open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            assert _purge(config, "--without-audit", "--yes") == 1
        assert "another service works on this data directory" in capsys.readouterr().err
    assert files_below(data.store.root) == before
    assert _tables(data.url)


def test_a_database_that_somebody_uses_is_kept(
    data: Data, config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = files_below(data.store.root)
    with data.engine.connect() as other:
        other.exec_driver_sql("SELECT count(*) FROM motors").scalar()
        assert _purge(config, "--without-audit", "--yes") == 1
    told = capsys.readouterr().err
    assert "another program uses" in told or "other connections use" in told
    assert files_below(data.store.root) == before


def test_nothing_goes_without_a_word(data: Data, config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _purge(config, "--yes") == 2, "what becomes of the audit trail has to be said"
    assert _purge(config, "--without-audit") == 1
    assert "--yes" in capsys.readouterr().err
    root = data.store.root.parent
    assert _purge(config, "--audit", root / "audit.jsonl", "--yes") == 1
    assert "outside of what is deleted" in capsys.readouterr().err
    assert files_below(data.store.root)
    assert _tables(data.url)


@pytest.mark.parametrize("typed", ["yes", "", "DIRECTORY"])
def test_who_types_the_name_of_the_directory_means_it(
    data: Data, config: Path, monkeypatch: pytest.MonkeyPatch, typed: str
) -> None:
    name = data.store.root.parent.resolve().name
    monkeypatch.setattr("sys.stdin.isatty", lambda: True)
    monkeypatch.setattr("builtins.input", lambda *_: name if typed == "DIRECTORY" else typed)
    ended = _purge(config, "--without-audit")
    assert (ended == 0) is (typed == "DIRECTORY")
    assert bool(_tables(data.url)) is (typed != "DIRECTORY")


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_no_link_is_followed_and_no_other_directory_is_taken(
    data: Data, config: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    elsewhere = config.with_name("elsewhere")
    elsewhere.mkdir()
    (elsewhere / "other.txt").write_text("not of the plant")
    (data.store.root.parent / "link").symlink_to(elsewhere)
    assert _purge(config, "--without-audit", "--yes") == 0
    assert (elsewhere / "other.txt").exists()
    assert not (data.store.root.parent / "link").is_symlink()
    config.write_text(f'data_directory = "{elsewhere}"\n')
    assert _purge(config, "--without-audit", "--yes") == 1
    assert "expected the data directory of a service" in capsys.readouterr().err
    assert (elsewhere / "other.txt").exists()


@pytest.fixture
def config_of_bucket(config: Path, place: BucketPlace, s3: S3Server) -> Path:
    """The same service with its recordings in a bucket, where others have something, too."""
    others = ("recordings_directory", "[backup]", "directory")
    lines = [line for line in config.read_text().splitlines() if not line.startswith(others)]
    config.write_text("\n".join([f'recordings_url = "{place}"', *lines]))
    store = BucketStore(place, None)
    for text in (b"R1", b"R2"):
        store.store({"C_0001.CFG": text, "C_0001.DAT": text * 100})
    store.unknown.move_apart(store.store({"C_0001.CFG": b"R3", "C_0001.DAT": b"R3"}).digest)
    for key in OF_OTHERS:
        s3.client().put_object(Bucket=BUCKET, Key=key.format(prefix=place.prefix), Body=b"not of the plant")
    return config


OF_OTHERS = (
    "{prefix}notes of somebody",
    "{prefix}ab/notes/C_0001.CFG",
    "another-plant/{prefix}ab/" + "ab" * 32 + "/C_0001.CFG",
    "zz/" + "ab" * 32 + "/C_0001.CFG",
)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_a_bucket_is_emptied_of_the_plant_and_of_nothing_else(
    data: Data, config_of_bucket: Path, place: BucketPlace, s3: S3Server, capsys: pytest.CaptureFixture[str]
) -> None:
    before = set(s3.keys_of())
    outside = config_of_bucket.with_name("audit.jsonl")
    assert _purge(config_of_bucket, "--audit", outside, "--yes", "--json") == 0
    told = capsys.readouterr()
    words = " ".join(told.err.split())
    assert f"{place}, 6 objects" in words, "told before"
    assert f"{place}: 2 objects that are no recordings of the service" in words
    document = json.loads(told.out)
    assert (document["bucket"], document["objects"]) == (str(place), 6)
    left = set(s3.keys_of())
    assert left == {key.format(prefix=place.prefix) for key in OF_OTHERS} | {
        key for key in before if not key.startswith(place.prefix) and "another-plant" not in key
    }
    assert json.loads(list(read_export(outside))[-1].after or "{}")["objects"] == 6


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
@pytest.mark.parametrize("fault", [Fault.BUSY, Fault.DENIED, Fault.IS_A_PAGE])
def test_a_store_that_does_not_do_it_leaves_all_as_it_was(
    data: Data, config_of_bucket: Path, s3: S3Server, fault: Fault, capsys: pytest.CaptureFixture[str]
) -> None:
    before = s3.keys_of()
    s3.fail(fault)
    assert _purge(config_of_bucket, "--without-audit", "--yes") == 1
    assert "s3://" in capsys.readouterr().err
    s3.fail(Fault.NONE)
    assert s3.keys_of() == before
    assert _tables(data.url)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_a_purge_that_a_store_interrupts_is_begun_again(
    data: Data, config_of_bucket: Path, place: BucketPlace, s3: S3Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    deleted = Bucket.delete
    left = iter([True, True])

    def until_it_fails(self: Bucket, key: str) -> None:
        if next(left, None) is None:
            s3.fail(Fault.DENIED)
        deleted(self, key)

    with monkeypatch.context() as failing:
        failing.setattr(Bucket, "delete", until_it_fails)
        assert _purge(config_of_bucket, "--without-audit", "--yes") == 1
    s3.fail(Fault.NONE)
    assert _purge(config_of_bucket, "--without-audit", "--yes") == 0
    assert [key for key in s3.keys_of() if key.startswith(place.prefix) and key.endswith(".DAT")] == []
    assert not data.store.root.parent.exists() or not files_below(data.store.root.parent)
