"""`mcc backup` and `mcc restore` as a person uses them."""

import json
from pathlib import Path

import pytest

from service.cli.app import main
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.plants import NOW_NS
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def config(repository: Repository, store: RecordingStore, tmp_path: Path) -> Path:
    repository.add_recording(store.store({"R.CFF": b"samples"}), motor="PUMP-A1", now_ns=NOW_NS)
    (tmp_path / "plant.scd").write_text("<SCL/>")
    file = tmp_path / "mcc.toml"
    file.write_text('data_directory = "."\nscd = "plant.scd"\n[backup]\ndirectory = "copies"\n')
    return file


def run(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, object]:
    assert main([str(one) for one in (*arguments, "--json")]) == 0
    document: dict[str, object] = json.loads(capsys.readouterr().out)
    return document


def test_from_a_back_up_to_a_service_elsewhere(
    config: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = run(capsys, "backup", "--config", config)
    assert (made["recordings"], made["copied"], made["verified"]) == (1, 1, True)
    assert run(capsys, "backup", "--config", config)["copied"] == 0
    verified = run(capsys, "backup", "--verify", tmp_path / "copies")
    assert verified["name"] != made["name"], "the latest"
    folder = tmp_path / "copies" / str(made["name"])
    assert (folder / "configuration" / "plant.scd").read_text() == "<SCL/>"
    assert (folder / "configuration" / "settings.toml").read_text() == config.read_text()
    elsewhere = tmp_path / "elsewhere"
    restored = run(capsys, "restore", folder, "--into", elsewhere)
    assert (restored["name"], restored["added"]) == (made["name"], 1)
    assert sorted(path.name for path in elsewhere.iterdir()) == [
        "recordings",
        "service.lock",
        "statorwatch.sqlite",
    ]


def test_the_audit_trail_says_who_made_and_who_restored_a_back_up(
    config: Path, repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first = run(capsys, "backup", "--config", config)
    entry, *_ = repository.audit_entries(limit=9).items
    assert (entry.action, entry.subject, entry.origin) == ("backup-made", first["name"], "command line")
    assert json.loads(str(entry.after))["directory"] == str(tmp_path / "copies")
    second = run(capsys, "backup", "--config", config)
    elsewhere = tmp_path / "elsewhere"
    run(capsys, "restore", tmp_path / "copies", "--into", elsewhere)
    settings = tmp_path / "restored.toml"
    settings.write_text('data_directory = "elsewhere"\n')
    listed = run(capsys, "audit", "list", "--config", settings)["entries"]
    assert isinstance(listed, list)
    assert [(one["action"], one["subject"]) for one in listed[:2]] == [
        ("backup-restored", second["name"]),
        ("backup-made", first["name"]),
    ]
    assert listed[0]["after"]["from"] == str(tmp_path / "copies")
    assert listed[0]["after"]["made"] == second["made"]
    assert run(capsys, "audit", "verify", "--config", settings)["fault"] is None


def test_in_words(config: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["backup", str(tmp_path / "usb"), "--config", str(config), "--keep", "1"]) == 0
    assert ": 1 recordings (1 new), 4 files, " in capsys.readouterr().out
    assert main(["backup", "--verify", str(tmp_path / "usb")]) == 0
    assert ": whole: 1 recordings, 4 files, " in capsys.readouterr().out
    assert main(["restore", str(tmp_path / "usb"), "--config", str(config)]) == 1
    assert "--overwrite it is replaced, and kept" in " ".join(capsys.readouterr().err.split())
    next((tmp_path / "usb").glob("recordings/??/*/R.CFF")).write_bytes(b"damaged")
    assert main(["backup", "--verify", str(tmp_path / "usb")]) == 1
    assert "R.CFF: expected SHA-256" in " ".join(capsys.readouterr().err.split())


def test_the_list_says_why_one_failed(
    config: Path, repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["backup", "--list", "--config", str(config)]) == 0
    assert capsys.readouterr().out == "no back-ups\n"
    made = run(capsys, "backup", "--config", config)
    begun = repository.begin_backup("/backup", now_ns=2**62)
    assert begun is not None
    repository.fail_backup(begun.id, "the disk is full", now_ns=2**62)
    listed = run(capsys, "backup", "--list", "--config", config)["backups"]
    assert isinstance(listed, list)
    assert [(one["state"], one["name"], one["problem"]) for one in listed] == [
        ("failed", None, "the disk is full"),
        ("verified", made["name"], None),
    ]
    assert main(["backup", "--list", "--config", str(config)]) == 0
    assert "the disk is full" in " ".join(capsys.readouterr().out.split())
    assert main(["backup", "--list", "--verify", "--config", str(config)]) == 2
    assert tmp_path.is_dir()


def test_what_is_missing_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = tmp_path / "mcc.toml"
    config.write_text('data_directory = "."\n')
    assert main(["backup", "--config", str(config)]) == 1
    assert "expected a DIRECTORY, or the setting backup.directory" in capsys.readouterr().err
    assert main(["backup", str(tmp_path / "usb"), "--config", str(config)]) == 1
    assert "start the service once" in " ".join(capsys.readouterr().err.split())
    assert main(["backup", "--verify", "--keep", "2"]) == 2
    assert list(tmp_path.iterdir()) == [config]


def test_a_directory_that_cannot_be_made_is_named(config: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["backup", "/proc/nodisk/backup", "--config", str(config)]) == 1
    told = " ".join(capsys.readouterr().err.split())
    assert "/proc/nodisk/backup: the directory of the back-up cannot be made: No such file" in told
    assert "look whether its disk is mounted" in told
    assert "Errno" not in told


@pytest.mark.parametrize("command", [("backup", "{0}/copies"), ("restore", "{0}/copies/latest")])
def test_back_ups_refuse_a_bucket_in_one_line(
    command: tuple[str, ...], config: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(capsys, "backup", "--config", config)
    (made,) = [folder for folder in (tmp_path / "copies").iterdir() if (folder / "configuration").is_dir()]
    (tmp_path / "copies" / "latest").symlink_to(made)
    config.write_text('data_directory = "."\nscd = "plant.scd"\nrecordings_url = "s3://statorwatch"\n')
    arguments = [one.format(tmp_path) for one in command]
    assert main([*arguments, "--config", str(config)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("mcc: s3://statorwatch: expected the recordings in a folder, found them in an S3-")
    assert "back up the database by its own tools first (pg_dump), and then the bucket" in line
