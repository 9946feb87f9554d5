"""One service on one data directory, however the last one ended."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from service.process.single_instance import AlreadyRunningError, exclusive

HOLDER = """
import sys, time
from pathlib import Path
from service.process.single_instance import exclusive
with exclusive(Path(sys.argv[1]), wait=False):
    print("held", flush=True)
    time.sleep(60)
"""


def test_a_second_process_is_told_who_is_there(tmp_path: Path) -> None:
    lock = tmp_path / "service.lock"
    with subprocess.Popen([sys.executable, "-c", HOLDER, str(lock)], stdout=subprocess.PIPE) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(AlreadyRunningError, match=str(holder.pid)), exclusive(lock, wait=False):
            pass
        holder.send_signal(signal.SIGKILL)
        with exclusive(lock, wait=True):
            assert lock.read_text().strip() != str(holder.pid)


def test_the_lock_can_be_taken_again(tmp_path: Path) -> None:
    for _ in range(2):
        with exclusive(tmp_path / "service.lock", wait=False):
            pass
