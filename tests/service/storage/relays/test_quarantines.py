"""Quarantines as they are stored: how long each lasts, and what ends it."""

import os

import pytest

from service.storage import Repository
from service.storage.records import Quarantine
from service.storage.states import LinkState
from service.timing.backoff import Backoff
from testing.service.plants import NOW_NS, SECOND_NS

A, B = "A1_SEL710", "A2_SEL710"
PAUSE_S = 60.0


def pause_s(quarantine: Quarantine | None) -> float:
    assert quarantine is not None
    return quarantine.pause_s


def test_pauses_grow_up_to_a_day(repository: Repository) -> None:
    found = [
        repository.set_aside(A, "why", backoff=Backoff(PAUSE_S, 86_400.0), now_ns=NOW_NS) for _ in range(200)
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
    found = repository.set_aside(A, "why", backoff=Backoff(PAUSE_S, 86_400.0), now_ns=NOW_NS)
    assert found.holds(NOW_NS + round(now_s * SECOND_NS)) is holds


def test_a_suspect_that_comes_back_at_once_is_not_held(repository: Repository) -> None:
    repository.suspect([A], "why", pause_s=0.0, now_ns=NOW_NS)
    assert not any(each.holds(NOW_NS) for each in repository.quarantines())


def test_the_end_of_a_gateway_leaves_a_quarantine(repository: Repository) -> None:
    repository.register_gateway("g", host="h", process_id=os.getpid(), now_ns=NOW_NS)
    repository.share_relays("g", {A, B}, most=2, problem=None)
    repository.set_aside(A, "why", backoff=Backoff(PAUSE_S, 86_400.0), now_ns=NOW_NS)
    repository.end_gateway("g", now_ns=NOW_NS)
    repository.reset_links(now_ns=NOW_NS)
    assert repository.relay(A).link_state is LinkState.QUARANTINED
