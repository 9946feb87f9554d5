"""Threads for what waits for the database: few at a time, and nobody waits for them without end."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Final, TypeVar

from asyncua import ua
from asyncua.common.utils import ServiceError

TURN_S: Final = 5.0
"""Longest wait for others whose work is done."""

LONGEST_S: Final = 10.0
"""Longest time for one: the database may be locked, or away."""

Result = TypeVar("Result")


class WorkerThreads:
    """Does one kind of work beside the event loop, for which all clients wait.

    Each kind has threads of its own: where all of one kind hang, the others go on.
    """

    def __init__(self, name: str, at_once: int) -> None:
        self._pool = ThreadPoolExecutor(at_once, f"OPC UA {name}")
        self._turns = asyncio.Semaphore(at_once)

    async def run(self, work: Callable[[], Result]) -> Result:
        """Return what the work gives. Raises ServiceError where there is no turn, or it takes too long."""
        try:
            async with asyncio.timeout(TURN_S):
                await self._turns.acquire()
        except TimeoutError as error:
            raise ServiceError(ua.StatusCodes.BadTooManyOperations) from error
        done = asyncio.get_running_loop().run_in_executor(self._pool, work)
        done.add_done_callback(self._over)
        # A thread cannot be ended: it keeps its turn for as long as it takes, and its client goes.
        await asyncio.wait([done], timeout=LONGEST_S)
        if not done.done():
            raise ServiceError(ua.StatusCodes.BadTimeout)
        return done.result()

    def close(self) -> None:
        """Begin no more."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _over(self, done: "asyncio.Future[Result]") -> None:
        self._turns.release()
        if not done.cancelled():
            done.exception()  # nobody may be there to take it any more
