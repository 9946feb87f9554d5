"""The parts that run while the service runs: gateways, job runner, background workers."""

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Protocol


class Part(Protocol):
    """Works in threads or processes of its own, from `start` to `stop`."""

    def start(self) -> None:
        """Begin to work."""
        ...

    def stop(self) -> None:
        """End the work and wait for its end. Does nothing where the part has not started."""
        ...

    def problem(self) -> str | None:
        """Return why the part does not work at present; None while all is well."""
        ...


@contextmanager
def running(parts: Iterable[Part]) -> Iterator[None]:
    """Start the parts in their order, and stop them in the opposite order when the block ends."""
    with ExitStack() as started:
        for part in parts:
            started.callback(part.stop)  # first, because a signal may interrupt the start
            part.start()
        yield
