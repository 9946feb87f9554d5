"""The pages on which users are managed, and that of the own account."""

import time

import httpx
import pytest

from service.access.bearer_secrets import digest_of
from service.access.passwords import hashed
from service.storage import Repository
from service.storage.records import Actor, Role
from testing.service.accounts import TESTER, token_of
from tests.service.web.pages import HOSTILE, addresses, page, words

NOW_NS = time.time_ns()
ADMIN = Actor("admin", "command line")
PASSWORD = "correct horse battery"  # noqa: S105 - of a test


@pytest.fixture
def ada(repository: Repository) -> str:
    repository.add_user(
        "ada", [Role.OPERATOR], password=None, full_name=HOSTILE, by=ADMIN, now_ns=NOW_NS - 10
    )
    repository.begin_session(
        "1" * 64,
        "ada",
        "password",
        most=100,
        oldest_ns=0,
        idle_since_ns=0,
        by=Actor("ada", "10.0.0.7"),
        now_ns=NOW_NS,
    )
    return "ada"


def test_users_are_listed_with_roles_sessions_and_tokens(client: httpx.Client, ada: str) -> None:
    document = page(client.get("/people"))
    (row, tester) = (
        words(one, "td") for one in document.cssselect("section[aria-labelledby=users] tbody tr")
    )
    assert words(document, "tbody th")[0] == f"{ada} {HOSTILE}"
    assert row[0:2] == ["OPERATOR", "not at all: tokens alone"]
    assert row[2].endswith("from 10.0.0.7")
    assert row[3:] == ["1", "0"]
    assert tester[4] == "1"
    assert words(document, "section[aria-labelledby=tokens] tbody th") == ["tests"]


def test_a_user_is_made_changed_and_deleted(client: httpx.Client, repository: Repository) -> None:
    form = {"name": "Bob", "full_name": "Bob B.", "password": PASSWORD, "roles": ["VIEWER", "SECADM"]}
    answer = client.post("/people", data=form)
    assert answer.headers["location"] == "/people/bob?done=user-added"
    user = repository.user("bob")
    assert (user.roles, user.has_password) == (frozenset({Role.VIEWER, Role.SECADM}), True)
    document = page(client.get("/people/bob"))
    assert "tester" in words(document, "header")[0], "who looks, not whom they look at"
    assert "User(" not in words(document, "header")[0]
    chosen = [box.get("value") for box in document.cssselect("input[name=roles][checked]")]
    assert chosen == ["VIEWER", "SECADM"]
    client.post("/people/bob", data={"roles": ["OPERATOR"], "disabled": "true"})
    user = repository.user("bob")
    assert (user.roles, user.disabled, user.full_name) == (frozenset({Role.OPERATOR}), True, "Bob B.")
    client.post("/people/bob", data={"full_name": "Bob C."})
    user = repository.user("bob")
    assert (user.roles, user.disabled, user.full_name) == (frozenset(), False, "Bob C.")
    assert client.post("/people/bob/deletion").headers["location"] == "/people?done=user-deleted"
    assert client.get("/people/bob").status_code == 404


@pytest.mark.parametrize(
    ("form", "told"),
    [
        ({"name": ""}, "name: "),
        ({"name": HOSTILE}, "1 to 100 letters"),
        ({"name": "carl", "password": "short"}, "at least 10 characters"),
        ({"name": "tester"}, "tester"),
    ],
)
def test_what_is_wrong_with_a_new_user_is_told(client: httpx.Client, form: dict[str, str], told: str) -> None:
    answer = client.post("/people", data=form)
    assert answer.status_code in (409, 422)
    assert told in answer.text
    assert HOSTILE not in answer.text


def test_sessions_end_and_failed_logins_are_forgotten(
    client: httpx.Client, repository: Repository, ada: str
) -> None:
    client.post(f"/people/{ada}/sessions-end")
    assert repository.session_of("1" * 64) is None
    assert client.post(f"/people/{ada}/unlocking").headers["location"] == "/people/ada?done=user-unlocked"
    answer = client.post(f"/people/{ada}/password", data={"password": PASSWORD})
    assert answer.headers["location"] == "/people/ada?done=password-set"
    assert repository.user(ada).has_password


def test_the_last_administrator_stays(client: httpx.Client) -> None:
    answer = client.post("/people/tester", data={"roles": ["VIEWER"]})
    assert answer.status_code == 409
    assert "SECADM" in answer.text


def test_the_secret_of_a_token_is_shown_once(client: httpx.Client, repository: Repository) -> None:
    form = {"label": HOSTILE, "scope": ["view", "metrics"], "days": "30"}
    answer = client.post("/account/tokens", data=form)
    assert answer.headers["cache-control"] == "no-store"
    (secret,) = words(page(answer), "#secret")
    kept = repository.token_with(digest_of(secret))
    assert kept is not None
    token, user = kept
    assert (user.name, token.label, token.scope) == (TESTER, HOSTILE, frozenset({"view", "metrics"}))
    document = page(client.get(f"/people/{TESTER}"))
    assert secret not in document.text_content()
    (revoke,) = [
        one for one in addresses(document, "section[aria-labelledby=tokens] td form") if token.id in one
    ]
    assert client.post(revoke).headers["location"] == f"/people/{TESTER}?done=token-revoked"
    assert repository.token_with(digest_of(secret)) is None
    assert client.post("/account/tokens", data={"label": "", "days": ""}).status_code == 422


def test_all_tokens_of_a_user_end(client: httpx.Client, repository: Repository, ada: str) -> None:
    token_of(repository, name=ada)
    assert page(client.get(f"/people/{ada}")).cssselect(f"form[action='/people/{ada}/tokens-end']")
    assert client.post(f"/people/{ada}/tokens-end").headers["location"] == "/people/ada?done=tokens-revoked"
    assert repository.tokens_of_users([ada]) == {}
    assert repository.session_of("1" * 64) is not None
    own = page(client.get("/account"))
    assert own.cssselect("form[action='/account/tokens-end']")
    client.post("/account/tokens-end")
    assert repository.tokens_of_users([TESTER]) == {}


def test_a_password_of_another_is_told_and_leads_to_the_account(
    client: httpx.Client, anybody: httpx.Client, repository: Repository
) -> None:
    client.post("/people", data={"name": "bob", "password": PASSWORD, "roles": ["VIEWER"]})
    assert "by tester, not changed yet" in " ".join(page(client.get("/people/bob")).text_content().split())
    login = anybody.post("/login", data={"name": "bob", "password": PASSWORD, "next": "/alarms"})
    assert login.headers["location"] == "/account"
    told = page(anybody.get("/account")).text_content()
    assert "tester set your password and knows it" in told
    assert anybody.get("/alarms").status_code == 403


def test_only_who_manages_users_sees_the_pages(
    client: httpx.Client, repository: Repository, ada: str
) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.ENGINEER, name='engineer')}"
    for path in ("/people", f"/people/{ada}"):
        assert client.get(path).status_code == 403
    assert client.post(f"/people/{ada}/deletion").status_code == 403
    assert "People" not in words(page(client.get("/account")), "nav a")


def test_the_own_account(client: httpx.Client, repository: Repository) -> None:
    document = page(client.get("/account"))
    text = " ".join(document.text_content().split())
    assert "Acknowledge and shelve alarms." in text
    assert "Change password" not in text, "there is none: a token asks"
    answer = client.post("/account/tokens", data={"label": "historian", "days": ""})
    (secret,) = words(page(answer), "#secret")
    found = repository.token_with(digest_of(secret))
    assert found is not None
    token = found[0]
    assert (token.label, token.scope) == ("historian", frozenset(scopes(client)))
    assert token.expires_ns is not None, "no later than that of the token that asks"
    client.post(f"/account/tokens/{found[0].id}/revocation")
    assert repository.token_with(digest_of(secret)) is None


def scopes(client: httpx.Client) -> list[str]:
    """What the token may do that asks: a token makes none that may do more."""
    return [str(one) for one in client.get("/api/v1/account").json()["permissions"]]


def test_the_own_password_is_changed(anybody: httpx.Client, repository: Repository) -> None:
    repository.add_user("ada", [Role.VIEWER], password=hashed(PASSWORD), by=ADMIN, now_ns=NOW_NS)
    login = anybody.post("/login", data={"name": "ada", "password": PASSWORD})
    anybody.cookies.set("statorwatch_session", login.cookies["statorwatch_session"])
    document = page(anybody.get("/account"))
    assert addresses(document, "section[aria-labelledby=password] form") == ["/account/password"]
    new = f"{PASSWORD} staple"
    differing = anybody.post("/account/password", data={"old": PASSWORD, "new": new, "again": PASSWORD})
    assert differing.status_code == 422
    assert "the same password twice" in differing.text
    wrong = anybody.post("/account/password", data={"old": "wrong password", "new": new, "again": new})
    assert wrong.status_code == 401
    answer = anybody.post("/account/password", data={"old": PASSWORD, "new": new, "again": new})
    assert answer.headers["location"] == "/login?done=password"
    assert anybody.get("/account").headers["location"].startswith("/login?next=")


def test_before_there_are_users_the_account_says_how_to_begin(anybody: httpx.Client) -> None:
    text = page(anybody.get("/account")).text_content()
    assert "mcc user add NAME" in text
    assert "Make a token" not in text
