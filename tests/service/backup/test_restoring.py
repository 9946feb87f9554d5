"""What is in the place of a back-up already: kept, or replaced where somebody says so."""

import fcntl
from collections.abc import Callable
from pathlib import Path

import pytest

from service.backup.errors import BackupError
from service.backup.restoring import Place, restore_backup
from service.process.single_instance import AlreadyRunningError
from service.storage import connect
from tests.service.backup.conftest import Data, Rows, files_below


def own_place(data: Data) -> Place:
    return Place(data.store.root.parent, data.url, data.store.root)


def test_a_database_that_is_there_is_replaced_only_where_somebody_says_so(
    data: Data, look: Callable[[str], Rows]
) -> None:
    data.record("BEFORE")
    data.back_up()
    before = data.rows()
    data.record("SINCE")
    since = data.rows()
    data.engine.dispose()
    with pytest.raises(BackupError, match=r"(is|has tables) (there )?already.*--overwrite"):
        restore_backup(data.directory, own_place(data))
    assert look(data.url) == since
    restored = restore_backup(data.directory, own_place(data), overwrite=True)
    assert look(data.url) == before
    assert restored.added == 0
    names = {Path(path).name for path in files_below(data.store.root)}
    assert {"BEFORE.CFG", "SINCE.CFG"} <= names, "what it does not know is the service's to remove"
    if restored.former is not None:
        assert look(f"sqlite:///{restored.former}") == since
    else:
        assert data.url.startswith("postgresql")


def test_a_recording_that_is_damaged_in_its_place_is_replaced(data: Data) -> None:
    data.record("R")
    data.back_up()
    whole = files_below(data.store.root)
    next(data.store.root.glob("??/*/R.DAT")).write_bytes(b"damaged")
    data.engine.dispose()
    assert restore_backup(data.directory, own_place(data), overwrite=True).added == 1
    assert files_below(data.store.root) == whole


def test_a_service_that_runs_keeps_its_data(data: Data) -> None:
    data.record("R")
    data.back_up()
    data.engine.dispose()
    with (data.store.root.parent / "service.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(AlreadyRunningError, match="another service works on this data directory"):
            restore_backup(data.directory, own_place(data), overwrite=True)


def test_a_database_that_somebody_uses_is_not_replaced(data: Data) -> None:
    data.record("R")
    data.back_up()
    with data.engine.connect() as other:
        other.exec_driver_sql("SELECT count(*) FROM motors").scalar()
        with pytest.raises(BackupError, match=r"another program uses|other connections use"):
            restore_backup(data.directory, own_place(data), overwrite=True)


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_a_damaged_database_is_replaced_too_and_kept(data: Data, look: Callable[[str], Rows]) -> None:
    """That is what a back-up is for."""
    data.record("R")
    data.back_up()
    before = data.rows()
    data.engine.dispose()
    file = Path(data.url.removeprefix("sqlite:///"))
    file.write_bytes(b"no database any more")
    file.with_name(f"{file.name}-wal").write_bytes(b"nor this")
    restored = restore_backup(data.directory, own_place(data), overwrite=True)
    assert look(data.url) == before
    assert restored.former is not None
    assert restored.former.read_bytes() == b"no database any more"


def test_the_audit_trail_is_guarded_again(data: Data, empty_place: Place) -> None:
    data.record("R")
    data.back_up()
    restore_backup(data.directory, empty_place)
    engine = connect(empty_place.database_url)
    with pytest.raises(Exception, match="audit trail"), engine.begin() as connection:
        connection.exec_driver_sql("DELETE FROM audit_head")
    engine.dispose()
