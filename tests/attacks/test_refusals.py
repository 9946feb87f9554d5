"""Somebody tries tokens, passwords and rights, and hopes that nobody sees it."""

import json
import re
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import httpx
import pytest
from structlog.testing import capture_logs

from core.units import NANOSECONDS_PER_SECOND
from service.access.bearer_secrets import digest_of, new_token
from service.access.passwords import hashed
from service.access.refusals import MOST_CALLERS, Refusal, Refusals
from service.alarms.kinds import AlarmKind
from service.api import ApiContext, create_app
from service.api.server import connection_limits
from service.audit.actions import AuditAction
from service.audit.entries import AuditEntry
from service.background.alarm_sources.attacks import LOOKED_BACK_S, MOST_TOKENS, AttackSource
from service.configuration.described import described
from service.configuration.settings import Settings, sqlite_url
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import Actor, Role
from testing.service.accounts import TESTS, token_of
from testing.service.listening import listening
from testing.service.processes import running_service, switched_off_plant

EACH = 30
HOUR_NS = round(LOOKED_BACK_S * NANOSECONDS_PER_SECOND)


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    return ApiContext(Settings(data_directory=tmp_path), repository, store)


@pytest.fixture
def client(context: ApiContext) -> Iterator[httpx.Client]:
    with (
        listening(create_app(context), connection_limits(context.settings)) as port,
        httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", trust_env=False, timeout=30) as client,
    ):
        yield client


def narrow_token(repository: Repository, user: str) -> str:
    secret = new_token()
    repository.add_token(
        user,
        "grafana",
        digest_of(secret),
        scope=["metrics"],
        expires_ns=None,
        by=TESTS,
        now_ns=time.time_ns(),
    )
    return secret


def entries(repository: Repository, *actions: AuditAction) -> Sequence[AuditEntry]:
    found = repository.audit_entries(limit=1000).items
    return [entry for entry in found if entry.action in actions]


def requests_of(noted: Sequence[AuditEntry]) -> int:
    return sum(int(json.loads(entry.after or "{}")["requests"]) for entry in noted)


def refused(metrics: str) -> Mapping[str, float]:
    """The figure in GET /metrics, by its reason."""
    found = re.findall(r'^mcc_refused_requests_total\{reason="(\w+)"\} (\S+)$', metrics, re.MULTILINE)
    return {reason: float(number) for reason, number in found}


def standing(repository: Repository) -> set[AlarmKind]:
    kinds = (AlarmKind.PASSWORD_GUESSING, AlarmKind.FORGED_TOKENS, AlarmKind.OWNER_LOCKED)
    return {alarm.kind for alarm in repository.standing_alarms_of(*kinds)}


def look(repository: Repository, now_ns: int) -> None:
    """What the service does each minute."""
    repository.settle_findings(tuple(AttackSource(repository).findings(now_ns)), now_ns=now_ns)


def test_ninety_denied_and_forged_requests_go_unseen(context: ApiContext, client: httpx.Client) -> None:
    repository = context.repository
    viewer = token_of(repository, Role.VIEWER, name="vera")
    narrow = narrow_token(repository, "vera")
    with capture_logs() as lines:
        for secret, status in ((viewer, 403), (narrow, 403), ("forged", 401)):
            for _ in range(EACH):
                path = "/motors/PUMP-A1/event-reports" if secret is viewer else "/motors"
                method = "POST" if secret is viewer else "GET"
                answer = client.request(method, path, headers={"Authorization": f"Bearer {secret}"})
                assert answer.status_code == status, answer.text
    context.refusals.settle(repository, ending=True)
    by_right = entries(repository, AuditAction.REQUEST_REFUSED)
    forged = entries(repository, AuditAction.TOKEN_REFUSED)
    assert (requests_of(by_right), requests_of(forged)) == (2 * EACH, EACH)
    assert {(entry.actor, entry.origin, entry.roles) for entry in by_right} == {
        ("vera", "127.0.0.1", "VIEWER")
    }
    assert {(entry.actor, entry.origin) for entry in forged} == {("(nobody)", "127.0.0.1")}
    assert len(by_right) + len(forged) == 4, "one at once, and one for what follows"
    assert "forged" not in {entry.after for entry in forged}
    told = [line for line in lines if line["event"] == "requests were refused"]
    assert Counter(line["refusal"] for line in told) == {"permission": 1, "token": 1}
    metrics = client.get(client.base_url.join("/metrics"), headers={"Authorization": f"Bearer {viewer}"})
    found = refused(metrics.text)
    assert set(found) == {reason.value for reason in Refusal}
    assert (found["permission"], found["token"]) == (2 * EACH, EACH)


def test_forged_tokens_alarm_nobody(context: ApiContext, client: httpx.Client) -> None:
    repository = context.repository
    token_of(repository, Role.VIEWER)
    for _ in range(MOST_TOKENS + 1):
        client.get("/motors", headers={"Authorization": "Bearer forged"})
    context.refusals.settle(repository, ending=True)
    now_ns = time.time_ns()
    look(repository, now_ns)
    assert standing(repository) == {AlarmKind.FORGED_TOKENS}
    look(repository, now_ns + 2 * HOUR_NS)
    assert standing(repository) == set()


def test_a_program_whose_token_has_just_expired_alarms_nobody(
    context: ApiContext, client: httpx.Client
) -> None:
    token_of(context.repository, Role.VIEWER)
    client.get("/motors", headers={"Authorization": "Bearer expired"})
    look(context.repository, time.time_ns())
    assert standing(context.repository) == set()


def test_guesses_at_an_owners_password_alarm_nobody(context: ApiContext, client: httpx.Client) -> None:
    repository = context.repository
    password = hashed("a long enough one")
    for name, roles in (("olga", [Role.SECADM]), ("vera", [Role.VIEWER])):
        repository.add_user(name, roles, password=password, by=TESTS, now_ns=time.time_ns())

    def guess(name: str) -> None:
        body = {"name": name, "password": "guessed"}
        answers = [client.post("/login", json=body) for _ in range(7)]
        assert [answer.status_code for answer in answers] == [401] * 5 + [429] * 2

    guess("vera")
    look(repository, time.time_ns())
    assert standing(repository) == {AlarmKind.PASSWORD_GUESSING}
    guess("olga")
    look(repository, time.time_ns())
    assert standing(repository) == {AlarmKind.PASSWORD_GUESSING, AlarmKind.OWNER_LOCKED}
    context.refusals.settle(repository, ending=True)
    assert requests_of(entries(repository, AuditAction.LOGIN_REFUSED)) == 4, "those during the pause"


def test_a_thousand_addresses_fill_the_audit_trail(context: ApiContext) -> None:
    refusals, repository = Refusals(), context.repository
    for number in range(1000):
        actor = Actor("(nobody)", f"192.0.2.{number}")
        refusals.note(repository, Refusal.TOKEN, actor, "GET /api/v1/motors")
    refusals.settle(repository, ending=True)
    noted = entries(repository, AuditAction.TOKEN_REFUSED)
    assert len(noted) <= MOST_CALLERS + 2
    assert requests_of(noted) == refusals.counts()[Refusal.TOKEN] == 1000


def test_an_attack_that_goes_on_leaves_one_entry_a_period(context: ApiContext) -> None:
    refusals, repository = Refusals(period_s=0.0), context.repository
    actor = Actor("(nobody)", "192.0.2.1")
    for requests in (1, 3, 2):
        for _ in range(requests):
            refusals.note(repository, Refusal.TOKEN, actor, "GET /api/v1/motors")
        refusals.settle(repository)
    noted = entries(repository, AuditAction.TOKEN_REFUSED)
    assert requests_of(noted) == 6
    assert len(noted) <= 5


def settings_with(directory: Path, **changed: object) -> Settings:
    return Settings.model_validate({"data_directory": directory, **changed})


def test_a_start_with_other_settings_goes_unseen(context: ApiContext, tmp_path: Path) -> None:
    repository = context.repository
    relays = {"A1_SEL710": {"password_file": tmp_path / "password"}}
    hidden = "Zx9-of-the-database-Zx9"
    first = settings_with(
        tmp_path, record_timeout_s=20, relays=relays, database_url=f"postgresql://mcc:{hidden}@database/mcc"
    )
    second = settings_with(tmp_path, alarms={"link_down_s": 1800}, relays=relays)
    for at_ns, settings in enumerate((first, first, second, second, first), 1):
        repository.note_settings(described(settings), "this one", now_ns=at_ns)
    repository.note_settings(described(second), "another", now_ns=9)
    noted = entries(repository, AuditAction.SETTINGS_CHANGED)
    assert [(entry.subject, entry.time_ns) for entry in reversed(noted)] == [
        ("this one", 1),
        ("this one", 3),
        ("this one", 5),
        ("another", 9),
    ]
    before, after = (json.loads(text or "{}") for text in (noted[2].before, noted[2].after))
    assert (before["record_timeout_s"], after["record_timeout_s"]) == (20, None)
    assert (before["alarms.link_down_s"], after["alarms.link_down_s"]) == (None, 1800)
    assert before["database_url"] == "postgresql://mcc:***@database/mcc"
    assert "data_directory" not in after, "it is the same"
    assert not [entry for entry in noted if hidden in f"{entry.before}{entry.after}"]


@pytest.mark.timeout(300)
def test_a_start_and_a_stop_go_unseen(tmp_path: Path) -> None:
    with running_service(tmp_path, switched_off_plant(tmp_path)) as service:
        process_id = service.process_id
    repository = Repository(connect(sqlite_url(tmp_path / "data")))
    actions = (AuditAction.SETTINGS_CHANGED, AuditAction.SERVICE_STARTED, AuditAction.SERVICE_ENDED)
    noted = list(reversed(entries(repository, *actions)))
    assert [entry.action for entry in noted] == list(actions)
    assert json.loads(noted[1].after or "{}")["process"] == process_id
    assert {(entry.actor, entry.origin) for entry in noted} == {("statorwatch", "service")}
