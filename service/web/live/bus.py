"""One look at the database for all who watch, for as long as somebody watches."""

import asyncio
from collections import Counter
from collections.abc import AsyncIterator, Collection, Iterator, Mapping
from contextlib import contextmanager, suppress

import structlog
from sqlalchemy.exc import SQLAlchemyError
from structlog.typing import FilteringBoundLogger

from service.timing.database_silence import database_trouble
from service.web.live.changes import Changes
from service.web.live.topics import Topic

log: FilteringBoundLogger = structlog.get_logger(__name__)

PERIOD_S = 0.25
"""Between two looks at the counter of changes."""

AFTER_CHANGE_S = 1.25
"""Before another look after a change: where changes follow each other, open pages ask so often at most."""

FOR_EACH_STREAM_S = 0.025
"""So much longer is that pause for each open page, so that a crowd of them does not take a core."""

AFTER_FAILURE_S = 5.0
"""Before another look where the database did not answer."""


class LiveBus:
    """Watches the database in the running event loop while there are viewers.

    It knows the topics that are watched and their stamps, and how often whom they are watched by.
    """

    def __init__(self, changes: Changes, *, period_s: float = PERIOD_S) -> None:
        self._changes = changes
        self._period_s = period_s
        self._watched: Counter[Topic] = Counter()
        self._streams: Counter[str] = Counter()
        self._stamps: Mapping[Topic, str] = {}
        self._news = asyncio.Event()
        self._watcher: asyncio.Task[None] | None = None
        self._is_closed = False

    @property
    def streams(self) -> int:
        """Return how many follow now."""
        return self._streams.total()

    def streams_of(self, viewer: str) -> int:
        """Return how many follow now for one viewer."""
        return self._streams[viewer]

    def close(self) -> None:
        """End all streams, because the service stops. To be called in the event loop."""
        self._is_closed = True
        if self._watcher is not None:
            self._watcher.cancel()
        self._tell({})
        asyncio.get_running_loop().run_in_executor(None, self._changes.close)

    async def follow(
        self, topics: Collection[Topic], *, viewer: str, pause_s: float
    ) -> AsyncIterator[Mapping[Topic, str]]:
        """Yield the topics' stamps: once they are known, after each change, and every `pause_s` at least.

        viewer: the name of who watches.  Nothing is in them while the database does not answer.  It ends when
        the service stops.
        """
        loop = asyncio.get_running_loop()
        with self._watching(topics, viewer):
            told: Mapping[Topic, str] = {}
            due_s = loop.time() + pause_s
            while not self._is_closed:
                news = self._news
                known = {topic: self._stamps[topic] for topic in topics if topic in self._stamps}
                if (known != told and len(known) == len(topics)) or loop.time() >= due_s:
                    told = known
                    due_s = loop.time() + pause_s
                    yield told
                else:
                    with suppress(TimeoutError):
                        await asyncio.wait_for(news.wait(), due_s - loop.time())

    @contextmanager
    def _watching(self, topics: Collection[Topic], viewer: str) -> Iterator[None]:
        self._watched.update(topics)
        self._streams[viewer] += 1
        if self._watcher is None and not self._is_closed:
            self._watcher = asyncio.get_running_loop().create_task(self._watch(), name="live pages")
        try:
            yield
        finally:
            self._streams[viewer] -= 1
            self._streams = +self._streams
            self._watched.subtract(topics)
            self._watched = +self._watched

    async def _watch(self) -> None:
        """Look until nobody watches any more."""
        loop = asyncio.get_running_loop()
        fails = False
        try:
            while self._watched and not self._is_closed:
                pause_s = self._period_s
                try:
                    stamps = await loop.run_in_executor(None, self._changes.stamps, tuple(self._watched))
                except SQLAlchemyError as error:
                    if not fails:
                        log.warning("open pages are not told of changes", error=database_trouble(error))
                    fails, pause_s = True, AFTER_FAILURE_S
                    self._stamps = {}
                else:
                    fails = False
                    if stamps != self._stamps:
                        pause_s = self._pause_s(stamps)
                        self._tell(stamps)
                await asyncio.sleep(pause_s)
        finally:
            self._watcher, self._stamps = None, {}

    def _pause_s(self, stamps: Mapping[Topic, str]) -> float:
        """Return the pause after these stamps. That somebody else watches is no change."""
        has_changed = any(self._stamps.get(topic, stamp) != stamp for topic, stamp in stamps.items())
        return AFTER_CHANGE_S + self.streams * FOR_EACH_STREAM_S if has_changed else self._period_s

    def _tell(self, stamps: Mapping[Topic, str]) -> None:
        self._stamps = stamps
        self._news.set()
        self._news = asyncio.Event()
