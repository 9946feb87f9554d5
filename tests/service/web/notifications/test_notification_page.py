"""The page of notifications: channels, routes, what was sent to whom, and its two buttons."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Role
from service.storage.states import NotificationState
from service.web.app import create_site
from testing.service.accounts import token_of
from tests.service.api.notifications.test_notifications import CHANNELS, told_alarm
from tests.service.api.serving import serving
from tests.service.web.pages import HOSTILE, addresses, page, words

ROUTES = [
    {
        "name": HOSTILE,
        "channels": ["ops", "chat"],
        "priorities": ["critical", "high"],
        "days": ["mon", "tue"],
        "from": "06:00",
        "until": "22:00",
        "outside_hours": "wait",
        "escalations": [{"after_min": 30, "channels": ["pager"]}],
    },
    {"channels": ["siem"]},
]
DIGESTS = [{"period": "weekly", "channels": ["ops"], "at": "07:00"}]


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    told = {"channels": CHANNELS, "routes": ROUTES, "digests": DIGESTS, "time_zone": "Europe/Berlin"}
    settings = Settings.model_validate({"data_directory": tmp_path, "notifications": told})
    with serving(create_site(ApiContext(settings, repository, store))) as client:
        client.headers["Accept"] = "text/html"
        yield client


def test_channels_and_routes_are_told_in_words_and_without_secrets(client: httpx.Client) -> None:
    answer = client.get("/notifications")
    document = page(answer)
    first = words(document, "section[aria-labelledby=channels] tbody tr")
    assert first[0].startswith("ops")
    for secret in ("T0K3N", "S3CR3T", "mail-password", "/etc/mcc"):
        assert secret not in answer.text
    route, simple = (
        words(row, "td") for row in document.cssselect("section[aria-labelledby=routes] tbody tr")
    )
    assert route == [
        "priority critical, high; every site and the service; every kind",
        "raised, reopened",
        "ops, chat",
        "mon, tue 06:00 to 22:00 (Europe/Berlin); at other times when they begin",
        "after 30 min without acknowledgement: pager",
    ]
    assert simple[3:] == ["at all times", "nothing more"]
    assert words(document, "section[aria-labelledby=routes] li") == [
        "every mon at 07:00 (Europe/Berlin), of all sites, through ops"
    ]


def test_a_test_is_queued_for_each_receiver(client: httpx.Client, repository: Repository) -> None:
    answer = client.post("/notifications/channels/ops/test")
    assert answer.headers["location"] == "/notifications?done=test-queued"
    document = page(client.get(answer.headers["location"]))
    rows = [words(row, "td") for row in document.cssselect("section[aria-labelledby=messages-sent] tbody tr")]
    assert {row[2] for row in rows} == {"shift@plant.example", "chief@plant.example"}
    assert [row[3] for row in rows] == ["waits", "waits"]
    assert len(repository.notifications(limit=9, channel="ops").items) == 2
    assert client.post("/notifications/channels/nope/test").status_code == 404


def test_a_message_that_was_given_up_is_tried_again(client: httpx.Client, repository: Repository) -> None:
    alarm, message = told_alarm(repository)
    document = page(client.get("/notifications?state=dead&channel=ops"))
    (row,) = document.cssselect("section[aria-labelledby=messages-sent] tbody tr")
    assert "the server answers 554 no" in row.text_content()
    (form,) = addresses(row, "form")
    assert form == f"/notifications/{message}/attempt"
    told = page(client.get(f"/alarms/{alarm}"))
    assert words(told, "section[aria-labelledby=messages-of-it] td")[2:4] == ["ops", "shift@plant.example"]
    assert client.post(form).headers["location"] == "/notifications?done=tried-again"
    assert repository.notification(message).state is NotificationState.QUEUED
    assert client.post(form).status_code == 409
    assert client.get("/notifications?state=&channel=").status_code == 200
    assert "No message is like that" in client.get("/notifications?state=sent").text


def test_only_engineers_see_who_is_told(client: httpx.Client, repository: Repository) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.OPERATOR, name='operator')}"
    assert client.get("/notifications").status_code == 403
    assert client.post("/notifications/channels/ops/test").status_code == 403


def test_without_channels_the_page_says_that_nobody_is_told(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    context = ApiContext(Settings(data_directory=tmp_path), repository, store)
    with serving(create_site(context)) as client:
        client.headers["Accept"] = "text/html"
        text = page(client.get("/notifications")).text_content()
    assert "nobody is told of an alarm except on these pages" in text
