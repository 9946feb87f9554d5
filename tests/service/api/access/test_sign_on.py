"""Sign-on at an OpenID provider: a browser's way there and back, and what lets nobody in."""

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from joserfc.jwk import ECKey, RSAKey

from service.access.passwords import hashed
from service.api import ApiContext, create_app
from service.configuration.access import AccessSettings, OidcSettings
from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS
from testing.service.identity_provider import CLIENT, SECRET, IdentityProvider, identity_provider
from tests.service.api.serving import serving

LOGIN = "/api/v1/login/oidc"
CALLBACK = f"{LOGIN}/callback"
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
ANNA: dict[str, Any] = {
    "sub": "4711",
    "preferred_username": "Anna",
    "name": "Anna Miller",
    "realm": {"groups": ["electrical", "everybody"]},
}


@pytest.fixture
def provider() -> Iterator[IdentityProvider]:
    with identity_provider() as provider:
        provider.claims = dict(ANNA)
        yield provider


@pytest.fixture
def client(context: ApiContext, provider: IdentityProvider, tmp_path: Path) -> Iterator[httpx.Client]:
    """A browser before its login; its cookies are those of a service behind the redirect address."""
    secret = tmp_path / "oidc"
    secret.touch(mode=0o600)
    secret.write_text(f"{SECRET}\n")
    settings = settings_with(context, provider.url, client_secret_file=secret)
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        yield client


def settings_with(
    context: ApiContext, issuer: str, *, client_secret_file: Path | None = None, timeout_s: float = 20.0
) -> Settings:
    """Settings with a provider at this address."""
    oidc = {
        "issuer": issuer,
        "client_id": CLIENT,
        "client_secret_file": client_secret_file,
        "redirect_url": f"http://127.0.0.1:1{CALLBACK}",
        "roles_claim": "realm.groups",
        "roles": {"ENGINEER": ["electrical"], "VIEWER": ["everybody"], "SECADM": ["it"]},
        "timeout_s": timeout_s,
    }
    access = AccessSettings(oidc=OidcSettings.model_validate(oidc))
    return context.settings.model_copy(update={"access": access})


def back(client: httpx.Client, **changed: str) -> httpx.Response:
    """Go to the provider and come back, as a browser does."""
    there = client.get(LOGIN)
    assert there.status_code == 303, there.text
    returned = httpx.get(there.headers["location"], trust_env=False)
    query = {
        name: values[0] for name, values in parse_qs(urlsplit(returned.headers["location"]).query).items()
    }
    return client.get(CALLBACK, params=query | changed, headers={"Sec-Fetch-Site": "cross-site"})


def test_who_signs_on_has_a_session_with_the_roles_of_their_groups(
    client: httpx.Client, repository: Repository
) -> None:
    assert client.get("/api/v1/motors").status_code == 401
    assert client.get("/api/v1/login").json()["oidc"] == LOGIN
    there = client.get(LOGIN)
    asked = parse_qs(urlsplit(there.headers["location"]).query)
    assert asked["code_challenge_method"] == ["S256"]
    assert len(asked["state"][0]) >= 32
    assert len(asked["nonce"][0]) >= 32
    assert "HttpOnly" in there.headers["set-cookie"]
    answer = back(client)
    assert answer.status_code == 200, answer.text
    cookie = next(each for each in answer.headers.get_list("set-cookie") if "_session=" in each)
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    account = client.get("/api/v1/account").json()
    assert (account["name"], account["full_name"], account["way"]) == ("anna", "Anna Miller", "session")
    assert account["roles"] == ["ENGINEER", "VIEWER"]
    assert client.post("/api/v1/motors/PUMP-A1/event-reports").status_code == 202
    assert client.post("/api/v1/logout").status_code == 204
    assert client.get("/api/v1/motors").status_code == 401
    user = repository.user("anna")
    assert (user.has_password, user.subject is None) == (False, False)


def test_other_groups_are_other_roles_and_end_older_sessions(
    client: httpx.Client, provider: IdentityProvider
) -> None:
    assert back(client).status_code == 200
    before = dict(client.cookies)
    provider.claims["realm"] = {"groups": "everybody"}
    assert back(client).status_code == 200
    assert client.get("/api/v1/account").json()["roles"] == ["VIEWER"]
    other = httpx.get(f"{client.base_url}/api/v1/account", cookies=before, trust_env=False)
    assert other.status_code == 401
    provider.claims["realm"] = {"groups": ["strangers"]}
    refused = back(client)
    assert refused.status_code == 403
    assert "access.oidc.roles" in refused.json()["detail"]


@pytest.mark.parametrize("kind", [RSAKey, ECKey])
def test_a_provider_may_change_its_keys(
    client: httpx.Client,
    provider: IdentityProvider,
    kind: type[RSAKey] | type[ECKey],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert back(client).status_code == 200
    provider.rotate(kind)
    refused = back(client)
    assert refused.status_code == 401, "keys were read just now"
    monkeypatch.setattr("service.access.oidc.KEYS_AGAIN_S", 0.0)
    assert back(client).status_code == 200
    assert provider.asked.count("/keys") == 2


@pytest.mark.parametrize(
    ("spoiled", "header"),
    [
        ({"nonce": "another"}, {}),
        ({"nonce": None}, {}),
        ({"iss": "https://elsewhere.example"}, {}),
        ({"iss": None}, {}),
        ({"aud": "another-client"}, {}),
        ({"aud": ["another-client", "third"]}, {}),
        ({"aud": None}, {}),
        ({"exp": 1}, {}),
        ({"exp": None}, {}),
        ({"iat": int(time.time()) + 100_000}, {}),
        ({"azp": "another-client", "aud": [CLIENT, "another-client"]}, {}),
        ({"sub": None}, {}),
        ({"sub": ""}, {}),
        ({"sub": 7}, {}),
        ({"preferred_username": None}, {}),
        ({"preferred_username": "statorwatch"}, {}),
        ({"preferred_username": "a\nb"}, {}),
        ({"preferred_username": ["anna"]}, {}),
        ({}, {"kid": "unknown"}),
    ],
)
def test_a_token_that_does_not_hold_lets_nobody_in(
    client: httpx.Client,
    provider: IdentityProvider,
    repository: Repository,
    spoiled: dict[str, Any],
    header: dict[str, Any],
) -> None:
    provider.spoil, provider.header = spoiled, header
    refused = back(client)
    assert refused.status_code == 401, refused.text
    assert refused.headers["content-type"] == "application/problem+json"
    assert "_session=" not in str(refused.headers.get_list("set-cookie"))
    assert not repository.has_users()


@pytest.mark.parametrize("how", ["none", "HS256", "another key"])
def test_a_forged_signature_lets_nobody_in(
    client: httpx.Client, provider: IdentityProvider, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    import base64
    import hashlib
    import hmac
    import json

    def part(document: dict[str, Any]) -> str:
        return base64.urlsafe_b64encode(json.dumps(document).encode()).decode().rstrip("=")

    signing = provider.signing
    assert signing is not None

    def forged(asked: dict[str, str]) -> str:
        now = int(time.time())
        claims = {"iss": provider.url, "aud": CLIENT, "exp": now + 300, "iat": now, **ANNA}
        claims["nonce"] = asked["nonce"]
        body = f"{part({'alg': how, 'kid': signing.kid})}.{part(claims)}"
        if how == "none":
            return f"{body}."
        public = signing.as_pem(private=False)
        mac = hmac.new(public, body.encode(), hashlib.sha256).digest()
        return f"{body}.{base64.urlsafe_b64encode(mac).decode().rstrip('=')}"

    if how == "another key":
        provider.signing = RSAKey.generate_key(2048, {"kid": str(signing.kid)})
    else:
        monkeypatch.setattr(provider, "token", forged)
    assert back(client).status_code == 401


def test_a_way_back_that_did_not_begin_here_lets_nobody_in(
    client: httpx.Client, provider: IdentityProvider
) -> None:
    assert client.get(CALLBACK, params={"code": "x", "state": "y"}).status_code == 400
    assert back(client, state="another").status_code == 400
    assert back(client, code="another").status_code == 401
    refused = back(client, error="access_denied")
    assert refused.status_code == 401
    assert "access_denied" in refused.json()["detail"]
    there = client.get(LOGIN)
    returned = httpx.get(there.headers["location"], trust_env=False).headers["location"]
    client.cookies.clear()
    stolen = client.get(CALLBACK, params=dict(parse_qs(urlsplit(returned).query)))
    assert stolen.status_code == 400, "in another browser"


def test_nobody_gets_to_be_a_local_user_by_being_called_so(
    client: httpx.Client, repository: Repository
) -> None:
    repository.add_user("anna", [Role.SECADM], password=None, by=TESTS, now_ns=1)
    refused = back(client)
    assert refused.status_code == 409
    assert client.get("/api/v1/account").status_code == 401


def test_who_is_disabled_here_stays_outside(client: httpx.Client, repository: Repository) -> None:
    assert back(client).status_code == 200
    repository.change_user("anna", disabled=True, by=TESTS, now_ns=1)
    assert client.get("/api/v1/account").status_code == 401
    assert back(client).status_code == 403


@pytest.mark.parametrize("how", ["slow", "gone"])
def test_while_the_provider_is_down_local_users_log_in(
    context: ApiContext, provider: IdentityProvider, repository: Repository, how: str
) -> None:
    repository.add_user("bert", [Role.VIEWER], password=hashed(PASSWORD), by=TESTS, now_ns=1)
    provider.delay_s = 1.0
    issuer = provider.url if how == "slow" else "http://127.0.0.1:9"
    settings = settings_with(context, issuer, timeout_s=0.2)
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        down = client.get(LOGIN)
        assert down.status_code == 503
        assert "local users log in as ever" in down.json()["detail"]
        assert client.post("/api/v1/login", json={"name": "bert", "password": PASSWORD}).status_code == 200
        assert client.get("/api/v1/motors").status_code == 200
