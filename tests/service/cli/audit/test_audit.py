"""`mcc audit` against a service on a real port, against its database, and on files."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine, text

from service.api import ApiContext, create_app
from service.audit.actions import AuditAction
from service.cli.app import main
from service.client.credentials import remember
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.service.accounts import auditor_token
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

ANNA = Actor("anna", "10.0.0.7")

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs a command: its exit code, what it printed, and what it said beside."""

    def run(*words: str) -> tuple[int, str, str]:
        capsys.readouterr()
        code = main(["audit", *words])
        said = capsys.readouterr()
        return code, said.out, said.err

    return run


@pytest.fixture
def url(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[str]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        remember(str(client.base_url), token=auditor_token(repository))
        yield str(client.base_url)


@pytest.fixture(params=["service", "database"])
def where(request: pytest.FixtureRequest, tmp_path: Path, repository: Repository) -> list[str]:
    """Options that name the trail: the service that has it, or the settings of its database."""
    if request.param == "service":
        return ["--url", request.getfixturevalue("url")]
    config = tmp_path / "mcc.toml"
    config.write_text(f"data_directory = {json.dumps(str(tmp_path))}\n")
    return ["--config", str(config)]


def note(repository: Repository, number: int = 1) -> None:
    for index in range(number):
        subject = ("motor", f"PUMP-{index}")
        after = {"text": f"=1+1 bearing {index}", "time": None}
        repository.note_by(ANNA, AuditAction.NOTE_ADDED, subject, now_ns=NOW_NS, after=after)


def tamper(engine: Engine, statement: str) -> None:
    with engine.begin() as connection:
        for trigger in ("audit_entries_update", "audit_entries_delete", "audit_head_update"):
            connection.execute(text(f"DROP TRIGGER IF EXISTS {trigger}"))
        connection.execute(text(statement))


def test_entries_are_listed(repository: Repository, where: list[str], run: Run) -> None:
    note(repository, 2)
    code, shown, _ = run("list", *where, "--subject", "PUMP-1")
    assert code == 0
    assert "anna" in shown
    assert "10.0.0.7" in shown
    assert "note-added" in shown
    assert "motor PUMP-1" in shown
    assert "bearing 1" in shown
    assert "PUMP-0" not in shown
    _, shown, _ = run("list", *where, "--json", "--actor", "anna", "--action", "note-added")
    entries = json.loads(shown)["entries"]
    assert [entry["number"] for entry in entries] == [2, 1]
    assert entries[0]["time"] == "2025-10-09T08:53:20.000000000Z"
    assert (entries[0]["roles"], entries[0]["after"]["text"]) == ([], "=1+1 bearing 1")
    assert run("list", *where, "--from", "2025-10-10")[1] == "no entries\n"
    assert (
        run("list", *where, "--from", "2025-10-09", "--to", "2025-10-10", "--limit", "1")[1].count("anna")
        == 1
    )
    _, shown, _ = run("list", *where, "--csv", "--limit", "1")
    assert shown.splitlines()[0].startswith("number,time,actor,origin")
    assert len(shown.splitlines()) == 2
    assert run("list", *where, "--action", "note-addet")[0] == 1
    assert run("list", *where, "--to", "soon")[0] == 1


def test_an_entry_is_read_at_a_glance_in_80_columns(
    repository: Repository, where: list[str], run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    note(repository)
    lines = run("list", *where)[1].splitlines()
    assert max(map(len, lines)) <= 80
    (first,) = (number for number, line in enumerate(lines) if "note-added" in line)
    assert all(word in lines[first] for word in ("1", "2025-10-09 08:53:20 UTC", "anna"))
    assert all(word in lines[first + 1] for word in ("10.0.0.7", "motor PUMP-0"))
    assert "text =1+1 bearing 0" in lines[first + 2]


def test_whoever_lists_without_a_service_is_told_of_a_wrong_action(where: list[str], run: Run) -> None:
    assert "note-added" in run("list", *where, "--action", "note-addet")[2]


def test_an_intact_trail_is_verified(repository: Repository, where: list[str], run: Run) -> None:
    assert run("verify", *where)[1] == "the audit trail has no entries\n"
    note(repository, 3)
    code, shown, _ = run("verify", *where)
    assert code == 0
    assert shown.startswith("3 entries are as they were written; the last is 3, ")
    document = json.loads(run("verify", *where, "--json")[1])
    assert (document["entries"], document["fault"], document["last"]["number"]) == (3, None, 3)


def test_a_changed_entry_is_named(repository: Repository, engine: Engine, where: list[str], run: Run) -> None:
    note(repository, 3)
    tamper(engine, "UPDATE audit_entries SET actor = 'mallory' WHERE number = 2")
    code, shown, said = run("verify", *where, "--json")
    assert code == 1
    assert "the audit trail is not as it was written: entry 2 was changed" in said
    error = json.loads(shown)["error"]
    assert (error["fault"], error["number"], error["entries"]) == ("changed", 2, 1)
    code, _, said = run("export", *where)
    assert code == 1
    assert "entry 2 was changed" in said


def test_an_anchor_shows_a_trail_that_was_cut_off_with_its_head(
    repository: Repository, engine: Engine, where: list[str], run: Run, tmp_path: Path
) -> None:
    note(repository, 3)
    anchor = tmp_path / "anchors.jsonl"
    for _ in range(2):
        assert run("verify", *where, "--write-anchor", str(anchor))[0] == 0
    assert [json.loads(line)["number"] for line in anchor.read_text().splitlines()] == [3, 3]
    assert run("verify", *where, "--anchor", str(anchor))[0] == 0
    tamper(engine, "DELETE FROM audit_entries WHERE number = 3")
    assert "entry 3 was written" in run("verify", *where)[2]
    tamper(
        engine,
        "UPDATE audit_head SET number = 2, hash = (SELECT hash FROM audit_entries WHERE number = 2)",
    )
    assert run("verify", *where)[0] == 0, "nothing in the database tells of the third entry any more"
    code, _, said = run("verify", *where, "--anchor", str(anchor))
    assert code == 1
    assert "the end was cut off: entry 3 was written, as the anchor tells" in said


def test_an_export_is_continued_and_verified_by_itself(
    repository: Repository, engine: Engine, where: list[str], run: Run, tmp_path: Path
) -> None:
    note(repository, 3)
    file = tmp_path / "trail.jsonl"
    assert run("export", str(file), *where)[2].endswith("3 entries added\n")
    note(repository, 2)
    assert run("export", str(file), *where)[2].endswith("2 entries added\n")
    assert run("export", *where)[1] == file.read_text()
    assert "5 entries are as they were written" in run("verify", str(file))[1]
    assert run("verify", *where, "--anchor", str(file))[0] == 0

    lines = file.read_text().splitlines()
    part = tmp_path / "part.jsonl"
    part.write_text("\n".join(lines[2:]) + "\n")
    assert "those up to 2 are not in the file" in run("verify", str(part))[1]
    for name, wrong, told in (
        ("changed", [*lines[:1], lines[1].replace("anna", "bert"), *lines[2:]], "entry 2 was changed"),
        ("removed", [*lines[:1], *lines[2:]], "entry 2 was removed"),
        ("reordered", [lines[0], lines[2], lines[1], *lines[3:]], "another order"),
    ):
        copy = tmp_path / name
        copy.write_text("\n".join(wrong) + "\n")
        code, _, said = run("verify", str(copy))
        assert code == 1
        assert told in said

    tamper(engine, "UPDATE audit_head SET hash = 'x'")
    assert "ends with another entry 5 than" in run("export", str(file), *where)[2]
    note(repository)
    assert "entry 6 was changed" in run("export", str(file), *where)[2], "it does not follow the fifth"
    tamper(engine, "UPDATE audit_head SET number = 3")
    assert "the audit trail has 3: its end was cut off" in run("export", str(file), *where)[2]
    assert file.read_text().splitlines() == lines


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "expected number and hash"),
        (b"{}\n", "number: Field required"),
        (b'{"number": 0, "hash": "' + b"0" * 64 + b'"}', "number: Input should be greater"),
        (b'{"number": 1, "hash": "x"}', "hash: String should match"),
        (b"[" * 100_000, "expected number and hash"),
        (b"\xff\xfe\n", "expected number and hash"),
    ],
)
def test_what_is_no_anchor_is_refused(tmp_path: Path, run: Run, content: bytes, told: str) -> None:
    file = tmp_path / "anchor"
    file.write_bytes(content)
    code, _, said = run("verify", str(file), "--anchor", str(file))
    assert code == 1
    assert told in said


@pytest.mark.parametrize(
    "content", [b"{}\n", b"[" * 100_000, b"\xff\n", b'{"number": NaN}\n', b"x" * (1 << 21)]
)
def test_what_is_no_export_is_refused(tmp_path: Path, run: Run, content: bytes) -> None:
    file = tmp_path / "trail.jsonl"
    file.write_bytes(content)
    code, _, said = run("verify", str(file))
    assert code == 1
    assert f"{file}, line 1: " in said


def test_a_file_that_is_not_there_is_named(tmp_path: Path, run: Run) -> None:
    assert "No such file" in run("verify", str(tmp_path / "none"))[2]
    assert "expected an SQLite file" in run("verify", "--config", str(empty(tmp_path)))[2]


def empty(directory: Path) -> Path:
    config = directory / "empty.toml"
    config.write_text(f"data_directory = {json.dumps(str(directory / 'nothing'))}\n")
    return config
