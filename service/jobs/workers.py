"""What the job runner asks of its workers, wherever they run."""

from collections.abc import Callable
from concurrent.futures import Future
from typing import Protocol, TypeVar

Argument = TypeVar("Argument")
Result = TypeVar("Result")


class NoWorkersError(RuntimeError):
    """There are no workers at the moment; there will be."""


class WorkerFailedError(RuntimeError):
    """A worker elsewhere has failed; it says with what."""


class Workers(Protocol):
    """Processes that do tasks, behind futures. For use by one thread."""

    @property
    def problem(self) -> str | None:
        """Return why there are no workers at present; None while there are."""
        ...

    def has_ended(self) -> bool:
        """Return whether there are no workers, until `renew` has started some."""
        ...

    def renew(self) -> None:
        """Start workers where there are none and some can be started."""
        ...

    def schedule(
        self, function: Callable[[Argument], Result], task: Argument, timeout_s: float
    ) -> "Future[Result]":
        """Give a task to a worker. Raises NoWorkersError."""
        ...

    def loading(self) -> int:
        """Return how many workers are not ready yet."""
        ...

    def stop(self) -> None:
        """End what is under way."""
        ...
