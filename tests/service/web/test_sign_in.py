"""Logging in and out at the pages, and what people see who may not."""

import time

import httpx
import pytest

from service.access.passwords import hashed
from service.api import ApiContext
from service.storage.records import Actor, Role
from service.web.app import create_site
from tests.service.api.serving import serving
from tests.service.web.pages import page, words

KNOWN_WORDS = "correct horse battery"
BY = Actor("tests", "command line")


@pytest.fixture
def user(context: ApiContext) -> str:
    context.repository.add_user(
        "kim", [Role.VIEWER], password=hashed(KNOWN_WORDS), by=BY, now_ns=time.time_ns()
    )
    return "kim"


def test_who_is_not_logged_in_is_sent_to_log_in_and_back(anybody: httpx.Client, user: str) -> None:
    answer = anybody.get("/account?tab=tokens")
    assert answer.status_code == 303
    assert answer.headers["location"] == "/login?next=%2Faccount%3Ftab%3Dtokens"
    form = {"name": user, "password": KNOWN_WORDS, "next": "/account?tab=tokens"}
    answer = anybody.post("/login", data=form)
    assert answer.status_code == 303
    assert answer.headers["location"] == "/account?tab=tokens"
    assert "HttpOnly" in answer.headers["set-cookie"]
    assert "SameSite=strict" in answer.headers["set-cookie"]


def test_a_service_knows_nothing_of_a_viewer_that_another_one_would_not(
    context: ApiContext, user: str
) -> None:
    """Two services on one database: what one has begun goes on with the other."""
    with (
        serving(create_site(context), as_somebody=False) as one,
        serving(create_site(context), as_somebody=False) as other,
    ):
        one.headers["Accept"] = other.headers["Accept"] = "text/html"
        one.post("/login", data={"name": user, "password": KNOWN_WORDS})
        other.cookies.update(one.cookies)
        for path in ("/", "/?text=pump", "/alarms?show=history", "/account"):
            answers = [each.get(path) for each in (one, other)]
            assert [answer.status_code for answer in answers] == [200, 200]
            assert words(page(answers[0]), "main") == words(page(answers[1]), "main"), path
        other.post("/logout")
        assert one.get("/account").status_code == 303


def test_nobody_is_sent_to_another_site(anybody: httpx.Client, user: str) -> None:
    form = {"name": user, "password": KNOWN_WORDS, "next": "//evil.example/"}
    assert anybody.post("/login", data=form).headers["location"].startswith("/")
    assert not anybody.post("/login", data=form).headers["location"].startswith("//")
    assert "evil.example" not in anybody.get("/login", params={"next": "//evil.example"}).text


def test_a_wrong_password_is_told_on_the_page_which_keeps_the_name(anybody: httpx.Client, user: str) -> None:
    answer = anybody.post("/login", data={"name": user, "password": "wrong", "next": "/alarms"})
    assert answer.status_code == 401
    assert 'value="kim"' in answer.text
    assert 'value="/alarms"' in answer.text
    assert 'role="alert"' in answer.text
    assert "wrong" not in answer.text.replace("wrong name or password", "").replace("is wrong", "")


def test_a_logout_ends_the_session(anybody: httpx.Client, user: str) -> None:
    anybody.post("/login", data={"name": user, "password": KNOWN_WORDS})
    assert anybody.get("/api/v1/account").json()["name"] == user
    cookie = anybody.cookies["statorwatch_session"]
    answer = anybody.post("/logout")
    assert answer.status_code == 303
    assert answer.headers["location"] == "/login?done=logged-out"
    assert answer.headers["clear-site-data"] == '"cache"'
    anybody.cookies.set("statorwatch_session", cookie)
    assert anybody.get("/api/v1/account").status_code == 401


def test_before_there_is_a_user_the_page_says_how_to_make_one(anybody: httpx.Client) -> None:
    page = anybody.get("/login").text
    assert "mcc user add" in page
    assert "<form" not in page


def test_only_known_words_are_told_of_what_was_done(anybody: httpx.Client, user: str) -> None:
    del user
    assert "You are logged out." in anybody.get("/login?done=logged-out").text
    assert "call 555" not in anybody.get("/login?done=call+555").text
