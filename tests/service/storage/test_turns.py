"""Threads that wait for their turn to write: in their order, ahead of it, or too long."""

import time
from threading import Thread

import pytest
from sqlalchemy.exc import TimeoutError  # noqa: A004 - that of the database

from service.storage.repository.turns import Turns
from testing.waiting import eventually


def start_waiting(turns: Turns, names: str, order: list[str]) -> list[Thread]:
    """Let threads wait, one after the other; those in capitals go ahead."""
    threads: list[Thread] = []
    for name in names:
        threads.append(Thread(target=_write, args=(turns, name, order)))
        threads[-1].start()
        assert eventually(lambda: len(turns._waiting) == len(threads))
    return threads


def _write(turns: Turns, name: str, order: list[str]) -> None:
    with turns.one(ahead=name.isupper()):
        order.append(name)


def test_threads_write_in_the_order_they_came_and_some_ahead() -> None:
    turns, order = Turns(30.0), list[str]()
    with turns.one(ahead=False):
        threads = start_waiting(turns, "abcXdeY", order)
        assert order == []
    for thread in threads:
        thread.join(10)
    assert order == ["Y", "X", "a", "b", "c", "d", "e"]


def test_who_waits_too_long_is_told_and_holds_nobody_up() -> None:
    turns, order = Turns(0.05), list[str]()
    begun_s = time.monotonic()
    told = pytest.raises(TimeoutError, match=r"have been writing for 0\.05 s")
    with turns.one(ahead=True), told, turns.one(ahead=False):
        order.append("never")
    assert time.monotonic() - begun_s < 10
    with turns.one(ahead=False):
        order.append("next")
    assert order == ["next"]


def test_a_block_that_fails_passes_its_turn_on() -> None:
    turns = Turns(1.0)
    with pytest.raises(ValueError, match="lost"), turns.one(ahead=False):
        raise ValueError("lost")
    with turns.one(ahead=False):
        pass
