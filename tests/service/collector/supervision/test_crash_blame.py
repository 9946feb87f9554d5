"""Which relay is blamed for a gateway's crash, and how one is found among several."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.visit_marks import VisitMarks
from service.collector.supervision.crash_blame import blame_after_end
from service.storage import Repository
from service.storage.records import Quarantine
from service.storage.states import AlarmKind, LinkState
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

A, B = "A1_SEL710", "A2_SEL710"
CRASH = -signal.SIGSEGV
PAUSE_S = 60.0
POLICY = QuarantinePolicy.starting_with(PAUSE_S)


def pause_s(quarantine: Quarantine | None) -> float:
    assert quarantine is not None
    return quarantine.pause_s


def crash_in(directory: Path, *, busy: tuple[str, ...], idle: tuple[str, ...] = ()) -> int:
    """A process that visits relays and crashes; its exit code."""
    program = f"""
import os, signal
from contextlib import ExitStack
from pathlib import Path
from service.collector.session.visit_marks import VisitMarks
with ExitStack() as stack:
    marks = VisitMarks(Path({str(directory)!r}))
    visited = {{relay: stack.enter_context(marks.mark(relay)) for relay in {busy + idle!r}}}
    for relay in {idle!r}:
        stack.enter_context(visited[relay].idle())
    os.kill(os.getpid(), signal.SIGSEGV)
"""
    return subprocess.run([sys.executable, "-c", program], check=False, timeout=30).returncode


def test_the_relay_the_gateway_was_busy_with_is_set_aside(repository: Repository, tmp_path: Path) -> None:
    marks = VisitMarks(tmp_path / "visiting" / "0")
    exit_code = crash_in(tmp_path / "visiting" / "0", busy=(A,), idle=(B,))
    assert exit_code == CRASH
    blame_after_end(marks, exit_code, repository, POLICY)
    ied = repository.relay(A)
    assert ied.link_state is LinkState.QUARANTINED
    assert "its answers crashed the gateway (SIGSEGV)" in (ied.link_reason or "")
    assert pause_s(repository.quarantine(A)) == PAUSE_S
    assert [alarm.kind for alarm in repository.standing_alarms(A)] == [AlarmKind.QUARANTINED]
    assert repository.quarantine(B) is None
    assert marks.suspects() == frozenset()


@pytest.mark.parametrize("exit_code", [0, 3, -signal.SIGKILL, -signal.SIGTERM, None])
def test_an_end_that_is_no_crash_blames_nobody(
    repository: Repository, tmp_path: Path, exit_code: int | None
) -> None:
    marks = VisitMarks(tmp_path / "visiting")
    with marks.mark(A):
        blame_after_end(marks, exit_code, repository, POLICY)
    assert repository.quarantines() == ()


def test_of_several_suspects_the_next_crash_finds_the_one(repository: Repository, tmp_path: Path) -> None:
    marks = VisitMarks(tmp_path / "visiting")
    with marks.mark(A), marks.mark(B):
        blame_after_end(marks, CRASH, repository, POLICY)
    assert [(each.ied, each.times, pause_s(each)) for each in repository.quarantines()] == [
        (A, 0, 0.0),
        (B, 0, POLICY.probation_s),
    ]
    assert repository.standing_alarms(A) == repository.standing_alarms(B) == ()
    with marks.mark(A):  # B is not visited yet
        blame_after_end(marks, CRASH, repository, POLICY)
    assert pause_s(repository.quarantine(A)) == PAUSE_S


def test_a_crash_between_requests_makes_all_visited_suspects(repository: Repository, tmp_path: Path) -> None:
    marks = VisitMarks(tmp_path / "visiting")
    with marks.mark(A) as a, marks.mark(B) as b, a.idle(), b.idle():
        blame_after_end(marks, CRASH, repository, POLICY)
    assert {each.ied for each in repository.quarantines()} == {A, B}


def test_what_is_no_relay_is_not_blamed_and_hides_nobody(repository: Repository, tmp_path: Path) -> None:
    marks = VisitMarks(tmp_path / "visiting")
    (tmp_path / "visiting" / "a folder").mkdir(parents=True)
    with marks.mark("NOT-A-RELAY"), marks.mark(A):
        blame_after_end(marks, CRASH, repository, POLICY)
    assert [(each.ied, each.times) for each in repository.quarantines()] == [(A, 1)]
