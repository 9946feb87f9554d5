"""The stream of events (SSE) that tells an open page what has changed."""

import time
from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated

from fastapi import APIRouter, FastAPI, Query, Request
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool
from starlette.responses import StreamingResponse

from service.access.identities import Way, identity_of_login
from service.access.permissions import Permission
from service.api.access.callers import Asking, Caller
from service.api.access.requirements import require
from service.api.context import ApiContext, Context
from service.api.problems import BusyError, WrongFieldError
from service.storage.repository.overviews.change_stamps import Subject
from service.storage.repository.sites import AtSite
from service.timing.database_silence import does_not_answer
from service.web.addresses import address
from service.web.live.bus import LiveBus
from service.web.live.changes import Changes
from service.web.live.topics import Topic, topic_of

MOST_TOPICS = 5
LONGEST_SEEN = 500

SHARE, LEAST_OF_ONE = 4, 2
"""One user has at most this part of the streams, and may have so many in any case."""

RETRY_MS = 2000
"""A browser whose stream ended comes again after so long."""

PAUSE_S = 15.0
"""A line is sent at least so often, so that nothing between takes the connection for dead."""

LOOK_AGAIN_S = 60.0
"""The session behind a stream is looked at so often. Who has none comes again, and shows who they are."""

PEOPLE = Topic(Subject.PEOPLE)

router = APIRouter()


@dataclass(frozen=True, slots=True)
class Live:
    """What the application has for its open pages."""

    changes: Changes
    bus: LiveBus


def install_live(app: FastAPI, context: ApiContext) -> None:
    """Give an application its bus."""
    changes = Changes(context.repository)
    app.state.live = Live(changes, LiveBus(changes))


def live_of(app: FastAPI) -> Live:
    """Return what `install_live` has made."""
    live = app.state.live
    if not isinstance(live, Live):
        raise TypeError("the application was not made by create_site")
    return live


def live_address(request: Request, *topics: str) -> str:
    """Return where a page is told of changes of these topics, from what it is about to show on.

    To be called before the page reads what it shows, so that nothing is missed. Raises SQLAlchemyError.
    """
    wanted = [topic_of(topic) for topic in topics]
    stamps = live_of(request.app).changes.stamps(wanted)
    return address("/live", topic=[*topics], seen=_joined(wanted, stamps))


@router.get("/live", include_in_schema=False, dependencies=[require(Permission.VIEW)])
async def get_live(
    request: Request,
    context: Context,
    asking: Asking,
    topic: Annotated[list[str], Query(min_length=1, max_length=MOST_TOPICS)],
    seen: Annotated[str | None, Query(max_length=LONGEST_SEEN)] = None,
) -> StreamingResponse:
    """Tell of each change of the topics by an event with the topic's name, until the session ends."""
    try:
        topics = list(dict.fromkeys(map(topic_of, topic)))
    except ValueError as error:
        raise WrongFieldError("query.topic", str(error)) from error
    motors = [one.motor for one in topics if one.motor is not None]
    await run_in_threadpool(asking.demand_here, context.repository, AtSite.MOTOR, *motors)
    live = live_of(request.app)
    most = max(context.settings.max_connections // 2, 1)
    if live.bus.streams >= most:
        raise BusyError("streams of open pages", most)
    viewer = asking.actor.name
    most_of_one = max(most // SHARE, LEAST_OF_ONE)
    if live.bus.streams_of(viewer) >= most_of_one:
        raise BusyError(f"streams of open pages of {viewer}", most_of_one)
    before = request.headers.get("last-event-id") or seen
    return StreamingResponse(
        _events(live.bus, context, asking, topics, before),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"},
    )


async def _events(
    bus: LiveBus, context: ApiContext, asking: Caller, topics: Sequence[Topic], before: str | None
) -> AsyncIterator[str]:
    """Yield the events. When the session has ended, each topic is told once more: the page sees it then."""
    yield f"retry: {RETRY_MS}\n\n"
    told = None if before is None else before.split(",")
    people: str | None = None
    looked_s = time.monotonic()
    async for stamps in bus.follow([*topics, PEOPLE], viewer=asking.actor.name, pause_s=PAUSE_S):
        if len(stamps) <= len(topics):  # the database does not answer
            yield ": wait\n\n"
            continue
        if stamps[PEOPLE] != people or time.monotonic() - looked_s > LOOK_AGAIN_S:
            # A session may have ended before the first stamps; a token was looked at just now.
            is_due = people is not None or asking.session is not None
            if is_due and not await _is_still_here(context, asking):
                for topic in topics:
                    yield f"event: {topic.event}\ndata: session\n\n"
                return
            people, looked_s = stamps[PEOPLE], time.monotonic()
        now = [stamps[topic] for topic in topics]
        changed = _changed(topics, told, now)
        told = now
        for topic in changed:
            yield f"event: {topic.event}\nid: {','.join(now)}\ndata: {stamps[topic]}\n\n"
        if not changed:
            yield f"id: {','.join(now)}\n: here\n\n"


def _changed(topics: Sequence[Topic], told: Sequence[str] | None, now: Sequence[str]) -> Sequence[Topic]:
    """Return the topics with other stamps than those that the page has seen; all where those do not fit."""
    if told is None:
        return ()
    if len(told) != len(now):
        return topics
    return [topic for topic, then, new in zip(topics, told, now, strict=True) if then != new]


def _joined(topics: Sequence[Topic], stamps: Mapping[Topic, str]) -> str:
    return ",".join(stamps[topic] for topic in topics)


async def _is_still_here(context: ApiContext, asking: Caller) -> bool:
    """Tell whether who asked may go on. Only a session can be looked at again; others are asked anew."""
    if asking.way is not Way.SESSION or asking.session is None:
        return False
    look = partial(
        identity_of_login,
        context.repository,
        context.settings.access,
        asking.session,
        now_ns=time.time_ns(),
        is_use=False,
    )
    try:
        identity = await run_in_threadpool(look)
    except SQLAlchemyError as error:
        if not does_not_answer(error):
            raise
        return True  # it is looked at again soon, and shows nothing meanwhile
    return identity is not None and Permission.VIEW in identity.permissions
