"""Record which locks are taken while others are held, so that a test can tell whether they may deadlock.

Two threads can only wait for each other for ever if locks are taken in a circle. A test that takes every way
through the code once, on any threads, thus finds a deadlock that needs an unlucky moment to come about.
"""

import inspect
import linecache
import re
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Protocol
from unittest.mock import patch

_ASSIGNED = re.compile(r"\s*(?:self\.)?(\w+)\b[^=]*=")


class _Lock(Protocol):
    """What is used of a lock of threading."""

    def acquire(self, blocking: bool = ..., timeout: float = ...) -> bool: ...

    def release(self) -> None: ...


class LockOrder:
    """Pairs of locks (held, then taken), each by the name of its class and attribute: "Server._lock"."""

    def __init__(self) -> None:
        self.pairs: set[tuple[str, str]] = set()
        self._held = threading.local()

    def taken(self, lock: "_RecordedLock") -> None:
        """Note that the present thread has asked for a lock. Taking one again that it holds is no pair."""
        held = self._locks_held()
        if lock not in held:
            self.pairs.update((each.name, lock.name) for each in held)
        held.append(lock)

    def released(self, lock: "_RecordedLock") -> None:
        """Note that the present thread has released a lock."""
        held = self._locks_held()
        held.reverse()
        held.remove(lock)
        held.reverse()

    def _locks_held(self) -> "list[_RecordedLock]":
        if not hasattr(self._held, "locks"):
            self._held.locks = []
        locks: list[_RecordedLock] = self._held.locks
        return locks

    def circle(self) -> list[str]:
        """Names of locks that are taken in a circle; empty where there is none."""
        following: dict[str, set[str]] = {}
        for first, second in self.pairs:
            following.setdefault(first, set()).add(second)

        def search(path: list[str]) -> list[str]:
            for name in sorted(following.get(path[-1], ())):
                if name in path:
                    return [*path[path.index(name) :], name]
                found = search([*path, name])
                if found:
                    return found
            return []

        return next((found for name in sorted(following) if (found := search([name]))), [])


class _RecordedLock:
    """A lock of threading that tells a LockOrder of itself."""

    def __init__(self, order: LockOrder, name: str, lock: _Lock) -> None:
        self._order = order
        self._lock = lock
        self.name = name

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        self._order.taken(self)
        if self._lock.acquire(blocking, timeout):
            return True
        self._order.released(self)
        return False

    def release(self) -> None:
        self._lock.release()
        self._order.released(self)

    def __enter__(self) -> bool:
        return self.acquire()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()


@contextmanager
def recorded_lock_order(packages: Iterable[str]) -> Iterator[LockOrder]:
    """Record the locks that modules of these packages make within the block."""
    order = LockOrder()
    begins = tuple(f"{package}." for package in packages)

    def recorded(make: Callable[[], _Lock]) -> Callable[[], object]:
        def make_lock() -> object:
            here = inspect.currentframe()
            caller = None if here is None else here.f_back
            if caller is None or not f"{caller.f_globals['__name__']}.".startswith(begins):
                return make()
            return _RecordedLock(order, _name(caller), make())

        return make_lock

    with (
        patch.object(threading, "Lock", recorded(threading.Lock)),
        patch.object(threading, "RLock", recorded(threading.RLock)),
    ):
        yield order


def _name(caller: FrameType) -> str:
    """Name of the lock that is being made: its class, where it has one, and what it is assigned to."""
    line = linecache.getline(caller.f_code.co_filename, caller.f_lineno)
    assigned = _ASSIGNED.match(line)
    assert assigned is not None, f"a lock that is assigned to nothing: {line}"
    owner = caller.f_code.co_qualname.rpartition(".")[0]
    return f"{owner}.{assigned[1]}" if owner else assigned[1]
