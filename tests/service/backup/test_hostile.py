"""Back-ups that somebody has changed: refused with what is wrong, and nothing is touched."""

import json
import os
import sqlite3
from collections.abc import Callable
from contextlib import closing
from hashlib import sha256
from pathlib import Path

import pytest

from service.backup.errors import BackupError
from service.backup.layout import MARK
from service.backup.restoring import Place, restore_backup
from service.backup.verification import verify_backup
from service.configuration.settings import sqlite_url
from tests.service.backup.conftest import Data

pytestmark = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)

SECRET = "a secret of somebody else"  # noqa: S105 - no password


@pytest.fixture
def name(data: Data) -> str:
    data.record("R")
    return data.back_up().manifest.name


def place_of(tmp_path: Path) -> Place:
    target = tmp_path / "target"
    return Place(target, sqlite_url(target), target / "recordings")


def refused(data: Data, tmp_path: Path, message: str) -> None:
    """Restoring fails with the message, and neither a database nor a file of a recording is there."""
    place = place_of(tmp_path)
    with pytest.raises(BackupError, match=message):
        restore_backup(data.directory, place)
    assert not (place.data / "statorwatch.sqlite").exists()
    found = [path for path in place.data.rglob("*") if path.is_file() and path.name != "service.lock"]
    assert [path for path in found if SECRET.encode() in path.read_bytes()] == []


def rewritten(data: Data, name: str, change: Callable[[str], str]) -> None:
    """Change the list of files, with the hash of it that the manifest has, as an attacker would."""
    sums = data.directory / name / "SHA256SUMS"
    sums.write_text(change(sums.read_text()))
    edited(data, name, sums=sha256(sums.read_bytes()).hexdigest())


def edited(data: Data, name: str, /, **values: object) -> None:
    manifest = data.directory / name / "manifest.json"
    manifest.write_text(json.dumps({**json.loads(manifest.read_text()), **values}))


def seal(data: Data, name: str) -> None:
    """Write hashes, numbers and sizes anew: only what is in the files is wrong then."""
    sums = data.directory / name / "SHA256SUMS"
    lines, size_bytes = [], 0
    for line in sums.read_text().splitlines():
        path = line[66:]
        content = (data.directory / path).read_bytes()
        size_bytes += len(content)
        lines.append(f"{sha256(content).hexdigest()}  {path}\n")
    rewritten(data, name, lambda _text: "".join(lines))
    edited(data, name, size_bytes=size_bytes, files=len(lines))


@pytest.mark.parametrize(
    "path",
    [
        "../../etc/passwd",
        "/etc/passwd",
        "recordings/../../outside",
        "recordings/aa/../../../outside/X.CFG",
        "backup-20200101T000000Z/database.sqlite",
        "recordings/ab/" + "cd" * 32 + "/R.CFG",
        "recordings/" + "aa/" + "aa" * 32 + "/..",
        "recordings/" + "aa/" + "aa" * 32 + "/lower.cfg",
        "lock",
        "configuration/settings.toml",
        "a" * 600,
    ],
)
def test_a_path_that_leads_elsewhere(data: Data, name: str, tmp_path: Path, path: str) -> None:
    rewritten(data, name, lambda text: f"{text}{'0' * 64}  {path}\n")
    refused(data, tmp_path, r"SHA256SUMS: line \d+: expected a")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text + text.splitlines(keepends=True)[0], "is listed twice"),
        (lambda text: text[:-30], r"line \d+: expected a SHA-256 and a path"),
        (lambda text: text + "\x00" * 5000, r"line \d+: expected a SHA-256 and a path"),
        (lambda text: "".join(text.splitlines(keepends=True)[1:]), "is not whole: .*expected the files of a"),
        (lambda text: "".join(text.splitlines(keepends=True)[:-1]), "is not whole: .*are not those of this"),
        (lambda _text: "", "is not whole"),
    ],
)
def test_a_list_that_was_changed(
    data: Data, name: str, tmp_path: Path, change: Callable[[str], str], message: str
) -> None:
    rewritten(data, name, change)
    refused(data, tmp_path, message)


def test_a_list_that_is_not_the_manifests(data: Data, name: str, tmp_path: Path) -> None:
    with (data.directory / name / "SHA256SUMS").open("a") as sums:
        sums.write("\n")
    refused(data, tmp_path, "SHA256SUMS: expected SHA-256 .*, as the manifest says, found")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"format": 2}, "expected format 1 or older, found 2: a newer version made this back-up"),
        (
            {"revision": "9999"},
            "found 9999: another version made it",
        ),
        ({"revision": "'; DROP TABLE motors; --"}, "revision: String should match"),
        ({"name": "backup-20200101T000000Z"}, "name: expected backup-.*, as its folder is called"),
        ({"database": "postgresql"}, "it is of a postgresql database, and database_url names sqlite"),
        ({"size_bytes": 2**61}, "free bytes, found"),
        ({"size_bytes": 5}, "manifest.json: expected 5 bytes, found"),
        ({"size_bytes": -1}, "size_bytes: Input should be greater"),
        ({"files": 10**6}, "manifest.json: expected 1000000 files, found"),
        ({"surprise": 1}, "surprise: Extra inputs"),
        ({"lost": [{"digest": "x", "problem": ""}]}, r"lost\.0\.digest: String should match"),
    ],
)
def test_a_manifest_that_was_changed(
    data: Data, name: str, tmp_path: Path, values: dict[str, object], message: str
) -> None:
    edited(data, name, **values)
    refused(data, tmp_path, message)


@pytest.mark.parametrize("text", ["", "[]", "[" * 100_000, '{"format": 1}', "null", "\x00", "NaN"])
def test_a_manifest_that_is_none(data: Data, name: str, tmp_path: Path, text: str) -> None:
    (data.directory / name / "manifest.json").write_text(text)
    refused(data, tmp_path, "manifest.json: ")


def test_a_manifest_of_endless_size(data: Data, name: str, tmp_path: Path) -> None:
    os.truncate(data.directory / name / "manifest.json", 1 << 40)
    refused(data, tmp_path, "expected at most 16777216 bytes, found more")


@pytest.mark.parametrize("what", ["database.sqlite", "SHA256SUMS", "recording", "folder", "pool"])
def test_a_link_leads_nowhere(data: Data, name: str, tmp_path: Path, what: str) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "R.DAT").write_text(SECRET)
    victim = {
        "recording": next((data.directory / "recordings").glob("??/*/R.DAT")),
        "folder": next((data.directory / "recordings").glob("??/*")),
        "pool": data.directory / "recordings",
    }.get(what, data.directory / name / what)
    victim.rename(tmp_path / "moved")
    victim.symlink_to(outside if victim.suffix != ".DAT" else outside / "R.DAT")
    refused(data, tmp_path, "that is no link, found|is no link")


def test_a_pipe_in_place_of_a_file_is_not_waited_for(data: Data, name: str, tmp_path: Path) -> None:
    database = data.directory / name / "database.sqlite"
    database.unlink()
    os.mkfifo(database)
    refused(data, tmp_path, "expected a file, found something else")


def test_a_further_file_in_a_recording(data: Data, name: str, tmp_path: Path) -> None:
    assert name
    folder = next((data.directory / "recordings").glob("??/*"))
    (folder / "EVIL.DAT").write_text("x")
    refused(data, tmp_path, "their hashes differ")


def test_a_sparse_file_beyond_its_listed_size(data: Data, name: str, tmp_path: Path) -> None:
    os.truncate(data.directory / name / "database.sqlite", 64 << 20)
    refused(data, tmp_path, "is not whole: .*database.sqlite: expected SHA-256")


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        (
            "CREATE TRIGGER evil AFTER INSERT ON jobs BEGIN DELETE FROM recordings; END",
            "found a difference: trigger evil",
        ),
        ("CREATE VIEW evil AS SELECT 1", "found a difference: view evil"),
        ("DROP TABLE jobs", "found a difference: "),
        ("DROP TRIGGER audit_entries_delete", "found a difference: trigger audit_entries_delete"),
        ("UPDATE alembic_version SET version_num = '0001'", "expected tables of revision .*, found 0001"),
        ("DROP TABLE alembic_version", "expected a database of StatorWatch, found: no such table"),
        ("INSERT INTO recordings SELECT * FROM recordings LIMIT 0", None),
    ],
)
def test_a_database_with_other_things_in_it(
    data: Data, name: str, tmp_path: Path, statement: str, message: str | None
) -> None:
    """Its hash is right: whoever changes a back-up can write that too."""
    with closing(sqlite3.connect(data.directory / name / "database.sqlite")) as database:
        database.execute(statement)
        database.commit()
    seal(data, name)
    if message is not None:
        refused(data, tmp_path, message)
    else:
        assert restore_backup(data.directory, place_of(tmp_path)).added == 1


def test_a_database_that_names_what_is_not_there(data: Data, name: str, tmp_path: Path) -> None:
    with closing(sqlite3.connect(data.directory / name / "database.sqlite")) as database:
        database.execute("UPDATE recordings SET digest = ?", ("ab" * 32,))
        database.commit()
    seal(data, name)
    refused(data, tmp_path, "1 recordings are not in the list, such as abab")


def test_no_database_at_all(data: Data, name: str, tmp_path: Path) -> None:
    (data.directory / name / "database.sqlite").write_bytes(b"SQLite format 3\x00" + b"\xff" * 5000)
    seal(data, name)
    refused(data, tmp_path, "expected a database of StatorWatch, found")


def test_a_directory_that_has_other_things_in_it_is_left_alone(data: Data, tmp_path: Path) -> None:
    data.record("R")
    data.directory.mkdir()
    (data.directory / "holiday.jpg").write_text("x")
    with pytest.raises(BackupError, match=r"or one of back-ups, found holiday\.jpg"):
        data.back_up()
    assert [path.name for path in data.directory.iterdir()] == ["holiday.jpg"]
    with pytest.raises(BackupError, match="found another one"):
        verify_backup(data.directory)
    with pytest.raises(BackupError, match="found none"):
        verify_backup(tmp_path / "nowhere")


def test_back_ups_among_the_recordings_are_refused(data: Data) -> None:
    for directory in (data.store.root, data.store.root / "copies"):
        with pytest.raises(BackupError, match="expected a directory outside of the recordings"):
            type(data)(data.url, data.engine, data.repository, data.store, directory).back_up()
    assert not (data.store.root / MARK).exists()


def test_a_link_as_the_lock_is_not_followed(data: Data, name: str, tmp_path: Path) -> None:
    assert name
    victim = tmp_path / "victim"
    (data.directory / "lock").unlink()
    (data.directory / "lock").symlink_to(victim)
    with pytest.raises(OSError, match="symbolic link"):
        verify_backup(data.directory)
    assert not victim.exists()
