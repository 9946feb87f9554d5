"""Who is blamed for a gateway's crash, for how long, and how a relay comes back."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from service.collector.session import relay_session
from service.collector.session.protocol_faults import (
    FAULTS_IN_A_ROW,
    PROBATION_S,
    ProtocolFaultCounter,
    blame_after_end,
)
from service.collector.session.visit_marks import VisitMarks
from service.storage import Repository
from service.storage.records import Quarantine
from service.storage.states import AlarmKind, LinkState
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import eventually
from tests.hostile.dialogue import overheard
from tests.hostile.relay import LIST_OF_NAMES, lying
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

A, B = "A1_SEL710", "A2_SEL710"
CRASH = -signal.SIGSEGV
PAUSE_S = 60.0


def pause_s(quarantine: Quarantine | None) -> float:
    assert quarantine is not None
    return (quarantine.until_ns - quarantine.since_ns) / SECOND_NS


def crash_in(directory: Path, *, busy: tuple[str, ...], waiting: tuple[str, ...] = ()) -> int:
    """A process that visits relays and crashes; its exit code."""
    program = f"""
import os, signal
from contextlib import ExitStack
from pathlib import Path
from service.collector.session.visit_marks import VisitMarks
with ExitStack() as stack:
    visits = VisitMarks(Path({str(directory)!r}))
    marks = {{relay: stack.enter_context(visits.mark(relay)) for relay in {busy + waiting!r}}}
    for relay in {waiting!r}:
        stack.enter_context(marks[relay].waiting())
    os.kill(os.getpid(), signal.SIGSEGV)
"""
    return subprocess.run([sys.executable, "-c", program], check=False, timeout=30).returncode


def test_the_relay_the_gateway_was_busy_with_is_set_aside(repository: Repository, tmp_path: Path) -> None:
    visits = VisitMarks(tmp_path / "visiting" / "0")
    exit_code = crash_in(tmp_path / "visiting" / "0", busy=(A,), waiting=(B,))
    assert exit_code == CRASH
    blame_after_end(visits, exit_code, repository, first_pause_s=PAUSE_S)
    ied = repository.ied(A)
    assert ied.link_state is LinkState.QUARANTINED
    assert "its answers crashed the gateway (SIGSEGV)" in (ied.link_reason or "")
    assert pause_s(repository.quarantine(A)) == PAUSE_S
    assert [alarm.kind for alarm in repository.standing_alarms(A)] == [AlarmKind.QUARANTINED]
    assert repository.quarantine(B) is None
    assert visits.suspects() == frozenset()


@pytest.mark.parametrize("exit_code", [0, 3, -signal.SIGKILL, -signal.SIGTERM, None])
def test_an_end_that_is_no_crash_blames_nobody(
    repository: Repository, tmp_path: Path, exit_code: int | None
) -> None:
    visits = VisitMarks(tmp_path / "visiting")
    with visits.mark(A):
        blame_after_end(visits, exit_code, repository, first_pause_s=PAUSE_S)
    assert repository.quarantines() == ()


def test_of_several_suspects_the_next_crash_finds_the_one(repository: Repository, tmp_path: Path) -> None:
    visits = VisitMarks(tmp_path / "visiting")
    with visits.mark(A), visits.mark(B):
        blame_after_end(visits, CRASH, repository, first_pause_s=PAUSE_S)
    assert [(each.ied, each.times, pause_s(each)) for each in repository.quarantines()] == [
        (A, 0, 0.0),
        (B, 0, PROBATION_S),
    ]
    assert repository.standing_alarms(A) == repository.standing_alarms(B) == ()
    with visits.mark(A):  # B is not visited yet
        blame_after_end(visits, CRASH, repository, first_pause_s=PAUSE_S)
    assert pause_s(repository.quarantine(A)) == PAUSE_S


def test_a_crash_between_requests_makes_all_visited_suspects(repository: Repository, tmp_path: Path) -> None:
    visits = VisitMarks(tmp_path / "visiting")
    with visits.mark(A) as a, visits.mark(B) as b, a.waiting(), b.waiting():
        blame_after_end(visits, CRASH, repository, first_pause_s=PAUSE_S)
    assert {each.ied for each in repository.quarantines()} == {A, B}


def test_what_is_no_relay_is_not_blamed_and_hides_nobody(repository: Repository, tmp_path: Path) -> None:
    visits = VisitMarks(tmp_path / "visiting")
    (tmp_path / "visiting" / "a folder").mkdir(parents=True)
    with visits.mark("NOT-A-RELAY"), visits.mark(A):
        blame_after_end(visits, CRASH, repository, first_pause_s=PAUSE_S)
    assert [(each.ied, each.times) for each in repository.quarantines()] == [(A, 1)]


def test_a_relay_whose_name_is_a_path_is_marked_inside(tmp_path: Path) -> None:
    visits = VisitMarks(tmp_path / "marks")
    with visits.mark("../../X"):
        assert visits.suspects() == {"../../X"}
        assert [path.name for path in tmp_path.iterdir()] == ["marks"]
    assert visits.suspects() == frozenset()


def test_pauses_grow_up_to_a_day(repository: Repository) -> None:
    found = [
        repository.set_aside(A, "why", first_pause_s=PAUSE_S, longest_pause_s=86_400.0, now_ns=NOW_NS)
        for _ in range(200)
    ]
    assert [pause_s(each) for each in found[:3]] == [60.0, 120.0, 240.0]
    assert pause_s(found[-1]) == 86_400.0
    assert found[-1].times == 200


@pytest.mark.parametrize(
    ("now_s", "holds"),
    [
        (0.0, True),
        (PAUSE_S - 1, True),
        (PAUSE_S, False),
        (-1.0, True),  # another host's clock is behind
        (-PAUSE_S, False),  # the clock was ahead and is put right
        (-86_400.0, False),
    ],
)
def test_a_quarantine_holds_no_longer_than_its_length_whatever_the_clock_says(
    repository: Repository, now_s: float, *, holds: bool
) -> None:
    found = repository.set_aside(A, "why", first_pause_s=PAUSE_S, longest_pause_s=86_400.0, now_ns=NOW_NS)
    assert found.holds(NOW_NS + round(now_s * SECOND_NS)) is holds


def test_a_suspect_that_comes_back_at_once_is_not_held(repository: Repository) -> None:
    repository.suspect([A], "why", pause_s=0.0, now_ns=NOW_NS)
    assert not any(each.holds(NOW_NS) for each in repository.quarantines())


def test_who_breaks_the_protocol_again_and_again_is_set_aside(repository: Repository) -> None:
    conduct = ProtocolFaultCounter(A, repository, first_pause_s=PAUSE_S)
    told = [conduct.broke_the_protocol("nonsense") for _ in range(FAULTS_IN_A_ROW)]
    assert told == [False] * (FAULTS_IN_A_ROW - 1) + [True]
    assert "broke the protocol 5 times in a row, at last: nonsense" in (repository.ied(A).link_reason or "")


def test_a_relay_that_answers_with_nonsense_is_set_aside_with_its_reason(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(relay_session, "FIRST_RETRY_S", 0.01)
    with lying(overheard(), {LIST_OF_NAMES: lambda _: b"\xa1\x00"}) as port:
        bench.relay = replace(bench.relay, port=port)
        with bench.session():
            assert eventually(lambda: bench.link() is LinkState.QUARANTINED)
    reason = bench.repository.ied(NAME).link_reason or ""
    assert f"broke the protocol {FAULTS_IN_A_ROW} times in a row" in reason
    assert "connect: malformed message" in reason


def test_good_visits_between_count(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    conduct = ProtocolFaultCounter(A, repository, first_pause_s=PAUSE_S)
    for _ in range(3 * FAULTS_IN_A_ROW):
        conduct.visited()
        now_s += 11.0
        conduct.answered()
        assert not conduct.broke_the_protocol("nonsense")


def test_a_relay_that_works_as_long_as_it_was_set_aside_is_trusted(
    repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    repository.set_aside(A, "why", first_pause_s=PAUSE_S, longest_pause_s=86_400.0, now_ns=NOW_NS)
    now_s = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    conduct = ProtocolFaultCounter(A, repository, first_pause_s=PAUSE_S)
    conduct.visited()
    now_s += PAUSE_S - 1
    conduct.answered()
    assert repository.quarantine(A) is not None
    now_s += 2
    conduct.answered()
    assert repository.quarantine(A) is None
    assert repository.standing_alarms(A) == ()


def test_the_end_of_a_gateway_leaves_a_quarantine(repository: Repository) -> None:
    repository.register_gateway("g", host="h", process_id=os.getpid(), now_ns=NOW_NS)
    repository.share_relays("g", {A, B}, most=2)
    repository.set_aside(A, "why", first_pause_s=PAUSE_S, longest_pause_s=86_400.0, now_ns=NOW_NS)
    repository.end_gateway("g", now_ns=NOW_NS)
    repository.reset_links(now_ns=NOW_NS)
    assert repository.ied(A).link_state is LinkState.QUARANTINED
