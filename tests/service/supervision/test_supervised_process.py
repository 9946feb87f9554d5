"""A process of the service is kept running, and never outlives its parent."""

import hashlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from threading import Thread

import pytest
from structlog.testing import capture_logs

from service.configuration.relay_access import RelayAccess, RelayTls
from service.configuration.settings import Settings
from service.supervision import supervised_process
from service.supervision.supervised_process import RestartPolicy, SupervisedProcess
from service.timing.backoff import Backoff
from testing.waiting import eventually

OBEDIENT = "import sys; sys.stdin.readline(); sys.stdin.read()"
STUBBORN = "import time; time.sleep(60)"


def supervisor(script: str, directory: Path) -> SupervisedProcess:
    return SupervisedProcess(
        "the process", (sys.executable, "-c", script), Settings(data_directory=directory)
    )


def test_a_process_that_crashes_is_started_again(tmp_path: Path) -> None:
    supervised = supervisor(OBEDIENT, tmp_path)
    supervised.start()
    try:
        assert eventually(lambda: supervised.process_id is not None)
        first = supervised.process_id
        assert first is not None
        os.kill(first, signal.SIGKILL)
        assert eventually(lambda: supervised.process_id not in (None, first))
    finally:
        supervised.stop()
    assert supervised.process_id is None


def test_stopping_twice_is_stopping(tmp_path: Path) -> None:
    supervised = supervisor(OBEDIENT, tmp_path)
    supervised.start()
    supervised.stop()
    supervised.stop()
    assert supervised.process_id is None


def test_a_stop_just_after_the_start_waits_for_the_settings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    supervised = supervisor(OBEDIENT, tmp_path)
    stopping = Thread(target=supervised.stop)
    send_settings = supervised_process._send_settings

    def slowly(child: "subprocess.Popen[bytes]", settings: Settings, inherited: tuple[int, ...]) -> None:
        stopping.start()
        assert child.stdin is not None
        stdin = child.stdin
        assert not eventually(lambda: stdin.closed, within_s=0.2)
        send_settings(child, settings, inherited)

    monkeypatch.setattr(supervised_process, "_send_settings", slowly)
    supervised.start()
    assert eventually(lambda: stopping.ident is not None)
    stopping.join(10)
    assert not stopping.is_alive()
    assert supervised.process_id is None


def test_a_process_that_does_not_listen_is_killed(tmp_path: Path) -> None:
    supervised = SupervisedProcess(
        "the process",
        (sys.executable, "-c", STUBBORN),
        Settings(data_directory=tmp_path),
        policy=RestartPolicy(stop_timeout_s=0.1),
    )
    supervised.start()
    assert eventually(lambda: supervised.process_id is not None)
    supervised.stop()
    assert supervised.process_id is None


def test_the_settings_of_a_thousand_relays_wait_for_no_process(tmp_path: Path) -> None:
    tls = RelayTls(certificate=tmp_path, key=tmp_path, pinned=(tmp_path, tmp_path), ca=tmp_path)
    relays = {f"A{number}_SEL710": RelayAccess(tls=tls, password_file=tmp_path) for number in range(1000)}
    settings = Settings(data_directory=tmp_path, relays=relays)
    supervised = SupervisedProcess(
        "the process", (sys.executable, "-c", STUBBORN), settings, policy=RestartPolicy(stop_timeout_s=0.2)
    )
    supervised.start()
    assert eventually(lambda: supervised.process_id is not None)
    stopping = Thread(target=supervised.stop, daemon=True)
    stopping.start()
    stopping.join(20)
    assert not stopping.is_alive()


def test_a_process_that_cannot_be_started_is_tried_again(tmp_path: Path) -> None:
    ends: list[float] = []
    supervised = SupervisedProcess(
        "the process",
        (str(tmp_path / "missing"),),
        Settings(data_directory=tmp_path),
        on_exit=lambda _: ends.append(time.monotonic()),
    )
    supervised.start()
    assert eventually(lambda: len(ends) >= 2)
    assert supervised.problem() == "the process is not running"
    supervised.stop()


def test_a_bug_in_what_follows_an_end_keeps_no_process_from_its_restart(tmp_path: Path) -> None:
    ends: list[int | None] = []

    def fail(exit_code: int | None) -> None:
        ends.append(exit_code)
        raise RuntimeError("a bug")

    supervised = SupervisedProcess(
        "the process",
        (sys.executable, "-c", "raise SystemExit(3)"),
        Settings(data_directory=tmp_path),
        on_exit=fail,
    )
    supervised.start()
    assert eventually(lambda: ends[:2] == [3, 3])
    supervised.stop()


@pytest.mark.parametrize(
    ("stable_after_s", "expected_s"),
    [(60.0, [0.001, 0.002, 0.004, 0.004]), (-1.0, [0.001, 0.001, 0.001, 0.001])],
    ids=["it ends at once", "it has run well before each end"],
)
def test_each_further_end_is_waited_for_longer_until_one_has_run_well(
    tmp_path: Path, stable_after_s: float, expected_s: list[float]
) -> None:
    """A collector that ends at once must not keep the machine busy with starting it."""
    ends: list[int | None] = []
    supervised = SupervisedProcess(
        "the process",
        (str(tmp_path / "missing"),),
        Settings(data_directory=tmp_path),
        policy=RestartPolicy(Backoff(first_s=0.001, longest_s=0.004), stable_after_s=stable_after_s),
        on_exit=ends.append,
    )
    with capture_logs() as logs:
        supervised.start()
        assert eventually(lambda: len(ends) > len(expected_s))
        supervised.stop()
    delays_s = [entry["delay_s"] for entry in logs if "delay_s" in entry]
    assert delays_s[: len(expected_s)] == expected_s


def test_the_pauses_of_the_service_begin_short_and_reach_half_a_minute() -> None:
    policy = RestartPolicy()
    assert [policy.backoff.pause_s(failures) for failures in (1, 2, 3, 9, 99)] == [0.2, 0.4, 0.8, 30.0, 30.0]
    assert policy.stable_after_s == 60.0


def test_what_a_process_says_is_heard_line_by_line(tmp_path: Path) -> None:
    heard: list[bytes] = []

    def hear(line: bytes) -> None:
        heard.append(line)
        if line == b"first\n":
            raise RuntimeError("a bug")

    script = "import sys; sys.stdin.readline(); print('first', flush=True); print('x' * 5000, flush=True)"
    supervised = SupervisedProcess(
        "the process",
        (sys.executable, "-c", f"{script}; sys.stdin.read()"),
        Settings(data_directory=tmp_path),
        on_line=hear,
    )
    supervised.start()
    try:
        assert eventually(lambda: len(heard) >= 3)
    finally:
        supervised.stop()
    assert heard == [b"first\n", b"x" * 4096, b"x" * 904 + b"\n"]


def test_a_child_reads_its_settings_and_sees_its_parent_go(tmp_path: Path) -> None:
    script = (
        "from service.supervision.child import begin_child;"
        "child = begin_child('child');"
        "print(child.settings.data_directory, child.parent_gone.is_set(), child.handed, flush=True);"
        "child.parent_gone.wait();"
        "print('gone', flush=True)"
    )
    heard: list[bytes] = []
    supervised = SupervisedProcess(
        "the child", (sys.executable, "-c", script), Settings(data_directory=tmp_path), on_line=heard.append
    )
    supervised.start()
    assert eventually(lambda: bool(heard), within_s=60)
    supervised.stop()
    assert heard == [f"{tmp_path} False b''\n".encode(), b"gone\n"]


def test_every_child_is_handed_what_no_pipe_holds(tmp_path: Path) -> None:
    script = (
        "import hashlib;"
        "from service.supervision.child import begin_child;"
        "print(hashlib.sha256(begin_child('child').handed).hexdigest(), flush=True)"
    )
    handed = os.urandom(3 * supervised_process.PIPE_BYTES)
    heard: list[bytes] = []
    supervised = SupervisedProcess(
        "the child",
        (sys.executable, "-c", script),
        Settings(data_directory=tmp_path),
        handed=handed,
        on_line=heard.append,
    )
    open_before = len(list(Path("/proc/self/fd").iterdir()))
    supervised.start()
    assert eventually(lambda: len(heard) >= 2, within_s=60)
    supervised.stop()
    assert set(heard) == {f"{hashlib.sha256(handed).hexdigest()}\n".encode()}
    assert len(list(Path("/proc/self/fd").iterdir())) == open_before
