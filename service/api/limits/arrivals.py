"""Uploads on their way: how many there may be at a time, and how slowly each may come."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from http import HTTPStatus

from starlette.exceptions import HTTPException
from starlette.types import Message, Receive

from service.api.limits.admission import Admission

ARRIVING_AT_ONCE = 16
"""Each may fill the temporary folder with as many bytes as an upload may have."""

ARRIVAL_WAIT_S = 10.0

CROWDED_GRACE_S = 1.0
"""While others wait for a place, an upload has to be fast enough after so long."""


class Arrivals:
    """The places of uploads, from the first byte of the body to the answer.

    An upload has to come at `least_rate` [bytes/s] on average, after a grace of `grace_s`. Slower ones give
    way, so that clients who send a byte now and then cannot keep the places from others.
    """

    def __init__(self, *, grace_s: float, least_rate: float) -> None:
        self._grace_s = grace_s
        self._least_rate = least_rate
        self._places = Admission("uploads", ARRIVING_AT_ONCE, wait_s=ARRIVAL_WAIT_S)
        self._under_way: set[_Arrival] = set()
        self._waiting = 0

    @asynccontextmanager
    async def arriving(self, receive: Receive) -> AsyncIterator[Receive]:
        """Hold a place, and receive the body only while it comes fast enough. Raises BusyError."""
        async with AsyncExitStack() as held:
            if self._places.is_full():
                await self._wait_for_place(held)
            else:
                await held.enter_async_context(self._places.admitted())
            arrival = _Arrival(self, receive)
            self._under_way.add(arrival)
            held.callback(self._under_way.discard, arrival)
            yield arrival.receive

    def time_for(self, received_bytes: int) -> float:
        """Return within how many seconds of its beginning so much of an upload has to be there."""
        grace_s = min(self._grace_s, CROWDED_GRACE_S) if self._waiting else self._grace_s
        return grace_s + received_bytes / self._least_rate

    def too_slow(self) -> HTTPException:
        """Return the refusal of an upload that is too slow."""
        detail = (
            f"expected at least {self._least_rate:g} bytes a second; "
            "see min_upload_rate in docs/reference/settings.md"
        )
        return HTTPException(HTTPStatus.REQUEST_TIMEOUT, detail, headers={"Connection": "close"})

    async def _wait_for_place(self, held: AsyncExitStack) -> None:
        self._waiting += 1
        try:
            for arrival in self._under_way:
                arrival.hurry()
            await held.enter_async_context(self._places.admitted())
        finally:
            self._waiting -= 1


class _Arrival:
    """The body of one upload."""

    def __init__(self, arrivals: Arrivals, receive: Receive) -> None:
        self._arrivals = arrivals
        self._receive = receive
        self._begun_s = asyncio.get_running_loop().time()
        self._received_bytes = 0
        self._timeout: asyncio.Timeout | None = None
        self._is_complete = False

    async def receive(self) -> Message:
        if self._is_complete:
            return await self._receive()
        try:
            async with asyncio.timeout_at(self._deadline_s()) as self._timeout:
                message = await self._receive()
        except TimeoutError as error:
            raise self._arrivals.too_slow() from error
        finally:
            self._timeout = None
        self._received_bytes += len(message.get("body", b""))
        self._is_complete = not message.get("more_body", False)
        return message

    def hurry(self) -> None:
        """Apply what the time is now, which is less while others wait."""
        if self._timeout is not None and not self._timeout.expired():
            self._timeout.reschedule(self._deadline_s())

    def _deadline_s(self) -> float:
        return self._begun_s + self._arrivals.time_for(self._received_bytes)
