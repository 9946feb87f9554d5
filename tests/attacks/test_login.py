"""Attacks on the login: guessing, locking others out, forged origins, stolen and fixed sessions."""

import time

import pytest

from service.access.logins import LoginLockedError, attempt
from service.access.refusals import NOBODY
from service.configuration.access import AccessSettings
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import EVERYTHING
from tests.attacks.login_service import (
    API,
    LOGIN,
    Serve,
    add_user,
    another,
)

BEHIND_PROXY = {"proxy": {"addresses": ["127.0.0.1"]}}


ENCRYPTED = {"X-Forwarded-For": "198.51.100.9", "X-Forwarded-Proto": "https"}
"""A request that came over TLS to the named proxy."""

COOKIE, HOST_COOKIE = "statorwatch_session", "__Host-statorwatch_session"


def forwarded(hops: str) -> dict[str, str]:
    return {"X-Forwarded-For": hops}


def attack_account(repository: Repository, name: str, prefix: str) -> int:
    """Have many addresses fail at an account at once; return how many were not even tried."""
    refused = 0
    for number in range(200):
        try:
            attempt(repository, AccessSettings(), name, f"{prefix}{number}", now_ns=time.time_ns())
        except LoginLockedError:
            refused += 1
    return refused


@pytest.mark.parametrize(
    ("owner", "again"),
    [
        ("192.0.2.7", "192.0.2.7"),
        ("2001:db8::7", "2001:db8::7"),
        ("2001:db8::7", "2001:db8::ab:7"),  # the privacy address of another day
    ],
)
def test_a_network_of_attackers_cannot_lock_the_owner_out(
    serve: Serve, repository: Repository, owner: str, again: str
) -> None:
    browser, anna = serve(**BEHIND_PROXY), add_user(repository, "anna", Role.OPERATOR)
    assert browser.post(LOGIN, json=anna, headers=forwarded(owner)).status_code == 200
    assert attack_account(repository, "anna", "198.51.100.") > 100
    assert browser.post(LOGIN, json=anna, headers=forwarded("2001:db8:1::7")).status_code == 429
    assert browser.post(LOGIN, json=anna, headers=forwarded(again)).status_code == 200


@pytest.mark.parametrize("gateway", ["", "opcua "])
def test_one_ipv6_network_guesses_no_more_often_than_one_address(
    repository: Repository, gateway: str
) -> None:
    add_user(repository, "anna", Role.OPERATOR)
    assert attack_account(repository, "anna", f"{gateway}2001:db8::") == 195


def test_ipv4_clients_of_a_listener_for_both_families_are_counted_apart(repository: Repository) -> None:
    add_user(repository, "anna", Role.OPERATOR)
    for last in (1, 2):
        for _ in range(5):
            attempt(
                repository,
                AccessSettings(),
                "anna",
                f"opcua ::ffff:192.0.2.{last}",
                now_ns=time.time_ns(),
            )


@pytest.mark.parametrize(
    ("hops", "origin"),
    [
        ("6.6.6.6, 192.0.2.7:5678", "192.0.2.7"),
        ("6.6.6.6, [2001:db8::7]:443", "2001:db8::7"),
        ("6.6.6.6, [2001:db8::7]", "2001:db8::7"),
        ("6.6.6.6, 2001:db8::7, 127.0.0.1:80", "2001:db8::7"),
        ("6.6.6.6, unknown", "127.0.0.1"),
        ("6.6.6.6, _hidden, 127.0.0.1", "127.0.0.1"),
        ("6.6.6.6, 192.0.2.7:x:y", "127.0.0.1"),
        ("", "127.0.0.1"),
    ],
)
def test_nobody_forges_where_they_log_in_from(
    serve: Serve, repository: Repository, hops: str, origin: str
) -> None:
    browser, anna = serve(**BEHIND_PROXY), add_user(repository, "anna", Role.OPERATOR)
    assert browser.post(LOGIN, json=anna, headers=forwarded(hops)).status_code == 200
    assert repository.user("anna").last_login_origin == origin


def test_browsers_ask_in_clear_no_more_where_tls_is_on(serve: Serve) -> None:
    browser = serve(**BEHIND_PROXY)
    for path in ("/login", LOGIN, "/healthz", "/nowhere"):
        assert browser.get(path, headers=ENCRYPTED).headers["strict-transport-security"] == "max-age=31536000"
        assert "strict-transport-security" not in browser.get(path).headers


def test_a_cookie_set_in_clear_or_by_another_host_is_no_session_over_tls(
    serve: Serve, repository: Repository
) -> None:
    browser, anna = serve(**BEHIND_PROXY), add_user(repository, "anna", Role.OPERATOR)
    given = browser.post(LOGIN, json=anna, headers=ENCRYPTED).headers["set-cookie"]
    assert given.startswith(f"{HOST_COOKIE}=")
    assert "Secure" in given
    secret = given.partition("=")[2].partition(";")[0]

    def status(name: str) -> int:
        headers = {**ENCRYPTED, "Cookie": f"{name}={secret}"}
        with another(browser) as other:
            return other.get(f"{API}/account", headers=headers).status_code

    assert status(HOST_COOKIE) == 200
    assert status(COOKIE) == 401


def test_a_session_that_was_there_before_a_login_is_of_no_more_use(
    serve: Serve, repository: Repository
) -> None:
    browser = serve()
    anna, bert = (add_user(repository, name, Role.OPERATOR) for name in ("anna", "bert"))
    assert browser.post(LOGIN, json=anna).status_code == 200
    with another(browser) as thief, another(browser) as elsewhere:
        thief.cookies.update(browser.cookies)
        assert elsewhere.post(LOGIN, json=anna).status_code == 200
        assert thief.get(f"{API}/account").json()["name"] == "anna"
        assert browser.post(LOGIN, json=bert).status_code == 200
        assert thief.get(f"{API}/account").status_code == 401
        assert elsewhere.get(f"{API}/account").status_code == 200, "another browser's session goes on"
    with repository.audit_trail() as trail:
        done = [(entry.action, entry.subject, entry.actor) for entry in trail.entries()]
    assert done[-3:] == [
        ("logged-out", "anna", "bert"),
        ("logged-in", "bert", "bert"),
        ("session-refused", f"GET {API}/account", NOBODY),
    ]


def test_a_user_has_no_more_sessions_than_the_settings_let_them(serve: Serve, repository: Repository) -> None:
    browser, anna = serve(sessions=2), add_user(repository, "anna", Role.OPERATOR)
    bert = add_user(repository, "bert", Role.OPERATOR)
    with another(browser) as second, another(browser) as third, another(browser) as of_bert:
        for one, wanted in ((browser, anna), (of_bert, bert), (second, anna), (third, anna)):
            assert one.post(LOGIN, json=wanted).status_code == 200
        status = [one.get(f"{API}/motors").status_code for one in (browser, second, third, of_bert)]
    assert status == [401, 200, 200, 200], "the one that was used longest ago has ended, and no other user's"


@pytest.mark.parametrize(
    "path", ["users", "users/anna", "tokens", "account", "account/tokens", "audit/entries", "users/nobody"]
)
def test_no_cache_keeps_what_the_api_tells_of_people(serve: Serve, repository: Repository, path: str) -> None:
    browser, is_audit = serve(), path.startswith("audit")
    roles = (Role.VIEWER, Role.SECAUD) if is_audit else EVERYTHING
    assert browser.post(LOGIN, json=add_user(repository, "anna", *roles)).status_code == 200
    answer = browser.get(f"{API}/{path}")
    assert answer.status_code in (200, 404)
    assert answer.headers["cache-control"] == "no-store"
    assert browser.get(f"{API}/motors").headers.get("cache-control") != "no-store"


def test_who_logs_in_was_shown_the_notice_first(serve: Serve) -> None:
    notice = "For authorised staff only.\n<b>Use is recorded.</b>"
    browser = serve(use_notice=notice)
    assert browser.get(LOGIN).json()["notice"] == notice
    page = browser.get("/login").text
    assert "For authorised staff only." in page
    assert "&lt;b&gt;Use is recorded." in page
    assert "You acknowledge this notice when you log in." in page
    assert serve().get(LOGIN).json()["notice"] is None
    assert "You acknowledge" not in serve().get("/login").text
