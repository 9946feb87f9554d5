"""Killed at any time, making and restoring leave the old state or the new one, and nothing in between."""

import os
import shutil
import signal
import time
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path

import pytest

from service.backup.making import Source, backup_directory, make_backup
from service.backup.restoring import Place, restore_backup
from service.backup.verification import verify_backup
from tests.service.backup.conftest import Data, Rows

pytestmark = pytest.mark.campaign

STEPS = 8
LONGEST_S = 60.0


def killed_after(work: Callable[[], None], delay_s: float) -> bool:
    """Do the work in a process that is killed after a while; return whether it had ended by itself."""
    process = get_context("fork").Process(target=work)
    process.start()
    process.join(delay_s)
    if process.exitcode is None:
        assert process.pid is not None
        os.kill(process.pid, signal.SIGKILL)
        process.join(LONGEST_S)
    assert process.exitcode in (0, -signal.SIGKILL)
    return process.exitcode == 0


def took_s(work: Callable[[], None]) -> float:
    began_s = time.monotonic()
    assert killed_after(work, LONGEST_S)
    return time.monotonic() - began_s


def test_restoring_is_all_or_nothing(data: Data, tmp_path: Path, look: Callable[[str], Rows]) -> None:
    for number in range(5):
        data.record(f"OLD{number}")
    data.back_up()
    backed_up = data.rows()
    data.record("SINCE")
    place = Place(data.store.root.parent, data.url, data.store.root)

    def restore() -> None:
        restore_backup(data.directory, place, overwrite=True)

    data.engine.dispose()
    longest_s = took_s(restore)
    assert look(data.url) == backed_up
    outcomes = set()
    for step in range(STEPS):
        data.record(f"SINCE{step}")
        since = data.rows()
        data.engine.dispose()
        ended = killed_after(restore, longest_s * (step + 1) / STEPS)
        found = look(data.url)
        assert found in (since, backed_up), f"killed at step {step}"
        assert not ended or found == backed_up
        outcomes.add(found == backed_up)
        if found == since:
            assert killed_after(restore, LONGEST_S), "it can be restored afterwards"
            assert look(data.url) == backed_up
    assert False in outcomes, "it was killed before the end at least once"
    assert tmp_path


@pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)
def test_killed_while_a_back_up_is_made_the_earlier_ones_stay(data: Data, tmp_path: Path) -> None:
    data.record("FIRST")
    first = data.back_up().manifest.name
    for number in range(30):
        data.record(f"LATER{number}")
    source = Source(data.url, data.store.root, {})
    data.engine.dispose()

    def make(directory: Path) -> None:
        with backup_directory(directory, source):
            make_backup(source, directory)

    trial = tmp_path / "trial"
    shutil.copytree(data.directory, trial)
    longest_s = took_s(lambda: make(trial))
    for step in range(STEPS):
        ended = killed_after(lambda: make(data.directory), longest_s * (step + 0.5) / STEPS)
        names = [path.name for path in data.directory.glob("backup-*")]
        assert first in names
        for name in names:
            assert verify_backup(data.directory / name).problems == (), f"killed at step {step}"
        assert not ended or len(names) > 1
    make(data.directory)
    assert list(data.directory.glob("incomplete-*")) == [], "what was left is removed"
    assert verify_backup(data.directory).manifest.recordings == 31
