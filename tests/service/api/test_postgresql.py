"""The API on PostgreSQL, where several writers are at work at once."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Barrier

import httpx
import pytest

CLIENTS = 4

Post = Callable[[], httpx.Response]
AtOnce = Callable[[Post], list[httpx.Response]]


@pytest.fixture
def database_url(postgresql_url: str) -> str:
    return postgresql_url


@pytest.fixture
def at_once(client: httpx.Client) -> Iterator[AtOnce]:
    """The answers to several requests that are made together."""
    together = Barrier(CLIENTS)

    def begin(post: Post) -> httpx.Response:
        together.wait(10)
        while (answer := post()).status_code == httpx.codes.SERVICE_UNAVAILABLE:
            time.sleep(float(answer.headers["Retry-After"]))  # as a client does whom a busy service asks to
        return answer

    with ThreadPoolExecutor(CLIENTS) as pool:
        yield lambda post: list(pool.map(begin, [post] * CLIENTS, timeout=60))


def test_whoever_comes_second_with_a_key_gets_the_first_ones_answer(
    client: httpx.Client, at_once: AtOnce
) -> None:
    for number in range(10):
        headers = {"Idempotency-Key": f"key {number}"}
        answers = at_once(partial(client.post, "/api/v1/motors/PUMP-A1/event-reports", headers=headers))
        assert {answer.status_code for answer in answers} == {202}
        assert len({answer.json()["id"] for answer in answers}) == 1


def test_whoever_comes_second_with_an_upload_is_told_of_the_first(
    client: httpx.Client, at_once: AtOnce
) -> None:
    for number in range(10):
        files = {"files": ("E.CFF", b"samples %d" % number)}
        post = partial(client.post, "/api/v1/recordings", data={"motor": "PUMP-A1"}, files=files)
        answers = at_once(post)
        assert sorted(answer.status_code for answer in answers) == [200, 200, 200, 201]
        assert len({answer.json()["id"] for answer in answers}) == 1


def test_text_that_the_database_cannot_hold_is_refused(client: httpx.Client) -> None:
    refused = client.get("/api/v1/recordings", params={"motor": "PUMP\0A1"})
    assert refused.status_code == 422
    assert refused.headers["content-type"] == "application/problem+json"
    assert "NUL" in refused.json()["detail"]
