"""Run by test_goose.py instead of the gateway: its receiver hears a trip, and fails as no socket does."""

from types import TracebackType
from typing import Self
from unittest.mock import patch

from service.gateways.process import main
from tests.service.gateways.goose.test_listener import frame


class FailingSocket:
    """Has one frame."""

    def __init__(self, _interface: str, _groups: object) -> None:
        self._frames = [frame(trip=True)]

    def wait_at_most(self, _timeout_s: float) -> None:
        """Never wait."""

    def receive(self) -> bytes:
        """Return the frame, then fail."""
        if not self._frames:
            raise LookupError("made by the test")
        return self._frames.pop()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        """Nothing is to be closed."""


if __name__ == "__main__":
    with patch("service.gateways.goose.receiver.RawSocket", FailingSocket):
        main()
