"""The plant's state for several connections at once: one thread follows the database for all of them."""

import asyncio
from contextlib import suppress

from service.gateways.context import GatewayContext
from service.gateways.plant_state.figures import PlantChange, PlantState

LONGEST_S = 1.0


class PlantFeed:
    """What is to be told, and why nothing is known of changes (problem). Belongs to one event loop."""

    def __init__(self) -> None:
        self._state = PlantState()
        self._unread = self._state
        self.problem: str | None = None
        self.is_read = asyncio.Event()
        """Set once the database has told the plant for the first time."""
        self._changed = asyncio.Event()

    async def follow(self, context: GatewayContext) -> None:
        """Follow the database until the gateway is to end."""
        follower = context.follower()
        try:
            while not context.stop.is_set():
                change = await asyncio.to_thread(follower.next_change, context.stop, longest_s=LONGEST_S)
                self.problem = follower.problem
                if change is not None:
                    self.put(change.now)
        finally:
            follower.close()

    def put(self, state: PlantState) -> None:
        """Tell a state to all who wait."""
        self._state = state
        self.is_read.set()
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()

    @property
    def latest(self) -> PlantState:
        """Return the state that was told last."""
        return self._state

    def begin(self) -> PlantState:
        """Return what a connection has told when it begins: nothing, which changes once the plant is read."""
        return PlantState() if self.is_read.is_set() else self._unread

    async def next_change(self, told: PlantState, *, longest_s: float = LONGEST_S) -> PlantChange | None:
        """Return what differs from what was told; None where nothing does for so long."""
        if self._state is told:
            with suppress(TimeoutError):
                async with asyncio.timeout(longest_s):
                    await self._changed.wait()
        return None if self._state is told else PlantChange(told, self._state)
