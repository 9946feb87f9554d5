"""Who does what needs the numbers loaded: workers of the service, or this process where there are none."""

from collections.abc import Callable
from concurrent.futures import Future
from typing import Final, Protocol, TypeVar

Argument = TypeVar("Argument")
Result = TypeVar("Result")

ANSWER_TIMEOUT_S: Final = 10.0
"""Nobody waits longer; a worker that takes longer is replaced."""


class NoAnswerError(RuntimeError):
    """Nobody could do it now; another try may succeed."""


class Compute(Protocol):
    """Have a module-level function done with an argument that can be pickled."""

    def __call__(self, function: Callable[[Argument], Result], argument: Argument, /) -> "Future[Result]":
        """Return what becomes of it; it ends with NoAnswerError where there is nobody."""
        ...


def compute_here(function: Callable[[Argument], Result], argument: Argument, /) -> "Future[Result]":
    """Do the work at once in this thread, for programs without workers."""
    future: Future[Result] = Future()
    future.set_result(function(argument))
    return future
