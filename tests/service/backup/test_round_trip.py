"""What is backed up while the service runs comes back as it was, on either database."""

import json
import stat
import subprocess
from collections.abc import Callable
from itertools import count
from threading import Event, Thread

import pytest

from core.condition.kinds import Kind
from service.backup.errors import BackupError, BackupStoppedError
from service.backup.layout import POOL
from service.backup.manifest import read_sums
from service.backup.restoring import Place, restore_backup
from service.backup.verification import verify_backup
from service.retention.deletion import delete_recording
from service.storage import Repository, connect, migrate
from service.storage.records import SERVICE, InspectionPicture, NewInspection, NewPasskey, Role
from service.storage.states import BackupState, InspectionOutcome
from testing.service.accounts import TESTS
from testing.service.pictures import SMALL_PNG
from testing.service.plants import NOW_NS
from testing.waiting import eventually
from tests.service.backup.conftest import Data, Rows, files_below, new_name


def test_database_and_recordings_come_back_in_an_empty_place(
    data: Data, empty_place: Place, look: Callable[[str], Rows]
) -> None:
    for number in range(3):
        data.record(f"R{number}")
    found = NewInspection(NOW_NS, Kind.SHORTED_TURNS, "shorted turns", InspectionOutcome.CONFIRMED, "coil 7")
    picture = InspectionPicture("image/png", SMALL_PNG)
    told = data.repository.add_inspection("PUMP-A1", found, [picture], by=SERVICE, now_ns=NOW_NS)
    made = data.back_up()
    assert (made.manifest.recordings, made.copied, made.manifest.lost) == (3, 3, [])
    before = data.rows()
    restored = restore_backup(data.directory, empty_place)
    assert (restored.added, restored.former) == (3, None)
    assert look(empty_place.database_url) == before
    assert files_below(empty_place.recordings) == files_below(data.store.root)
    migrate(empty_place.database_url)
    engine = connect(empty_place.database_url)
    again = Repository(engine)
    assert again.request_diagnosis(again.recordings(limit=1).items[0].id, now_ns=NOW_NS)
    assert again.inspection_picture("PUMP-A1", told.id, 1) == picture
    assert again.latest_verified_backup() is None, "that one was under way when it was copied"
    engine.dispose()


def test_second_factors_come_back_with_their_users(data: Data, empty_place: Place) -> None:
    new = NewPasskey("credential", "a public key", 7)
    data.repository.add_user("anna", [Role.VIEWER], password=None, by=TESTS, now_ns=NOW_NS)
    kept, _ = data.repository.add_passkey(
        "anna", "blue key", new, most=1, codes=["a" * 64], keeps="", by=TESTS, now_ns=NOW_NS
    )
    assert data.repository.use_once("b" * 64, expires_ns=NOW_NS + 9, now_ns=NOW_NS)
    data.back_up()
    restore_backup(data.directory, empty_place)
    engine = connect(empty_place.database_url)
    again = Repository(engine)
    assert again.passkeys("anna") == [kept]
    assert again.recovery_codes_left("anna") == 1
    assert not again.use_passkey(kept.id, 7, now_ns=NOW_NS), "the counter goes on where it was"
    assert not again.use_once("b" * 64, expires_ns=NOW_NS + 9, now_ns=NOW_NS), "what was used stays used"
    engine.dispose()


def test_the_database_knows_that_it_was_backed_up(data: Data) -> None:
    data.record("R")
    made = data.back_up()
    latest = data.repository.latest_verified_backup()
    assert latest is not None
    assert (latest.state, latest.name) == (BackupState.VERIFIED, made.manifest.name)
    assert (latest.recordings, latest.files) == (1, made.manifest.files)
    assert latest.directory == str(data.directory)


def test_what_an_earlier_back_up_has_is_not_copied_again(data: Data) -> None:
    data.record("FIRST")
    first = data.back_up()
    inodes = {path: path.stat().st_ino for path in (data.directory / POOL).glob("??/*/*")}
    data.record("SECOND")
    second = data.back_up()
    assert (first.copied, second.copied, second.manifest.recordings) == (1, 1, 2)
    assert {path: path.stat().st_ino for path in inodes} == inodes
    for made in (first, second):
        verify_backup(data.directory / made.manifest.name).require_whole()


def test_a_damaged_recording_in_the_back_up_is_copied_again(data: Data) -> None:
    data.record("R")
    data.back_up()
    damaged = next((data.directory / POOL).glob("??/*/R.DAT"))
    damaged.write_bytes(b"damaged")
    verified = verify_backup(data.directory)
    assert any("R.DAT: expected SHA-256" in problem for problem in verified.problems)
    with pytest.raises(BackupError, match=r"is not whole: .*R\.DAT: expected SHA-256"):
        verified.require_whole()
    assert data.back_up().copied == 1
    assert verify_backup(data.directory).problems == ()


def test_a_recording_that_is_lost_already_keeps_no_back_up_from_being_made(
    data: Data, empty_place: Place
) -> None:
    data.record("WHOLE")
    data.record("LOST")
    folder = next(data.store.root.glob("??/*/LOST.DAT")).parent
    (folder / "LOST.DAT").write_bytes(b"not that")
    made = data.back_up()
    assert made.manifest.recordings == 1
    (lost,) = made.manifest.lost
    assert lost.digest == folder.name
    assert "their hashes differ" in lost.problem
    assert restore_backup(data.directory, empty_place).added == 1


def test_the_oldest_back_ups_go_with_what_they_alone_had(data: Data) -> None:
    first = data.record("FIRST")
    names = [data.back_up().manifest.name]
    delete_recording(data.repository, first, "a test", now_ns=NOW_NS)
    data.record("SECOND")
    names += [data.back_up(keep=2).manifest.name]
    assert len(list((data.directory / POOL).glob("??/*"))) == 2
    made = data.back_up(keep=2)
    assert made.removed == (names[0],)
    assert [path.name for path in (data.directory / POOL).glob("??/*/*.CFG")] == ["SECOND.CFG"]
    assert {path.name for path in data.directory.glob("backup-*")} == {names[1], made.manifest.name}
    verify_backup(data.directory / names[1]).require_whole()


def test_nobody_else_may_read_a_back_up(data: Data) -> None:
    data.record("R")
    data.back_up()
    for path in (data.directory, *data.directory.rglob("*")):
        mode = stat.S_IMODE(path.stat().st_mode)
        assert mode == (0o700 if path.is_dir() else 0o600), path


def test_common_tools_verify_it_too(data: Data) -> None:
    data.record("R")
    name = data.back_up().manifest.name
    check = ["sha256sum", "--check", "--strict", "--quiet", f"{name}/SHA256SUMS"]
    subprocess.run(check, cwd=data.directory, check=True)


def test_a_back_up_is_consistent_while_recordings_come_and_go(data: Data, empty_place: Place) -> None:
    """Every recording that its database names is in it, though others write and delete all the time."""
    ended = Event()
    changes = count()

    def come_and_go() -> None:
        ids: list[str] = []
        while not ended.is_set():
            ids.append(data.record(new_name()))
            if len(ids) > 5:
                delete_recording(data.repository, ids.pop(0), "a test", now_ns=NOW_NS)
            next(changes)

    writer = Thread(target=come_and_go)
    writer.start()
    try:
        assert eventually(lambda: next(changes) > 10)
        made = [data.back_up() for _ in range(3)]
    finally:
        ended.set()
        writer.join()
    for one in made:
        assert one.manifest.lost == []
        verify_backup(data.directory / one.manifest.name).require_whole()
    restored = restore_backup(data.directory, empty_place)
    assert restored.added == made[-1].manifest.recordings > 0


def test_one_that_is_stopped_leaves_the_earlier_ones_as_they_were(data: Data) -> None:
    data.record("R")
    name = data.back_up().manifest.name
    data.record("S")
    stopping = Event()
    stopping.set()
    with pytest.raises(BackupStoppedError, match="stopped before it was complete"):
        data.back_up(stopping=stopping)
    assert verify_backup(data.directory).manifest.name == name
    assert data.repository.backups(limit=1).items[0].state is BackupState.FAILED
    assert data.back_up().copied == 1
    assert list(data.directory.glob("incomplete-*")) == []


@pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)
def test_numbers_that_postgresql_gives_go_on_behind_the_restored_ones(data: Data, empty_place: Place) -> None:
    data.record("R")
    with data.engine.connect() as connection:
        serial = "SELECT count(*) FROM pg_sequences WHERE schemaname = current_schema()"
        assert connection.exec_driver_sql(serial).scalar(), "there are such numbers"
        connection.exec_driver_sql("SELECT nextval('alarm_changes_sequence_seq')")
    data.back_up()
    restore_backup(data.directory, empty_place)
    engine = connect(empty_place.database_url)
    with engine.connect() as connection:
        largest = connection.exec_driver_sql("SELECT coalesce(max(sequence), 0) FROM alarm_changes").scalar()
        following = connection.exec_driver_sql("SELECT nextval('alarm_changes_sequence_seq')").scalar()
    engine.dispose()
    assert following == (largest or 0) + 1


def test_the_list_names_each_file_once(data: Data) -> None:
    data.record("R")
    data.record("R", motor="FAN-A2")  # the same content: one folder
    name = data.back_up().manifest.name
    files = list(read_sums(data.directory, name))
    assert len({file.path for file in files}) == len(files)
    assert {file.file_name for file in files if file.digest is not None} == {"R.CFG", "R.DAT"}
    manifest = json.loads((data.directory / name / "manifest.json").read_text())
    assert (manifest["recordings"], manifest["files"]) == (1, len(files))
