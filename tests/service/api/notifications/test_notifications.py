"""Messages and channels over REST."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec, Gathering, NotificationTarget
from service.storage.states import AlarmKind
from service.timing.backoff import Backoff
from testing.service.accounts import auditor
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving

SHIFT = ["shift@plant.example", "chief@plant.example"]
CHANNELS = {
    "ops": {
        "kind": "mail",
        "host": "mail.plant.example",
        "user": "mcc",
        "password_file": "/etc/mcc/mail-password",
        "from": "mcc@plant.example",
        "to": SHIFT,
    },
    "chat": {"kind": "webhook", "url": "https://hooks.example/T0K3N", "format": "slack"},
    "siem": {"kind": "syslog", "host": "siem"},
    "pager": {"kind": "command", "command": ["/opt/page", "--key", "S3CR3T"]},
    "other": {"kind": "apprise", "urls_file": "/etc/mcc/urls"},
}


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    table = {"data_directory": tmp_path, "notifications": {"channels": CHANNELS}}
    return ApiContext(Settings.model_validate(table), repository, store)


@pytest.fixture
def client(context: ApiContext) -> Iterator[httpx.Client]:
    with serving(create_app(context)) as client:
        yield client


def told_alarm(repository: Repository) -> tuple[str, str]:
    """An alarm, and the message that told it and was given up."""
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, "odd name", "EVT <b>")
    alarm = repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=NOW_NS)
    target = NotificationTarget("ops", "shift@plant.example")
    repository.route_alarm_changes(lambda _: [target], Gathering(0, 0), now_ns=NOW_NS)
    message = repository.claim_notification("ops", claim="a 1", now_ns=NOW_NS)
    assert message is not None
    repository.fail_notification(
        message.id,
        "the server answers 554 no",
        claim="a 1",
        now_ns=NOW_NS,
        most_attempts=9,
        backoff=Backoff(1, 1),
        is_final=True,
    )
    return alarm.id, message.id


def test_what_was_not_sent_is_listed_with_its_reason_and_tried_again(
    client: httpx.Client, repository: Repository
) -> None:
    alarm, message = told_alarm(repository)
    (listed,) = client.get("/api/v1/notifications", params={"alarm": alarm}).json()["items"]
    assert listed["id"] == message
    assert (listed["state"], listed["attempts"], listed["alarms"]) == ("dead", 1, 1)
    assert listed["error"] == "the server answers 554 no"
    assert client.get("/api/v1/notifications", params={"state": "sent"}).json()["items"] == []
    assert client.get("/api/v1/notifications", params={"channel": "siem"}).json()["items"] == []
    (told,) = client.get(f"/api/v1/notifications/{message}").json()["told"]
    assert (told["id"], told["subject"], told["ied"]) == (alarm, "EVT <b>", "A1_SEL710")
    answer = client.post(f"/api/v1/notifications/{message}/attempts")
    assert (answer.status_code, answer.json()["state"]) == (202, "queued")
    again = client.post(f"/api/v1/notifications/{message}/attempts")
    assert again.status_code == 409
    assert "is queued" in again.json()["detail"]


def test_channels_tell_who_is_behind_them_and_no_secret(client: httpx.Client, repository: Repository) -> None:
    told_alarm(repository)
    answer = client.get("/api/v1/notification-channels")
    found = {one["name"]: one for one in answer.json()["items"]}
    assert found["ops"]["receivers"] == ["shift@plant.example", "chief@plant.example"]
    assert (found["ops"]["waiting"], found["ops"]["given_up"]) == (0, 1)
    assert found["siem"]["receivers"] == ["siem:6514 (tls)"]
    assert found["pager"]["receivers"] == ["/opt/page"]
    for secret in ("T0K3N", "S3CR3T", "password", "/etc/mcc"):
        assert secret not in answer.text


def test_a_test_is_queued_for_each_receiver_and_known_in_the_audit_trail(
    client: httpx.Client, repository: Repository
) -> None:
    answer = client.post("/api/v1/notification-channels/ops/tests")
    assert answer.status_code == 202
    assert [one["recipient"] for one in answer.json()["items"]] == SHIFT
    entries = client.get("/api/v1/audit/entries", headers=auditor(repository)).json()["items"]
    assert [entry["action"] for entry in entries] == ["channel-tested"]
    for _ in range(49):
        assert client.post("/api/v1/notification-channels/ops/tests").status_code == 202
    assert client.post("/api/v1/notification-channels/ops/tests").status_code == 429
    assert client.post("/api/v1/notification-channels/siem/tests").status_code == 202


def test_what_is_not_there_is_told(client: httpx.Client) -> None:
    answer = client.post("/api/v1/notification-channels/opps/tests")
    assert answer.status_code == 404
    assert answer.json()["detail"] == "there is no channel 'opps'; did you mean 'ops'?"
    nobody = "00000000-0000-0000-0000-000000000000"
    for path in (f"notifications/{nobody}", f"notifications?alarm={nobody}", "notifications?channel=x"):
        assert client.get(f"/api/v1/{path}").status_code == 404
    assert client.post(f"/api/v1/notifications/{nobody}/attempts").status_code == 404
