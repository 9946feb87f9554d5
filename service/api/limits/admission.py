"""Lets so much work in at a time, makes some wait, and turns the rest away."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from service.api.problems import BusyError


class Admission:
    """A limit of what runs at once in one event loop; who waits for longer than `wait_s` is turned away.

    what: that of which there may be `most` at a time, in the plural.
    """

    def __init__(self, what: str, most: int, *, wait_s: float) -> None:
        self._what = what
        self._most = most
        self._turns = asyncio.Semaphore(most)
        self._wait_s = wait_s

    def is_full(self) -> bool:
        """Tell whether whoever comes now has to wait."""
        return self._turns.locked()

    @asynccontextmanager
    async def admitted(self) -> AsyncIterator[None]:
        """Hold one turn while the block runs. Raises BusyError."""
        try:
            async with asyncio.timeout(self._wait_s):
                await self._turns.acquire()
        except TimeoutError as error:
            raise BusyError(self._what, self._most) from error
        try:
            yield
        finally:
            self._turns.release()
