"""Whoever wants to know that machine code is being made: half a minute, once after an installation."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from typing import Final

Watch = Callable[[int, int], AbstractContextManager[object]]
"""Is entered while one function is compiled, with how many are ready and how many there are."""

_watches: Final[list[Watch]] = []


@contextmanager
def watched(watch: Watch) -> Iterator[None]:
    """Have somebody told of each function that is compiled in the block.

    Parameters
    ----------
    watch : callable
        Takes how many functions have been compiled and how many there are; what it returns is entered while
        the next one is compiled.

    Yields
    ------
    None
        While the block runs.
    """
    _watches.append(watch)
    try:
        yield
    finally:
        _watches.remove(watch)


def entered(ready: int, of: int) -> ExitStack:
    """Enter what all who watch return; it is for the caller to close."""
    stack = ExitStack()
    for watch in _watches:
        stack.enter_context(watch(ready, of))
    return stack
