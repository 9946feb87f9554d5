"""Attacks on tokens, and on what keeps who manages users from the audit trail."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from sqlalchemy import Engine, text
from sqlalchemy.exc import IntegrityError

from core.time_stamps import nanoseconds, rfc3339
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import digest_of, new_token
from service.access.identities import identity_of_token
from service.access.passwords import hashed
from service.access.permissions import Permission
from service.api import ApiContext, create_app
from service.client.credentials import bearer
from service.configuration.access import AccessSettings
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.errors import (
    AuditorAccountError,
    NotFoundError,
    RolesNotSeparateError,
    TokenOfAnotherError,
    WiderTokenError,
)
from service.storage.records import Actor, Role
from testing.service.accounts import TESTS, token_of
from testing.service.identity_provider import IdentityProvider, identity_provider
from tests.service.api.access.test_sign_on import ANNA, back, settings_with
from tests.service.api.serving import LONGEST_S, serving

API = "/api/v1"
OWN = f"{API}/account/tokens"
ACCOUNT = f"{API}/account"
USERS = f"{API}/users"
AUDIT = f"{API}/audit/entries"
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
OTHER = "another battery staple"

As = Callable[..., httpx.Client]


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    return ApiContext(Settings(data_directory=tmp_path), repository, store)


@pytest.fixture
def service(context: ApiContext) -> Iterator[httpx.Client]:
    with serving(create_app(context), as_somebody=False) as client:
        yield client


@pytest.fixture
def people(repository: Repository) -> None:
    """Who works at the plant: engineer Erik, Ada who manages users, and Paul who reads the audit trail."""
    kept, now_ns = hashed(PASSWORD), time.time_ns()
    for name, roles in (
        ("erik", [Role.ENGINEER]),
        ("ada", [Role.SECADM, Role.ENGINEER]),
        ("paul", [Role.SECAUD]),
    ):
        repository.add_user(name, roles, password=kept, by=TESTS, now_ns=now_ns)


@pytest.fixture
def log_in(service: httpx.Client, people: None) -> Iterator[As]:
    """Clients that have logged in."""
    with ExitStack() as clients:

        def logged_in(name: str, password: str = PASSWORD) -> httpx.Client:
            client = clients.enter_context(
                httpx.Client(base_url=service.base_url, trust_env=False, timeout=LONGEST_S)
            )
            client.post(f"{API}/login", json={"name": name, "password": password})
            return client

        yield logged_in


def made(client: httpx.Client, **wanted: Any) -> dict[str, Any]:
    """A new token of who asks."""
    answer = client.post(OWN, json={"label": "program", **wanted})
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def with_token(client: httpx.Client, secret: str) -> httpx.Client:
    """The same service, asked with a token."""
    return httpx.Client(base_url=client.base_url, headers=bearer(secret), trust_env=False, timeout=LONGEST_S)


def in_seconds(seconds: float) -> str:
    return rfc3339(time.time_ns() + round(seconds * NANOSECONDS_PER_SECOND))


def in_days(days: float) -> str:
    return in_seconds(days * 86_400)


def actions(repository: Repository) -> list[str]:
    with repository.audit_trail() as trail:
        return [entry.action for entry in trail.entries()]


def test_a_token_that_ends_soon_makes_none_without_an_end(log_in: As) -> None:
    erik = log_in("erik")
    parent = made(erik, expires_time=in_seconds(20))
    with with_token(erik, parent["token"]) as program:
        child = made(program)
        assert nanoseconds(child["expires_time"]) <= nanoseconds(parent["expires_time"])
        refused = program.post(OWN, json={"label": "later", "expires_time": in_days(1)})
        assert refused.status_code == 422
        assert "the end of the token that asks" in refused.json()["detail"]


def test_a_child_ends_with_its_parent_and_so_does_a_grandchild(log_in: As) -> None:
    erik = log_in("erik")
    parent = made(erik)
    with with_token(erik, parent["token"]) as program:
        child = made(program)
    with with_token(erik, child["token"]) as program:
        grandchild = made(program)
        assert grandchild["parent"] == child["id"]
    assert erik.delete(f"{OWN}/{parent['id']}").status_code == 204
    for one in (parent, child, grandchild):
        with with_token(erik, one["token"]) as program:
            assert program.get(ACCOUNT).status_code == 401
    assert erik.get(OWN).json()["items"] == []


def test_a_token_of_a_narrow_scope_makes_no_wider_one(log_in: As) -> None:
    ada = log_in("ada")
    parent = made(ada, scope=["users", "account"])
    with with_token(ada, parent["token"]) as program:
        child = made(program)
        assert set(child["scope"]) == {"users", "account"}
        assert program.post(OWN, json={"label": "wide", "scope": ["view"]}).status_code == 422
        assert program.post(f"{USERS}/ada/tokens", json={"label": "full"}).status_code == 405
    with with_token(ada, child["token"]) as program:
        assert set(program.get(ACCOUNT).json()["permissions"]) == {"users", "account"}


def test_a_token_that_manages_users_gets_no_session_of_its_own_user(log_in: As) -> None:
    ada = log_in("ada")
    with with_token(ada, made(ada, scope=["users"])["token"]) as program:
        refused = program.put(f"{USERS}/ada/password", json={"password": OTHER})
    assert refused.status_code == 409
    assert log_in("ada").get(ACCOUNT).status_code == 200, "the password is the same"


def test_a_token_outlives_no_role_of_its_user(log_in: As) -> None:
    erik, ada = log_in("erik"), log_in("ada")
    with with_token(erik, made(erik, scope=["configure"])["token"]) as program:
        ada.patch(f"{USERS}/erik", json={"roles": ["VIEWER"]})
        assert program.delete(f"{API}/motors/PUMP-A1/baseline").status_code == 403


@pytest.mark.parametrize("whose", ["erik", "paul"])
def test_nobody_makes_a_token_of_somebody_else(repository: Repository, log_in: As, whose: str) -> None:
    ada = log_in("ada")
    assert ada.post(f"{USERS}/{whose}/tokens", json={"label": "mine"}).status_code == 405
    for by in (Actor("ada", "127.0.0.1", frozenset({Role.SECADM})), TESTS):
        with pytest.raises(TokenOfAnotherError):
            repository.add_token(
                whose, "mine", digest_of(new_token()), scope=None, expires_ns=None, by=by, now_ns=1
            )
    assert repository.tokens_of_users([whose]) == {}


def test_the_database_keeps_no_child_that_is_wider_whoever_asks(repository: Repository, people: None) -> None:
    def add(scope: set[str] | None, expires_ns: int | None, parent: str | None) -> str:
        return repository.add_token(
            "erik",
            "t",
            digest_of(new_token()),
            scope=scope,
            expires_ns=expires_ns,
            parent=parent,
            by=Actor("erik", "127.0.0.1"),
            now_ns=1,
        ).id

    parent = add({"view"}, 100, None)
    for scope, expires_ns in ((None, 100), ({"view", "note"}, 100), ({"view"}, 101), ({"view"}, None)):
        with pytest.raises(WiderTokenError):
            add(scope, expires_ns, parent)
    with pytest.raises(NotFoundError):
        add({"view"}, 100, "gone")
    assert add({"view"}, 100, parent)


def test_no_token_lasts_longer_than_the_settings_let_it(log_in: As) -> None:
    erik, now_ns = log_in("erik"), time.time_ns()
    days = (nanoseconds(made(erik)["expires_time"]) - now_ns) / NANOSECONDS_PER_DAY
    assert 89.9 < days < 90.1
    refused = erik.post(OWN, json={"label": "long", "expires_time": in_days(91)})
    assert refused.status_code == 422
    assert "access.token_days" in refused.json()["detail"]


def test_a_token_without_an_end_is_for_settings_that_allow_it_and_ends_when_they_no_longer_do(
    context: ApiContext, repository: Repository, people: None
) -> None:
    endless = AccessSettings.model_validate({"token_days": "unlimited"})
    settings = context.settings.model_copy(update={"access": endless})
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        client.post(f"{API}/login", json={"name": "erik", "password": PASSWORD})
        token = made(client)
        assert token["expires_time"] is None
    later_ns = time.time_ns() + 91 * NANOSECONDS_PER_DAY
    secret = token["token"]
    assert identity_of_token(repository, endless, secret, now_ns=later_ns) is not None
    assert identity_of_token(repository, AccessSettings(), secret, now_ns=later_ns) is None


ENDING: dict[str, Callable[[httpx.Client, httpx.Client], httpx.Response]] = {
    "the own password is changed": lambda erik, _: erik.put(
        f"{ACCOUNT}/password", json={"old": PASSWORD, "new": OTHER}
    ),
    "the password is reset": lambda _, ada: ada.put(f"{USERS}/erik/password", json={"password": OTHER}),
    "sessions are ended": lambda _, ada: ada.delete(f"{USERS}/erik/sessions"),
    "all tokens are ended": lambda _, ada: ada.delete(f"{USERS}/erik/tokens"),
    "all own tokens are ended": lambda erik, _: erik.delete(OWN),
    "the user is disabled": lambda _, ada: ada.patch(f"{USERS}/erik", json={"disabled": True}),
    "the user is deleted": lambda _, ada: ada.delete(f"{USERS}/erik"),
}


@pytest.mark.parametrize("how", ENDING)
def test_a_stolen_token_ends_when(log_in: As, repository: Repository, how: str) -> None:
    erik, ada = log_in("erik"), log_in("ada")
    with with_token(erik, made(erik)["token"]) as thief:
        assert thief.get(ACCOUNT).status_code == 200
        answer = ENDING[how](erik, ada)
        assert answer.status_code in (200, 204), answer.text
        assert thief.get(ACCOUNT).status_code == 401
    assert "tokens-revoked" in actions(repository)


def test_a_disabled_user_who_is_let_in_again_has_no_old_tokens(log_in: As) -> None:
    erik, ada = log_in("erik"), log_in("ada")
    with with_token(erik, made(erik)["token"]) as thief:
        for disabled in (True, False):
            ada.patch(f"{USERS}/erik", json={"disabled": disabled})
        assert thief.get(ACCOUNT).status_code == 401


@pytest.fixture
def provider() -> Iterator[IdentityProvider]:
    with identity_provider() as provider:
        provider.wants_secret = False
        provider.claims = dict(ANNA)
        yield provider


@pytest.fixture
def signing_on(context: ApiContext, provider: IdentityProvider) -> Iterator[httpx.Client]:
    """A browser of Anna, whom the identity provider knows."""
    settings = settings_with(context, provider.url)
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        assert back(client).status_code == 200
        yield client


def test_a_token_ends_when_the_identity_provider_lets_its_user_in_no_more(
    signing_on: httpx.Client, provider: IdentityProvider, repository: Repository
) -> None:
    with with_token(signing_on, made(signing_on)["token"]) as program:
        assert program.get(ACCOUNT).status_code == 200
        provider.claims["realm"] = {"groups": ["strangers"]}
        assert back(signing_on).status_code == 403
        assert program.get(ACCOUNT).status_code == 401
        assert repository.user("anna").roles == frozenset()
        assert signing_on.get(ACCOUNT).status_code == 401
        provider.claims = dict(ANNA)
        assert back(signing_on).status_code == 200
        assert program.get(ACCOUNT).status_code == 401, "it is gone for good"


def test_a_token_outlives_the_removal_of_its_user_at_the_identity_provider_by_days_at_most(
    signing_on: httpx.Client, engine: Engine
) -> None:
    """Nobody tells the service of a removal: who does not sign on for a week is not let in by tokens."""
    with with_token(signing_on, made(signing_on)["token"]) as program:
        assert program.get(ACCOUNT).status_code == 200
        eight_days_ago = time.time_ns() - 8 * NANOSECONDS_PER_DAY
        with engine.begin() as connection:
            connection.execute(text("UPDATE users SET confirmed_ns = :ns"), {"ns": eight_days_ago})
        assert program.get(ACCOUNT).status_code == 401
        assert back(signing_on).status_code == 200
        assert program.get(ACCOUNT).status_code == 200


def test_a_token_ends_when_there_is_no_identity_provider_any_more(
    signing_on: httpx.Client, repository: Repository
) -> None:
    secret = made(signing_on)["token"]
    assert identity_of_token(repository, AccessSettings(), secret, now_ns=time.time_ns()) is None


def test_nobody_gets_a_password_who_logs_in_at_the_identity_provider(
    signing_on: httpx.Client, repository: Repository
) -> None:
    """They could log in with it when the provider would not let them in any more."""
    with with_token(signing_on, token_of(repository, Role.SECADM)) as admin:
        assert admin.put(f"{USERS}/anna/password", json={"password": OTHER}).status_code == 409


def test_a_token_of_who_came_by_way_of_a_proxy_may_no_more_than_they_might(
    context: ApiContext, repository: Repository, people: None
) -> None:
    proxy = {
        "addresses": ["127.0.0.1"],
        "user_header": "X-User",
        "roles_header": "X-Groups",
        "roles": {"VIEWER": ["staff"], "SECADM": ["it"], "SECAUD": ["audit"]},
    }
    access = AccessSettings.model_validate({"proxy": proxy})
    settings = context.settings.model_copy(update={"access": access})
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        client.headers.update({"X-User": "erik", "X-Groups": "staff"})
        assert set(made(client)["scope"]) == {"account", "metrics", "view"}
        client.headers["X-Groups"] = "it, audit"
        assert client.get(ACCOUNT).status_code == 401, "nobody is both"


BOTH = [Role.SECADM, Role.SECAUD]


def test_nobody_manages_users_and_reads_the_audit_trail(
    engine: Engine, repository: Repository, people: None
) -> None:
    with pytest.raises(RolesNotSeparateError):
        repository.add_user("eve", BOTH, password=None, by=TESTS, now_ns=1)
    with pytest.raises(RolesNotSeparateError):
        repository.change_user("ada", roles=BOTH, by=TESTS, now_ns=1)
    with pytest.raises(RolesNotSeparateError):
        repository.user_of_subject("x", "eve", BOTH, full_name=None, by=TESTS, now_ns=1)
    with pytest.raises(IntegrityError), engine.begin() as connection:
        connection.execute(text("UPDATE users SET roles = 'ENGINEER SECADM SECAUD' WHERE name = 'ada'"))


def test_a_group_of_the_identity_provider_gives_nobody_both_roles(
    signing_on: httpx.Client, provider: IdentityProvider, context: ApiContext
) -> None:
    oidc = settings_with(context, provider.url).access.oidc
    assert oidc is not None
    roles = {"SECADM": ("it",), "SECAUD": ("it",)}
    access = AccessSettings(oidc=oidc.model_copy(update={"roles": roles}))
    settings = context.settings.model_copy(update={"access": access})
    provider.claims["realm"] = {"groups": ["it"]}
    with serving(create_app(replace(context, settings=settings)), as_somebody=False) as client:
        refused = back(client)
        assert refused.status_code == 409
        assert "SECADM and SECAUD" in refused.json()["detail"]


WAYS_TO_THE_TRAIL: dict[str, Callable[[httpx.Client], httpx.Response]] = {
    "asking for it": lambda ada: ada.get(AUDIT),
    "the role": lambda ada: ada.patch(f"{USERS}/ada", json={"roles": ["SECADM", "SECAUD"]}),
    "another role in place of the own": lambda ada: ada.patch(f"{USERS}/ada", json={"roles": ["SECAUD"]}),
    "a puppet": lambda ada: ada.post(USERS, json={"name": "puppet", "roles": ["SECAUD"], "password": OTHER}),
    "a puppet without a password": lambda ada: ada.post(USERS, json={"name": "puppet", "roles": ["SECAUD"]}),
    "the role for a friend": lambda ada: ada.patch(f"{USERS}/erik", json={"roles": ["SECAUD"]}),
    "the auditor's password": lambda ada: ada.put(f"{USERS}/paul/password", json={"password": OTHER}),
    "a scope": lambda ada: ada.post(OWN, json={"label": "t", "scope": ["audit"]}),
}


@pytest.mark.parametrize("way", WAYS_TO_THE_TRAIL)
def test_who_manages_users_does_not_get_at_the_audit_trail_by(
    log_in: As, repository: Repository, way: str
) -> None:
    ada = log_in("ada")
    token_of(repository, Role.SECADM, name="second")  # so that ada is not kept for being the last
    refused = WAYS_TO_THE_TRAIL[way](ada)
    assert refused.status_code in (403, 409, 422), refused.text
    assert ada.get(AUDIT).status_code == 403
    assert log_in("paul").get(AUDIT).status_code == 200, "the auditor still does"


def test_a_known_password_does_not_become_that_of_an_auditor(log_in: As, repository: Repository) -> None:
    """Ada makes a user whose password she knows, changes it, and asks the files' owner for the role."""
    ada = log_in("ada")
    ada.post(USERS, json={"name": "puppet", "roles": ["VIEWER"], "password": OTHER})
    puppet = log_in("puppet", OTHER)
    puppet.put(f"{ACCOUNT}/password", json={"old": OTHER, "new": PASSWORD})
    puppet = log_in("puppet")
    with with_token(puppet, made(puppet)["token"]) as program:
        repository.change_user("puppet", roles=[Role.SECAUD], by=TESTS, now_ns=time.time_ns())
        assert program.get(ACCOUNT).status_code == 401
    assert log_in("puppet").get(ACCOUNT).status_code == 401
    with pytest.raises(AuditorAccountError):
        repository.set_password("puppet", hashed(OTHER), by=Actor("ada", "10.0.0.7"), now_ns=1)


def test_a_reset_password_opens_nothing_until_its_owner_has_changed_it(
    log_in: As, repository: Repository
) -> None:
    ada = log_in("ada")
    assert ada.put(f"{USERS}/erik/password", json={"password": OTHER}).status_code == 204
    assert ada.get(f"{USERS}/erik").json()["password_set_by"] == "ada"  # noqa: S105 - a name
    as_erik = log_in("erik", OTHER)
    account = as_erik.get(ACCOUNT).json()
    assert (account["permissions"], account["password_set_by"]) == (["account"], "ada")
    refused = as_erik.get(f"{API}/motors")
    assert refused.status_code == 403
    assert "ada set this password" in refused.json()["detail"]
    assert as_erik.post(OWN, json={"label": "around it"}).status_code == 403
    same = as_erik.put(f"{ACCOUNT}/password", json={"old": OTHER, "new": OTHER})
    assert same.status_code == 422, "the same one is no change"
    assert as_erik.put(f"{ACCOUNT}/password", json={"old": OTHER, "new": PASSWORD}).status_code == 204
    assert log_in("erik").get(f"{API}/motors").status_code == 200
    assert ada.get(f"{USERS}/erik").json()["password_set_by"] is None
    with repository.audit_trail() as trail:
        set_by = [
            (one.actor, one.subject, one.after) for one in trail.entries() if one.action == "password-set"
        ]
    assert set_by == [("ada", "erik", '{"must_change":true}'), ("erik", "erik", '{"must_change":false}')]


def test_no_scope_has_what_its_permission_is_not(log_in: As) -> None:
    """Every permission of the audit trail is kept from who manages users, whatever is added later."""
    ada = log_in("ada")
    may = set(ada.get(ACCOUNT).json()["permissions"])
    assert Permission.AUDIT not in may
    assert Permission.USERS not in set(log_in("paul").get(ACCOUNT).json()["permissions"])
