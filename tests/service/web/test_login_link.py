"""The link that logs somebody in once, as a browser follows it."""

import time
from urllib.parse import urlsplit

import httpx
import pytest

from service.access.login_links import address_of, new_login_link
from service.api import ApiContext
from testing.service.accounts import EVERYTHING, TESTS


@pytest.fixture
def link(context: ApiContext, anybody: httpx.Client) -> str:
    now_ns = time.time_ns()
    context.repository.add_user("demo", EVERYTHING, password=None, by=TESTS, now_ns=now_ns)
    secret = new_login_link(context.repository, "demo", by=TESTS, now_ns=now_ns)
    whole = address_of(str(anybody.base_url).rstrip("/"), secret)
    parts = urlsplit(whole)
    return f"{parts.path}?{parts.query}"


def test_a_link_logs_in_once_and_leads_to_the_first_page(
    context: ApiContext, anybody: httpx.Client, link: str
) -> None:
    answer = anybody.get(link)
    assert answer.status_code == 200
    assert answer.headers["cache-control"] == "no-store"
    assert answer.headers["referrer-policy"] == "no-referrer"
    assert "SameSite=strict" in answer.headers["set-cookie"]
    assert 'http-equiv="refresh" content="0;url=/' in answer.text
    assert anybody.get("/api/v1/account").json()["name"] == "demo"
    first = context.repository.audit_entries(limit=1).items[0]
    assert (first.action, first.subject, first.after) == ("logged-in", "demo", '{"by_way_of":"login link"}')

    again = anybody.get(link)
    assert again.status_code == 200, "who followed it is let in where they are"
    assert "set-cookie" not in again.headers
    anybody.cookies.clear()
    late = anybody.get(link)
    assert late.status_code == 410
    assert "used already" in late.text


def test_a_browser_that_looks_ahead_does_not_use_a_link_up(anybody: httpx.Client, link: str) -> None:
    ahead = anybody.get(link, headers={"Sec-Purpose": "prefetch;prerender"})
    assert ahead.status_code == 204
    assert anybody.head(link).status_code == 405
    assert "set-cookie" in anybody.get(link).headers


@pytest.mark.parametrize("further", ["&next=//evil.example/", "&next=/login"])
def test_a_link_leads_nowhere_else(anybody: httpx.Client, link: str, further: str) -> None:
    answer = anybody.get(link + further)
    assert "evil" not in answer.text
    assert 'content="0;url=/login' not in answer.text


@pytest.mark.parametrize("guess", ["/login/link", "/login/link?secret=", "/login/link?secret=guess"])
def test_a_guess_lets_nobody_in(anybody: httpx.Client, link: str, guess: str) -> None:
    del link
    answer = anybody.get(guess)
    assert answer.status_code in (410, 422)
    assert "set-cookie" not in answer.headers
