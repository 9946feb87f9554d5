"""Who is let in: by the first start's rule, by tokens, by roles."""

import time
from collections.abc import Iterator

import httpx
import pytest
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts

from service.access.bearer_secrets import digest_of, new_token
from service.access.permissions import PERMISSIONS_OF
from service.api.access.requirements import requirement_of
from service.client.credentials import bearer
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS, token_of
from testing.service.plants import SECOND_NS
from tests.service.api.access.conftest import As

MOTORS = "/api/v1/motors"
TRIGGER = "/api/v1/motors/PUMP-A1/event-reports"
NO_SUCH_ID = "00000000-0000-0000-0000-000000000000"
PARAMETERS = ("recording_id", "diagnosis_id", "report_id", "note_id", "token_id", "alarm_id", "backup_id")
OPEN = {"/healthz", "/readyz", "/api/v1/login", "/api/v1/login/passkey"}


def requests_of(app: FastAPI) -> Iterator[tuple[str, str, str]]:
    """A request of each route that changes nothing: its method, path, and the route's path."""
    for route in iter_route_contexts(app.routes):
        assert route.path is not None
        path = route.path.replace("{name}", "NOBODY")
        for parameter in PARAMETERS:
            path = path.replace(f"{{{parameter}}}", NO_SUCH_ID)
        while "{" in path:
            before, _, rest = path.partition("{")
            path = f"{before}1{rest.partition('}')[2]}"
        for method in sorted(route.methods or ()):
            yield method, path, route.path


def test_before_there_are_users_this_machine_may_look_and_change_nothing(anonymous: httpx.Client) -> None:
    assert anonymous.get(MOTORS).status_code == 200
    assert anonymous.get("/metrics").status_code == 200
    assert anonymous.get("/api/v1/openapi.json").status_code == 200
    assert anonymous.get("/api/v1/account").json()["way"] == "none"
    for method, path in (("POST", TRIGGER), ("DELETE", "/api/v1/users/x"), ("POST", "/api/v1/nothing")):
        refused = anonymous.request(method, path)
        assert refused.status_code == 403
        assert "mcc user add NAME" in refused.json()["detail"]
    login = anonymous.post("/api/v1/login", json={"name": "a", "password": "b"})
    assert login.status_code == 403
    assert "mcc user add NAME" in login.json()["detail"]
    assert anonymous.get("/api/v1/users").status_code == 403, "even looking needs the permission"


@pytest.mark.parametrize("header", ["X-Forwarded-For", "Forwarded", "Via", "X-Real-IP"])
def test_what_came_through_a_proxy_is_not_of_this_machine(anonymous: httpx.Client, header: str) -> None:
    assert anonymous.get(MOTORS, headers={header: "127.0.0.1"}).status_code == 401


@pytest.mark.parametrize("address", ["192.0.2.7", "::ffff:192.0.2.7", "2001:db8::1", "10.0.0.1"])
@pytest.mark.anyio
async def test_before_there_are_users_other_machines_see_nothing(app: FastAPI, address: str) -> None:
    transport = httpx.ASGITransport(app, client=(address, 4000))
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        for method, path, route in requests_of(app):
            answer = await client.request(method, path)
            assert (answer.status_code == 401) == (route not in OPEN), (method, path)
        refused = await client.get(MOTORS)
    assert "this service's own machine" in refused.json()["detail"]
    assert refused.headers["www-authenticate"].startswith("Bearer")


@pytest.mark.parametrize("address", ["127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"])
@pytest.mark.anyio
async def test_all_addresses_of_the_loopback_are_this_machine(app: FastAPI, address: str) -> None:
    transport = httpx.ASGITransport(app, client=(address, 4000))
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        assert (await client.get(MOTORS)).status_code == 200


@pytest.fixture(scope="module")
def anyio_backend() -> str:
    return "asyncio"


def test_once_there_are_users_nobody_else_sees_anything(
    anonymous: httpx.Client, app: FastAPI, repository: Repository
) -> None:
    token_of(repository)
    for method, path, route in requests_of(app):
        assert (anonymous.request(method, path).status_code == 401) == (route not in OPEN), (method, path)
    for path in ("/nothing", "/api/v1", "/docs", "/api/v1/motors/", "//healthz"):
        assert anonymous.get(path).status_code == 401, path


def test_each_route_answers_the_roles_that_have_its_permission(app: FastAPI, as_: As) -> None:
    clients = {role: as_(role) for role in Role}
    needs = {
        (method, route.path): requirement_of(route.dependencies)
        for route in iter_route_contexts(app.routes)
        for method in route.methods or ()
    }
    for method, path, route in requests_of(app):
        needed = needs[method, route]
        for role, client in [*clients.items()]:
            answer = client.request(method, path)
            if (method, route) == ("DELETE", "/api/v1/account/tokens"):  # it ends the token that asks
                assert answer.status_code == 204
                clients[role] = as_(role)
                continue
            if needed is None:
                assert answer.status_code != 403
            elif needed in PERMISSIONS_OF[role]:
                assert answer.status_code not in (401, 403), (role, method, path, answer.text)
                assert answer.status_code < 500, (role, method, path, answer.text)
            else:
                assert answer.status_code == 403, (role, method, path)
                assert answer.headers["content-type"] == "application/problem+json"


def test_a_user_without_roles_may_do_nothing(as_: As, repository: Repository) -> None:
    repository.add_user("nobody", (), password=None, by=TESTS, now_ns=1)
    client = as_(Role.VIEWER)
    client.headers.update(bearer(token_of(repository, name="nobody")))
    assert client.get(MOTORS).status_code == 403
    assert "VIEWER" in client.get(MOTORS).json()["detail"]


def test_only_those_who_may_configure_tell_what_changes_a_condition(as_: As) -> None:
    notes = "/api/v1/motors/PUMP-A1/notes"
    operator, engineer = as_(Role.OPERATOR), as_(Role.ENGINEER)
    assert operator.post(notes, json={"text": "noisy"}).json()["by"] == "operator"
    for kind in ("maintenance", "rewound", "recorder-changed", "reference-restarted"):
        told = {"kind": kind, "text": "done"}
        assert operator.post(notes, json=told).status_code == 403
        assert engineer.post(notes, json=told).status_code == 201


@pytest.mark.parametrize(
    "authorization",
    [
        "Bearer",
        "Bearer mcc_unknown",
        "Bearer " + "x" * 5000,
        "Basic dGVzdGVyOnRlc3Rlcg==",
        "mcc_abc",
        b"Bearer \xff\xfe",
        "Bearer ' OR 1=1 --",
        "Bearer null",
    ],
)
def test_a_wrong_token_is_refused(as_: As, authorization: str | bytes) -> None:
    client = as_(Role.VIEWER)
    said = authorization.encode() if isinstance(authorization, str) else authorization
    refused = client.get(MOTORS, headers={b"Authorization": said})
    assert refused.status_code == 401
    assert refused.headers["content-type"] == "application/problem+json"
    assert refused.headers["www-authenticate"].startswith("Bearer")


def test_two_tokens_in_one_request_are_refused(as_: As) -> None:
    client = as_(Role.VIEWER)
    own = client.headers["authorization"]
    both = httpx.Headers([("Authorization", own), ("Authorization", "Bearer mcc_other")])
    del client.headers["authorization"]
    assert client.get(MOTORS, headers=both).status_code == 401
    assert client.get(MOTORS, headers={"Authorization": own}).status_code == 200


def test_a_token_ends_when_it_expires_is_revoked_or_its_user_goes(
    anonymous: httpx.Client, repository: Repository
) -> None:
    def status(secret: str) -> int:
        return anonymous.get(MOTORS, headers=bearer(secret)).status_code

    kept = token_of(repository, Role.VIEWER, name="walter")
    now_ns = time.time_ns()
    for expires_ns, expected in ((now_ns - 1, 401), (now_ns + 3600 * SECOND_NS, 200)):
        secret = new_token()
        token = repository.add_token(
            "walter", "t", digest_of(secret), scope=None, expires_ns=expires_ns, by=TESTS, now_ns=now_ns
        )
        assert status(secret) == expected
    repository.revoke_token(token.id, user=None, by=TESTS, now_ns=now_ns)
    assert status(secret) == 401
    assert status(kept) == 200
    repository.change_user("walter", disabled=True, by=TESTS, now_ns=now_ns)
    assert status(kept) == 401
    repository.change_user("walter", disabled=False, by=TESTS, now_ns=now_ns)
    assert status(kept) == 401, "it has ended for good"
    kept = token_of(repository, name="walter")
    repository.change_user("walter", roles=[Role.SECADM], by=TESTS, now_ns=now_ns)
    assert status(kept) == 403
    repository.add_user("other", [Role.SECADM], password=None, by=TESTS, now_ns=now_ns)
    repository.delete_user("walter", by=TESTS, now_ns=now_ns)
    assert status(kept) == 401


def test_whom_the_scope_of_a_token_stops_is_told_of_the_token(as_: As) -> None:
    engineer = as_(Role.ENGINEER)
    wanted = {"label": "prometheus", "scope": ["metrics", "view"]}
    narrow = bearer(engineer.post("/api/v1/account/tokens", json=wanted).json()["token"])
    told = engineer.get("/api/v1/account", headers=narrow).json()["detail"]
    assert "the token 'prometheus' of engineer may not do this" in told
    assert "the scope of the token is metrics, view" in told
    assert "mcc token add LABEL --scope account" in told
    assert "VIEWER" not in told, "the user has a role that may"
    told = engineer.get("/api/v1/users", headers=narrow).json()["detail"]
    assert told == "engineer may not do this: it needs the permission 'users', which the roles SECADM have"


def test_a_token_may_do_no_more_than_its_scope(as_: As) -> None:
    engineer = as_(Role.ENGINEER)
    made = engineer.post("/api/v1/account/tokens", json={"label": "prometheus", "scope": ["metrics"]}).json()
    assert made["token"].startswith("mcc_")
    metrics = bearer(made["token"])
    assert engineer.get("/metrics", headers=metrics).status_code == 200
    assert engineer.get(MOTORS, headers=metrics).status_code == 403
    assert engineer.post(TRIGGER, headers=metrics).status_code == 403
    # Not even to make another token.
    assert engineer.post("/api/v1/account/tokens", json={"label": "x"}, headers=metrics).status_code == 403
    beyond = engineer.post("/api/v1/account/tokens", json={"label": "x", "scope": ["users"]})
    assert beyond.status_code == 422
    assert "users" in beyond.json()["detail"]
    listed = engineer.get("/api/v1/account/tokens").json()["items"]
    assert made["token"] not in str(listed)
    assert {"metrics"} in [set(token["scope"] or ()) for token in listed]


def test_a_narrow_token_makes_no_wider_one(as_: As) -> None:
    viewer = as_(Role.ENGINEER)
    scope = {"label": "narrow", "scope": ["view", "account"]}
    narrow = bearer(viewer.post("/api/v1/account/tokens", json=scope).json()["token"])
    made = viewer.post("/api/v1/account/tokens", json={"label": "child"}, headers=narrow).json()
    assert sorted(made["scope"]) == ["account", "view"]
    wide = {"label": "wide", "scope": ["trigger"]}
    assert viewer.post("/api/v1/account/tokens", json=wide, headers=narrow).status_code == 422
    assert viewer.post(TRIGGER, headers=bearer(made["token"])).status_code == 403


def test_nobodys_upload_is_refused_before_it_is_read(anonymous: httpx.Client, repository: Repository) -> None:
    token_of(repository)
    read = []

    def endless() -> Iterator[bytes]:
        for _ in range(100_000):
            read.append(1)
            yield b"x" * 65_536

    try:
        refused = anonymous.post(
            "/api/v1/recordings",
            content=endless(),
            headers={"Content-Type": "multipart/form-data; boundary=b"},
        )
        assert refused.status_code == 401
    except httpx.TransportError:
        pass  # the connection was closed while this client still wrote
    assert len(read) < 1000
