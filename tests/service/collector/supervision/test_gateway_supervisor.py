"""The collector process is kept running, and never outlives its parent."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from threading import Event, Thread

import pytest

from service.collector.supervision.gateway_supervisor import GatewaySupervisor, _hand_over
from service.configuration.relay_access import RelayAccess, RelayTls
from service.configuration.settings import Settings
from testing.waiting import eventually

OBEDIENT = "import sys; sys.stdin.readline(); sys.stdin.read()"
STUBBORN = "import time; time.sleep(60)"


def supervisor(script: str, directory: Path) -> GatewaySupervisor:
    return GatewaySupervisor(Settings(data_directory=directory), (sys.executable, "-c", script))


def test_a_collector_that_crashes_is_started_again(tmp_path: Path) -> None:
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
    hand_over = _hand_over

    def slowly(child: "subprocess.Popen[bytes]", settings: Settings) -> None:
        stopping.start()
        assert child.stdin is not None
        stdin = child.stdin
        assert not eventually(lambda: stdin.closed, within_s=0.2)
        hand_over(child, settings)

    monkeypatch.setattr("service.collector.supervision.gateway_supervisor._hand_over", slowly)
    supervised.start()
    assert eventually(lambda: stopping.ident is not None)
    stopping.join(10)
    assert not stopping.is_alive()
    assert supervised.process_id is None


def test_a_collector_that_does_not_listen_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.collector.supervision.gateway_supervisor.STOP_PATIENCE_S", 0.1)
    supervised = supervisor(STUBBORN, tmp_path)
    supervised.start()
    assert eventually(lambda: supervised.process_id is not None)
    supervised.stop()
    assert supervised.process_id is None


def test_the_settings_of_a_thousand_relays_wait_for_no_collector(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.collector.supervision.gateway_supervisor.STOP_PATIENCE_S", 0.2)
    tls = RelayTls(certificate=tmp_path, key=tmp_path, pinned=(tmp_path, tmp_path), ca=tmp_path)
    relays = {f"A{number}_SEL710": RelayAccess(tls=tls, password_file=tmp_path) for number in range(1000)}
    settings = Settings(data_directory=tmp_path, relays=relays)
    supervised = GatewaySupervisor(settings, (sys.executable, "-c", STUBBORN))
    supervised.start()
    assert eventually(lambda: supervised.process_id is not None)
    stopping = Thread(target=supervised.stop, daemon=True)
    stopping.start()
    stopping.join(20)
    assert not stopping.is_alive()


def test_a_collector_that_cannot_be_started_is_tried_again(tmp_path: Path) -> None:
    ends: list[float] = []
    supervised = GatewaySupervisor(
        Settings(data_directory=tmp_path),
        (str(tmp_path / "missing"),),
        on_end=lambda _: ends.append(time.monotonic()),
    )
    supervised.start()
    assert eventually(lambda: len(ends) >= 2)
    assert supervised.problem() == "the collector process is not running"
    supervised.stop()


class Clock:
    """In the supervisor's place of `time`: it goes on where somebody waits, and nobody waits really."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.waits_s: list[float] = []

    def monotonic(self) -> float:
        return self.now_s

    def event(self) -> Event:
        clock = self

        class Passing(Event):
            def wait(self, timeout: float | None = None) -> bool:
                assert timeout is not None
                clock.waits_s.append(timeout)
                clock.now_s += timeout
                return self.is_set()

        return Passing()


def test_each_further_end_is_waited_for_longer_until_one_has_run_well(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A collector that ends at once must not keep the machine busy with starting it."""
    ran_for_s = iter([0.0] * 10 + [60.0, 60.5, 0.0, 0.0])
    expected_s = [0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6, 30.0, 30.0, 30.0, 0.2, 0.4]
    clock = Clock()
    monkeypatch.setattr("service.collector.supervision.gateway_supervisor.time", clock)
    monkeypatch.setattr("service.collector.supervision.gateway_supervisor.Event", clock.event)
    ended = Event()

    def run(exit_code: int | None) -> None:
        assert exit_code is None
        clock.now_s += next(ran_for_s)
        if len(clock.waits_s) == len(expected_s):
            supervised.ask_to_end()
            ended.set()

    supervised = GatewaySupervisor(
        Settings(data_directory=tmp_path), (str(tmp_path / "missing"),), on_end=run
    )
    supervised.start()
    assert ended.wait(10)
    assert clock.waits_s == pytest.approx(expected_s)
