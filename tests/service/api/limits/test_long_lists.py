"""Long lists: few are made at a time, and a client has to take its own."""

import asyncio
from collections.abc import Awaitable, Callable

import httpx
import pytest
from starlette.responses import Response
from starlette.types import Message, Scope

from service.api import ApiContext, create_app
from service.api.limits.long_lists import MADE_AT_ONCE, PIECE_BYTES, LongLists
from tests.service.api.serving import serving

LONG = b"x" * (3 * PIECE_BYTES + 1)
SCOPE: Scope = {
    "type": "http",
    "method": "GET",
    "path": "/list",
    "query_string": b"limit=1000",
    "headers": [],
}


async def received() -> Message:
    return {"type": "http.disconnect"}


def asked(
    clients: list[Callable[[Message], Awaitable[None]]], app: Callable[..., Awaitable[None]] | None = None
) -> None:
    """Ask for a list for each of the clients at once; they get what is sent."""

    async def ask() -> None:
        lists = LongLists(app or Response(LONG))
        await asyncio.gather(*(lists(SCOPE, received, client) for client in clients))

    asyncio.run(asyncio.wait_for(ask(), 10))


@pytest.mark.parametrize("limit", ["1000", "101", "%2B1000", "1000.0", "9" * 5000])
def test_more_long_lists_than_the_service_makes_are_to_be_asked_for_again(
    context: ApiContext, monkeypatch: pytest.MonkeyPatch, limit: str
) -> None:
    monkeypatch.setattr("service.api.limits.long_lists.MADE_AT_ONCE", 0)
    monkeypatch.setattr("service.api.limits.long_lists.WAIT_S", 0.01)
    with serving(create_app(context)) as client:
        refused = client.get(f"/api/v1/motors?limit={limit}")
        assert refused.status_code == 503
        assert refused.headers["content-type"] == "application/problem+json"
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/api/v1/motors?limit=100").status_code == 200


def test_a_page_of_diagnoses_is_shorter_than_others(client: httpx.Client) -> None:
    path = "/api/v1/recordings/00000000-0000-0000-0000-000000000000/diagnoses"
    assert client.get(f"{path}?limit=101").status_code == 422
    assert client.get(f"{path}?limit=100").status_code == 404


def test_few_lists_are_made_at_a_time() -> None:
    under_way, most = 0, 0

    async def make(scope: Scope, receive: object, send: Callable[[Message], Awaitable[None]]) -> None:
        nonlocal under_way, most
        under_way += 1
        most = max(most, under_way)
        await asyncio.sleep(0)
        under_way -= 1
        await Response(LONG)(scope, received, send)

    async def take(message: Message) -> None:
        await asyncio.sleep(0)

    asked([take] * 10, make)
    assert most == MADE_AT_ONCE


def test_a_list_is_sent_in_pieces_and_others_are_made_meanwhile() -> None:
    taken = bytearray()
    others = asyncio.Event()
    finished = 0

    async def slow(message: Message) -> None:
        await others.wait()
        body = message.get("body", b"")
        assert len(body) <= PIECE_BYTES
        taken.extend(body)

    async def quick(message: Message) -> None:
        nonlocal finished
        if message["type"] == "http.response.body" and not message.get("more_body", False):
            finished += 1
        if finished == MADE_AT_ONCE + 1:
            others.set()

    asked([*[slow] * MADE_AT_ONCE, *[quick] * (MADE_AT_ONCE + 1)])
    assert len(taken) == MADE_AT_ONCE * len(LONG)


def test_a_client_that_does_not_take_its_list_loses_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.api.limits.long_lists.SENDING_LIMIT_S", 0.02)
    sent: list[str] = []

    async def stuck(message: Message) -> None:
        sent.append(message["type"])
        await asyncio.Event().wait()

    asked([stuck])
    assert sent == ["http.response.start"]
