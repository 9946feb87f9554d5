"""Logging in and out: what a session is, when it ends, and what stands in the way of guessing."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import httpx
import pytest
from fastapi import FastAPI
from sqlalchemy import Engine, text

from core.units import NANOSECONDS_PER_SECOND
from service.access.passwords import HASH_MEMORY_KIB, hashed, is_correct
from service.api import ApiContext, create_app
from service.configuration.access import AccessSettings
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS, token_of
from tests.service.api.access.conftest import As
from tests.service.api.serving import LONGEST_S, serving

ANNA = {"name": "anna", "password": "correct horse battery"}
LOGIN, LOGOUT, MOTORS = "/api/v1/login", "/api/v1/logout", "/api/v1/motors"
KEPT = hashed(ANNA["password"])


@pytest.fixture
def client(anonymous: httpx.Client, repository: Repository) -> httpx.Client:
    """A browser, where anna and bert are users."""
    for name in ("anna", "bert"):
        roles = [Role.OPERATOR, Role.SECADM] if name == "bert" else [Role.OPERATOR]
        repository.add_user(name, roles, password=KEPT, by=TESTS, now_ns=time.time_ns())
    return anonymous


def another(client: httpx.Client) -> httpx.Client:
    return httpx.Client(base_url=client.base_url, trust_env=False, timeout=LONGEST_S)


def test_a_session_is_a_cookie_that_scripts_and_other_sites_do_not_get(client: httpx.Client) -> None:
    answer = client.post(LOGIN, json={**ANNA, "name": " Anna "})
    assert answer.status_code == 200
    assert answer.json()["roles"] == ["OPERATOR"]
    assert answer.headers["cache-control"] == "no-store"
    cookie = answer.headers["set-cookie"]
    for part in ("HttpOnly", "SameSite=strict", "Path=/", "Max-Age=43200"):
        assert part in cookie
    assert "Secure" not in cookie, "without TLS a browser would not send it back"
    assert client.get("/api/v1/account").json()["way"] == "session"
    assert client.post("/api/v1/motors/PUMP-A1/event-reports").status_code == 202
    shown = {"Cookie": "; ".join(f"{name}={value}" for name, value in client.cookies.items())}
    with another(client) as elsewhere:
        assert elsewhere.get(MOTORS, headers=shown).status_code == 200
        assert client.post(LOGOUT).status_code == 204
        assert client.get(MOTORS).status_code == 401
        assert elsewhere.get(MOTORS, headers=shown).status_code == 401, "not only the cookie is gone"
        assert elsewhere.get(MOTORS, headers={"Cookie": "statorwatch_session=forged"}).status_code == 401


@pytest.mark.parametrize(
    "origin", ["https://evil.example", "null", "http://127.0.0.1:1", "http://localhost.evil.example"]
)
def test_a_page_of_another_site_cannot_use_a_session(client: httpx.Client, origin: str) -> None:
    client.post(LOGIN, json=ANNA)
    trigger = "/api/v1/motors/PUMP-A1/event-reports"
    assert client.post(trigger, headers={"Origin": origin}).status_code == 403
    for site in ("cross-site", "same-site"):
        assert client.post(trigger, headers={"Sec-Fetch-Site": site}).status_code == 403
    own = {"Origin": str(client.base_url).rstrip("/"), "Sec-Fetch-Site": "same-origin"}
    assert client.post(trigger, headers=own).status_code == 202
    assert client.post(LOGIN, json=ANNA, headers={"Origin": origin}).status_code == 403


@pytest.mark.parametrize("way", ["roles", "disabled", "password", "own password", "sessions", "deleted"])
def test_what_ends_a_session(client: httpx.Client, repository: Repository, as_: As, way: str) -> None:
    admin = as_(Role.SECADM)
    client.post(LOGIN, json=ANNA)
    with another(client) as elsewhere:
        elsewhere.post(LOGIN, json=ANNA)
        assert elsewhere.get(MOTORS).status_code == 200
        anna = "/api/v1/users/anna"
        answer = {
            "roles": lambda: admin.patch(anna, json={"roles": ["OPERATOR", "ENGINEER"]}),
            "disabled": lambda: admin.patch(anna, json={"disabled": True}),
            "password": lambda: admin.put(f"{anna}/password", json={"password": "another battery"}),
            "own password": lambda: client.put(
                "/api/v1/account/password", json={"old": ANNA["password"], "new": "another battery"}
            ),
            "sessions": lambda: admin.delete(f"{anna}/sessions"),
            "deleted": lambda: admin.delete(anna),
        }[way]()
        assert answer.is_success, answer.text
        assert elsewhere.get(MOTORS).status_code == 401
        assert client.get(MOTORS).status_code == 401
    still = client.post(LOGIN, json=ANNA).status_code
    assert still == (200 if way in ("roles", "sessions") else 401)


def test_a_session_ends_when_it_is_idle_or_old(client: httpx.Client, engine: Engine) -> None:
    client.post(LOGIN, json=ANNA)

    def move(column: str, seconds: float) -> None:
        back_ns = round(seconds * NANOSECONDS_PER_SECOND)
        with engine.begin() as connection:
            connection.execute(text(f"UPDATE user_sessions SET {column} = {column} - {back_ns}"))  # noqa: S608

    move("used_ns", 59 * 60)
    assert client.get(MOTORS).status_code == 200, "used within the hour, and again now"
    move("used_ns", 59 * 60)
    assert client.get(MOTORS).status_code == 200
    move("used_ns", 61 * 60)
    ended = client.get(MOTORS)
    assert ended.status_code == 401
    assert "the session has ended" in ended.json()["detail"]
    client.post(LOGIN, json=ANNA)
    move("created_ns", 12 * 3600 + 1)
    assert client.get(MOTORS).status_code == 401


def test_after_failed_logins_none_is_tried_for_a_while(
    client: httpx.Client, repository: Repository, as_: As
) -> None:
    wrong = {**ANNA, "password": "wrong"}
    assert [client.post(LOGIN, json=wrong).status_code for _ in range(6)] == [401] * 5 + [429]
    refused = client.post(LOGIN, json=ANNA)
    assert refused.status_code == 429, "also with the right password"
    assert 1 <= int(refused.headers["retry-after"]) <= 31
    assert client.post(LOGIN, json={**ANNA, "name": "bert"}).status_code == 200, "others are not concerned"
    unknown = {**wrong, "name": "nobody"}
    assert [client.post(LOGIN, json=unknown).status_code for _ in range(6)] == [401] * 5 + [429]
    admin = as_(Role.SECADM)
    assert admin.get("/api/v1/users/anna").json()["locked_until_time"] is not None
    assert admin.delete("/api/v1/users/anna/lock").status_code == 204
    assert client.post(LOGIN, json=ANNA).status_code == 200
    assert admin.get("/api/v1/users/anna").json()["locked_until_time"] is None


def test_others_cannot_lock_the_owner_out(client: httpx.Client, repository: Repository) -> None:
    assert client.post(LOGIN, json=ANNA).status_code == 200
    settings = AccessSettings()
    from service.access.logins import LoginLockedError, attempt

    now_ns = time.time_ns()
    refused = 0
    for number in range(200):
        try:
            attempt(repository, settings, "anna", f"192.0.2.{number}", now_ns=now_ns)
        except LoginLockedError:
            refused += 1
    assert refused > 100, "a network of attackers is slowed down"
    assert client.post(LOGIN, json=ANNA).status_code == 200, "from where anna logged in last"


def test_many_attempts_at_once_are_no_more_than_allowed(client: httpx.Client) -> None:
    def guess(number: int) -> int:
        with another(client) as one:
            return one.post(LOGIN, json={**ANNA, "password": f"guess {number}"}).status_code

    with ThreadPoolExecutor(12) as threads:
        answers = list(threads.map(guess, range(24)))
    assert answers.count(401) <= 5
    assert set(answers) <= {401, 429, 503}


@pytest.mark.campaign
def test_healthz_is_quick_while_many_log_in(client: httpx.Client) -> None:
    """Two passwords at a time: the memory that hashes take has a bound."""
    stop = threading.Event()

    def guess(number: int) -> None:
        with another(client) as one:
            while not stop.is_set():
                one.post(LOGIN, json={"name": f"user{number}", "password": "x"})

    with ThreadPoolExecutor(20) as threads:
        for number in range(20):
            threads.submit(guess, number)
        try:
            assert [client.get("/healthz", timeout=10).status_code for _ in range(20)] == [200] * 20
        finally:
            stop.set()
    assert HASH_MEMORY_KIB == 64 * 1024, "the page says 64 MiB"


def test_a_login_takes_as_long_for_a_name_that_there_is_not() -> None:
    def cpu_s(kept: str | None) -> float:
        begun_s = time.thread_time()
        assert is_correct(ANNA["password"], kept) is (kept is not None)
        return time.thread_time() - begun_s

    known, unknown = (min(cpu_s(kept) for _ in range(3)) for kept in (KEPT, None))
    assert 0.5 < known / unknown < 2.0


def test_no_password_and_no_secret_is_kept_or_logged(
    client: httpx.Client, repository: Repository, engine: Engine, as_: As, logs: list[object]
) -> None:
    admin = as_(Role.SECADM)
    client.post(LOGIN, json=ANNA)
    client.post(LOGIN, json={"name": "anna", "password": "Mistyped-Secret"})
    client.post(LOGIN, json={"name": "Secret-In-Wrong-Field", "password": "x"})
    admin.post("/api/v1/users", json={"name": "carl", "roles": [], "password": "Carls-Secret-1"})
    token = admin.post("/api/v1/account/tokens", json={"label": "t"}).json()["token"]
    with repository.audit_trail() as trail:
        entries = list(trail.entries())
    assert {entry.action for entry in entries} >= {"logged-in", "login-failed", "user-added", "token-added"}
    assert {entry.subject for entry in entries if entry.action == "login-failed"} == {
        "anna",
        "(no such user)",
    }
    with engine.connect() as connection:
        tables = ("users", "user_sessions", "api_tokens", "failed_logins", "audit_entries")
        kept = str([connection.execute(text(f"SELECT * FROM {table}")).all() for table in tables])  # noqa: S608
    for secret in (
        ANNA["password"],
        "Mistyped-Secret",
        "secret-in-wrong-field",
        "Carls-Secret-1",
        token,
        *client.cookies.values(),
    ):
        assert secret not in kept.replace("Secret-In-Wrong-Field", "secret-in-wrong-field")
        assert secret not in str(logs)


@pytest.mark.parametrize("password", ["short", "x" * 1025, "carl-the-first", "with\0nul......"])
def test_a_password_that_does_not_fit_the_rule_is_refused(
    client: httpx.Client, as_: As, password: str
) -> None:
    wanted = {"name": "Carl-the-first", "roles": ["VIEWER"], "password": password}
    assert as_(Role.SECADM).post("/api/v1/users", json=wanted).status_code == 422


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"[]",
        b'{"name": "anna"}',
        b'{"name": ["anna"], "password": "x"}',
        b'{"name": "\\ud800", "password": "\\ud800"}',
    ],
)
def test_a_login_that_is_none_is_refused(client: httpx.Client, body: bytes) -> None:
    refused = client.post(LOGIN, content=body, headers={"Content-Type": "application/json"})
    assert refused.status_code in (401, 422)
    assert refused.headers["content-type"] == "application/problem+json"


def test_the_last_who_manages_users_stays(client: httpx.Client) -> None:
    assert client.post(LOGIN, json={**ANNA, "name": "bert"}).status_code == 200
    bert = "/api/v1/users/bert"
    for refused in (
        client.patch(bert, json={"roles": ["OPERATOR"]}),
        client.patch(bert, json={"disabled": True}),
        client.delete(bert),
    ):
        assert refused.status_code == 409
        assert "SECADM" in refused.json()["detail"]
    assert client.patch("/api/v1/users/anna", json={"roles": ["SECADM"]}).status_code == 200
    assert client.delete(bert).status_code == 204
    assert client.get(MOTORS).status_code == 401


def test_users_are_made_listed_and_found(client: httpx.Client, as_: As) -> None:
    admin = as_(Role.SECADM)
    made = admin.post(
        "/api/v1/users", json={"name": "Carl", "full_name": "Carl Cole", "roles": ["VIEWER", "SECADM"]}
    )
    assert made.status_code == 201
    assert made.headers["location"] == "/api/v1/users/carl"
    carl = admin.get(made.headers["location"]).json()
    assert (carl["name"], carl["roles"], carl["has_password"]) == (
        "carl",
        ["SECADM", "VIEWER"],
        False,
    )
    assert admin.post("/api/v1/users", json={"name": "carl", "roles": []}).status_code == 409
    for wrong in ("", "a b", "statorwatch", "../x", "x" * 101, "a\nb"):
        assert admin.post("/api/v1/users", json={"name": wrong, "roles": []}).status_code == 422
    names = [user["name"] for user in admin.get("/api/v1/users", params={"limit": 2}).json()["items"]]
    assert names == ["anna", "bert"]
    assert admin.get("/api/v1/users/nobody").status_code == 404


@pytest.fixture
def proxied(context: ApiContext) -> FastAPI:
    access = AccessSettings.model_validate(
        {
            "proxy": {
                "addresses": ["192.0.2.10", "2001:db8::/64"],
                "user_header": "X-Remote-User",
                "roles_header": "X-Remote-Groups",
                "roles": {"OPERATOR": ["control-room"], "ENGINEER": ["electrical"]},
            }
        }
    )
    settings = context.settings.model_copy(update={"access": access})
    return create_app(replace(context, settings=settings))


ASKED = {
    "X-Remote-User": "Carl",
    "X-Remote-Groups": "staff, control-room",
    "X-Forwarded-For": "10.9.9.9, 10.0.0.7",
}


@pytest.mark.anyio
@pytest.mark.parametrize(
    ("address", "headers", "status"),
    [
        ("192.0.2.10", ASKED, 200),
        ("2001:db8::7", ASKED, 200),
        ("::ffff:192.0.2.10", ASKED, 200),
        ("127.0.0.1", ASKED, 401),
        ("192.0.2.11", ASKED, 401),
        ("192.0.2.10", {}, 401),
        ("192.0.2.10", {**ASKED, "X-Remote-Groups": "staff"}, 403),
        ("192.0.2.10", {**ASKED, "X-Remote-User": "a b"}, 401),
        ("192.0.2.10", {**ASKED, "X-Remote-User": ""}, 401),
        ("192.0.2.10", {**ASKED, "X-Remote-User": "statorwatch"}, 401),
    ],
)
async def test_headers_of_the_named_proxy_count_and_no_others(
    proxied: FastAPI, repository: Repository, address: str, headers: dict[str, str], status: int
) -> None:
    transport = httpx.ASGITransport(proxied, client=(address, 4000))
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        answer = await client.post("/api/v1/motors/PUMP-A1/event-reports", headers=headers)
        assert answer.status_code == (202 if status == 200 else status), answer.text
        if status == 200:
            twice = httpx.Headers([*headers.items(), ("X-Remote-User", "admin")])
            assert (await client.get(MOTORS, headers=twice)).status_code == 401
            with repository.audit_trail() as trail:
                (entry,) = trail.entries()
            assert (entry.actor, entry.origin) == ("carl", "10.0.0.7")
            repository.add_user("carl", [Role.VIEWER], password=None, by=TESTS, now_ns=1)
            repository.change_user("carl", disabled=True, by=TESTS, now_ns=2)
            assert (await client.get(MOTORS, headers=headers)).status_code == 401


@pytest.fixture
def anyio_backend() -> str:
    return "asyncio"


def test_a_token_of_another_service_is_refused(context: ApiContext, repository: Repository) -> None:
    token = token_of(repository)
    with serving(create_app(context), as_somebody=False) as client:
        assert client.get(MOTORS, headers={"Authorization": f"bearer {token}"}).status_code == 200
        assert client.get(MOTORS, headers={"Authorization": f"Bearer {token}x"}).status_code == 401
        assert client.get(MOTORS, headers={"Authorization": f"Bearer {token[:-1]}"}).status_code == 401
