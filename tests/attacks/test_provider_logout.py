"""What ends with a user of the plant's identity provider, and forged words of it that end others' logins."""

import time
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from joserfc.jwk import RSAKey

from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS
from testing.service.identity_provider import CLIENT, LOGOUT, IdentityProvider, identity_provider
from tests.attacks.login_service import (
    API,
    LOGIN,
    Serve,
    add_user,
    another,
)

MOTORS, TOKENS = f"{API}/motors", f"{API}/account/tokens"
OIDC = f"{LOGIN}/oidc"


@pytest.fixture
def provider() -> Iterator[IdentityProvider]:
    with identity_provider() as provider:
        provider.wants_secret = False
        provider.claims = {"sub": "4711", "preferred_username": "anna", "roles": ["staff"], "sid": "s-1"}
        yield provider


@pytest.fixture
def browser(serve: Serve, provider: IdentityProvider) -> httpx.Client:
    oidc = {
        "issuer": provider.url,
        "client_id": CLIENT,
        "redirect_url": f"http://127.0.0.1:1{OIDC}/callback",
        "roles": {"VIEWER": ["staff"]},
        "timeout_s": 20,
    }
    return serve(oidc=oidc)


def sign_on(browser: httpx.Client) -> None:
    """Go to the provider and come back, as a browser does."""
    there = browser.get(OIDC).headers["location"]
    back = httpx.get(there, trust_env=False).headers["location"]
    asked = {name: values[0] for name, values in parse_qs(urlsplit(back).query).items()}
    assert browser.get(f"{OIDC}/callback", params=asked).status_code == 200
    assert browser.get(MOTORS).status_code == 200


def token_of(browser: httpx.Client) -> dict[str, str]:
    """Headers of a new token of who is logged in."""
    made = browser.post(TOKENS, json={"label": "historian"}).json()["token"]
    return {"Authorization": f"Bearer {made}"}


def told(browser: httpx.Client, token: str) -> int:
    """Tell the service what the provider has signed, from the provider's own machine."""
    with another(browser) as elsewhere:
        answer = elsewhere.post(f"{OIDC}/logout", data={"logout_token": token})
    assert answer.is_error or answer.headers["cache-control"] == "no-store"
    return answer.status_code


def status(browser: httpx.Client, headers: dict[str, str]) -> int:
    with another(browser) as program:
        return program.get(MOTORS, headers=headers).status_code


def test_what_a_user_has_ends_when_the_provider_ends_all_of_it(
    browser: httpx.Client, provider: IdentityProvider, repository: Repository
) -> None:
    sign_on(browser)
    headers = token_of(browser)
    local = add_user(repository, "bert", Role.VIEWER)
    with another(browser) as other:
        other.post(LOGIN, json=local)
        assert told(browser, provider.logout_token(sub="4711")) == 200
        assert (browser.get(MOTORS).status_code, status(browser, headers)) == (401, 401)
        assert other.get(MOTORS).status_code == 200, "others go on"
    with repository.audit_trail() as trail:
        last = list(trail.entries())
    ended = [(entry.action, entry.subject, entry.actor) for entry in last if entry.actor == provider.url]
    assert ended == [("tokens-revoked", "anna", provider.url), ("sessions-ended", "anna", provider.url)]


def test_one_login_ends_where_the_provider_names_one(
    browser: httpx.Client, provider: IdentityProvider
) -> None:
    sign_on(browser)
    headers = token_of(browser)
    provider.claims["sid"] = "s-2"
    with another(browser) as second:
        sign_on(second)
        assert told(browser, provider.logout_token(sub="4711", sid="s-1")) == 200
        assert (browser.get(MOTORS).status_code, second.get(MOTORS).status_code) == (401, 200)
        assert told(browser, provider.logout_token(sid="s-3")) == 200, "it is over already"
        assert told(browser, provider.logout_token(sub="4712", sid="s-2")) == 200
        assert second.get(MOTORS).status_code == 200, "a login of somebody else"
        assert told(browser, provider.logout_token(sid="s-2")) == 200
        assert second.get(MOTORS).status_code == 401
    assert status(browser, headers) == 200, "programs are not logged out with a browser"


def test_a_user_who_is_deleted_or_disabled_here_leaves_nothing_that_opens(
    browser: httpx.Client, repository: Repository
) -> None:
    for way in ("disabled", "deleted"):
        sign_on(browser)
        headers = token_of(browser)
        if way == "disabled":
            repository.change_user("anna", disabled=True, by=TESTS, now_ns=1)
        else:
            repository.delete_user("anna", by=TESTS, now_ns=1)
        assert (browser.get(MOTORS).status_code, status(browser, headers)) == (401, 401)
        if way == "disabled":
            repository.change_user("anna", disabled=False, by=TESTS, now_ns=2)


NOW = int(time.time())
SUB: dict[str, Any] = {"sub": "4711"}


@pytest.mark.parametrize(
    "claims",
    [
        {},
        {**SUB, "iss": "https://elsewhere.example"},
        {**SUB, "iss": None},
        {**SUB, "aud": "another-client"},
        {**SUB, "aud": None},
        {**SUB, "events": None},
        {**SUB, "events": {}},
        {**SUB, "events": {LOGOUT: None}},
        {**SUB, "events": [LOGOUT]},
        {**SUB, "nonce": "n"},
        {**SUB, "jti": None},
        {**SUB, "jti": ""},
        {**SUB, "iat": None},
        {**SUB, "iat": NOW - 10_000, "exp": NOW + 300},
        {**SUB, "iat": NOW + 10_000, "exp": NOW + 20_000},
        {**SUB, "exp": NOW - 300},
        {**SUB, "exp": "never"},
        {**SUB, "iat": True},
        {"sub": 4711},
        {"sub": "4711", "sid": 1},
        {"sub": "4711" * 100},
    ],
)
def test_a_logout_token_that_does_not_hold_ends_nothing(
    browser: httpx.Client, provider: IdentityProvider, repository: Repository, claims: dict[str, Any]
) -> None:
    sign_on(browser)
    assert told(browser, provider.logout_token(**claims)) == 400
    assert browser.get(MOTORS).status_code == 200
    with repository.audit_trail() as trail:
        assert [entry.action for entry in trail.entries()][-1] == "token-refused"


def test_a_forged_or_replayed_one_ends_nothing(browser: httpx.Client, provider: IdentityProvider) -> None:
    sign_on(browser)
    token = provider.logout_token(**SUB)
    header, body, signature = token.split(".")
    forged = [f"{header}.{body}.", f"{header}.{body}.{signature[:-4]}AAAA", "", "a.b.c", "x" * 5000]
    own = provider.signing
    assert own is not None
    provider.signing = RSAKey.generate_key(2048, {"kid": str(own.kid)})
    forged.append(provider.logout_token(**SUB))
    provider.signing = own
    id_token = provider.token({"nonce": "n"})
    assert [told(browser, one) for one in [*forged, id_token]] == [
        422 if not one else 400 for one in [*forged, "id"]
    ]
    assert browser.get(MOTORS).status_code == 200
    assert told(browser, token) == 200
    sign_on(browser)
    assert told(browser, token) == 400
    assert browser.get(MOTORS).status_code == 200
