"""Every route that changes something leaves an entry that names who asked; a new one has to be told here."""

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

import httpx
import pytest

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.api import ApiContext, create_app
from service.configuration.channels import Channel, CommandChannel
from service.configuration.notifications import NotificationSettings
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import SERVICE, Alarm
from service.storage.states import AlarmKind
from service.timing.backoff import Backoff
from testing.service.accounts import TESTER
from testing.service.database import make_database
from testing.service.diagnosed import add_diagnosed
from testing.service.job_runner import register_runner
from testing.service.plants import NOW_NS, healthy, two_motor_plant
from tests.service.api.serving import serving

API = "/api/v1"
MOTOR = f"{API}/motors/PUMP-A1"
CHANGING = {"post", "put", "patch", "delete"}
ME = TESTER
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody


@dataclass(frozen=True)
class Prepared:
    """A service with what the requests are about; each call makes another one."""

    client: httpx.Client
    repository: Repository
    store: RecordingStore
    numbers: Iterator[int]

    def recording(self) -> str:
        number = next(self.numbers)
        return add_diagnosed(self.repository, self.store, healthy(), NOW_NS + number, name=f"E{number}")

    def baseline(self) -> dict[str, Any]:
        ids = [self.recording() for _ in range(3)]
        for one in ids:
            self.repository.leave_out(one, "tells nothing", "test")
        return {"recording_ids": ids}

    def chosen_baseline(self) -> str:
        assert self.client.put(f"{MOTOR}/baseline", json=self.baseline()).status_code == 200
        return f"{MOTOR}/baseline"

    def user(self) -> str:
        name = f"user-{next(self.numbers)}"
        wanted = {"name": name, "roles": ["VIEWER"]}
        assert self.client.post(f"{API}/users", json=wanted).status_code == 201
        return f"{API}/users/{name}"

    def token(self) -> str:
        return str(self.client.post(f"{API}/account/tokens", json={"label": "a test"}).json()["id"])

    def login(self) -> httpx.Response:
        answer = self.client.put(f"{API}/users/{ME}/password", json={"password": PASSWORD})
        assert answer.status_code == 204
        wanted = {"name": ME, "password": PASSWORD}
        return httpx.post(f"{self.client.base_url}{API}/login", json=wanted, trust_env=False, timeout=30)

    def logout(self) -> httpx.Response:
        url = f"{self.client.base_url}{API}/logout"
        return httpx.post(url, cookies=self.login().cookies, trust_env=False, timeout=30)

    def other_password(self) -> httpx.Response:
        assert self.login().status_code == 200
        wanted = {"old": PASSWORD, "new": f"{PASSWORD} staple"}
        return self.client.put(f"{API}/account/password", json=wanted)

    def note(self) -> str:
        return str(self.client.post(f"{MOTOR}/notes", json={"text": "a note"}).json()["id"])

    def alarm(self) -> str:
        subject = f"X{next(self.numbers)}.CFG"
        alarm: Alarm = self.repository.raise_alarm(
            "A1_SEL710", AlarmKind.FILE_REFUSED, subject, "outside", now_ns=NOW_NS
        )
        return f"{API}/alarms/{alarm.id}"

    def shelved(self) -> str:
        alarm = self.alarm()
        assert self.client.put(f"{alarm}/shelving", json=SHELVED).status_code == 200
        return alarm

    def out_of_service(self) -> str:
        alarm = self.alarm()
        assert self.client.put(f"{alarm}/out-of-service").status_code == 200
        return alarm

    def quarantined(self) -> str:
        self.repository.set_aside("A2_SEL710", "crashed", backoff=Backoff(60.0, 60.0), now_ns=NOW_NS)
        return f"{API}/ieds/A2_SEL710/quarantine"

    def given_up(self) -> str:
        (queued,) = self.repository.request_test_notifications("gone", [""], by=SERVICE, now_ns=NOW_NS)
        self.repository.give_up_unknown(["hook"], before_ns=NOW_NS + 1, now_ns=NOW_NS)
        return f"{API}/notifications/{queued.id}"

    def files(self) -> list[tuple[str, tuple[str, bytes]]]:
        return [("files", (f"U{next(self.numbers)}.CFF", b"an upload %d" % next(self.numbers)))]


SHELVED = {"until": rfc3339(time.time_ns() + NANOSECONDS_PER_DAY)}

Send = Callable[[Prepared], httpx.Response]

REQUESTS: Mapping[str, tuple[Send, str]] = {
    "POST /api/v1/motors/{name}/event-reports": (
        lambda it: it.client.post(f"{MOTOR}/event-reports"),
        "recording-requested",
    ),
    "POST /api/v1/motors/{name}/notes": (
        lambda it: it.client.post(f"{MOTOR}/notes", json={"text": "a note"}),
        "note-added",
    ),
    "POST /api/v1/motors/{name}/notes/{note_id}/withdrawal": (
        lambda it: it.client.post(f"{MOTOR}/notes/{it.note()}/withdrawal", json={"reason": "wrong motor"}),
        "note-withdrawn",
    ),
    "POST /api/v1/motors/{name}/reference": (
        lambda it: it.client.post(f"{MOTOR}/reference", json={"reason": "tested"}),
        "reference-restarted",
    ),
    "PUT /api/v1/motors/{name}/baseline": (
        lambda it: it.client.put(f"{MOTOR}/baseline", json=it.baseline()),
        "baseline-set",
    ),
    "DELETE /api/v1/motors/{name}/baseline": (
        lambda it: it.client.delete(it.chosen_baseline()),
        "baseline-deleted",
    ),
    "DELETE /api/v1/ieds/{name}/quarantine": (
        lambda it: it.client.delete(it.quarantined()),
        "quarantine-released",
    ),
    "POST /api/v1/alarms/acknowledgements": (
        lambda it: it.client.post(
            f"{API}/alarms/acknowledgements", json={"alarms": [it.alarm().rpartition("/")[2]]}
        ),
        "alarm-acknowledged",
    ),
    "POST /api/v1/alarms/{alarm_id}/acknowledgements": (
        lambda it: it.client.post(f"{it.alarm()}/acknowledgements"),
        "alarm-acknowledged",
    ),
    "PUT /api/v1/alarms/{alarm_id}/shelving": (
        lambda it: it.client.put(f"{it.alarm()}/shelving", json=SHELVED),
        "alarm-shelved",
    ),
    "DELETE /api/v1/alarms/{alarm_id}/shelving": (
        lambda it: it.client.delete(f"{it.shelved()}/shelving"),
        "alarm-unshelved",
    ),
    "PUT /api/v1/alarms/{alarm_id}/out-of-service": (
        lambda it: it.client.put(f"{it.alarm()}/out-of-service"),
        "alarm-taken-out-of-service",
    ),
    "DELETE /api/v1/alarms/{alarm_id}/out-of-service": (
        lambda it: it.client.delete(f"{it.out_of_service()}/out-of-service"),
        "alarm-put-back-in-service",
    ),
    "POST /api/v1/notification-channels/{name}/tests": (
        lambda it: it.client.post(f"{API}/notification-channels/hook/tests"),
        "channel-tested",
    ),
    "POST /api/v1/notifications/{notification_id}/attempts": (
        lambda it: it.client.post(f"{it.given_up()}/attempts"),
        "notification-retried",
    ),
    "POST /api/v1/recordings": (
        lambda it: it.client.post(f"{API}/recordings", data={"motor": "PUMP-A1"}, files=it.files()),
        "recording-uploaded",
    ),
    "DELETE /api/v1/recordings/{recording_id}": (
        lambda it: it.client.delete(f"{API}/recordings/{it.recording()}", params={"reason": "a test"}),
        "recording-deleted",
    ),
    "POST /api/v1/recordings/{recording_id}/diagnoses": (
        lambda it: it.client.post(f"{API}/recordings/{it.recording()}/diagnoses"),
        "diagnosis-requested",
    ),
    "POST /api/v1/login": (lambda it: it.login(), "logged-in"),
    "POST /api/v1/logout": (lambda it: it.logout(), "logged-out"),
    "PUT /api/v1/account/password": (lambda it: it.other_password(), "password-set"),
    "POST /api/v1/account/tokens": (
        lambda it: it.client.post(f"{API}/account/tokens", json={"label": "a test"}),
        "token-added",
    ),
    "DELETE /api/v1/account/tokens/{token_id}": (
        lambda it: it.client.delete(f"{API}/account/tokens/{it.token()}"),
        "token-revoked",
    ),
    "DELETE /api/v1/tokens/{token_id}": (
        lambda it: it.client.delete(f"{API}/tokens/{it.token()}"),
        "token-revoked",
    ),
    "POST /api/v1/users": (
        lambda it: it.client.post(f"{API}/users", json={"name": "new", "roles": ["VIEWER"]}),
        "user-added",
    ),
    "PATCH /api/v1/users/{name}": (
        lambda it: it.client.patch(it.user(), json={"roles": ["OPERATOR"]}),
        "user-changed",
    ),
    "PUT /api/v1/users/{name}/password": (
        lambda it: it.client.put(f"{it.user()}/password", json={"password": PASSWORD}),
        "password-set",
    ),
    "DELETE /api/v1/users/{name}/sessions": (
        lambda it: it.client.delete(f"{it.user()}/sessions"),
        "sessions-ended",
    ),
    "DELETE /api/v1/users/{name}/lock": (lambda it: it.client.delete(f"{it.user()}/lock"), "user-unlocked"),
    "DELETE /api/v1/users/{name}": (lambda it: it.client.delete(it.user()), "user-deleted"),
    "POST /api/v1/users/{name}/tokens": (
        lambda it: it.client.post(f"{it.user()}/tokens", json={"label": "a test"}),
        "token-added",
    ),
}
"""A request of each changing route that is carried out, and the action of the entry that it leaves."""


@pytest.fixture(scope="module")
def prepared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Prepared]:
    data: Path = tmp_path_factory.mktemp("audited")
    engine = connect(make_database(data))
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
    store = RecordingStore(data / "recordings")
    channels: dict[str, Channel] = {"hook": CommandChannel(kind="command", command=("/bin/true",))}
    settings = Settings(data_directory=data, notifications=NotificationSettings(channels=channels))
    with serving(create_app(ApiContext(settings, repository, store))) as client:
        yield Prepared(client, repository, store, count())
    engine.dispose()


def test_every_changing_route_is_told(prepared: Prepared) -> None:
    document = prepared.client.get(f"{API}/openapi.json").json()
    changing = {
        f"{method.upper()} {path}"
        for path, methods in document["paths"].items()
        for method in CHANGING.intersection(methods)
    }
    assert changing == set(REQUESTS), "tell of each route that changes something how a request succeeds"


@pytest.mark.parametrize("route", REQUESTS)
def test_a_changing_route_leaves_an_entry(prepared: Prepared, route: str) -> None:
    send, action = REQUESTS[route]
    answer = send(prepared)
    assert answer.is_success, answer.text
    assert answer.request.method == route.partition(" ")[0]
    with prepared.repository.audit_trail() as trail:
        latest = list(trail.entries(first=trail.head.number))
    assert [(entry.action, entry.actor, entry.origin) for entry in latest] == [(action, ME, "127.0.0.1")]


def test_a_route_that_reads_leaves_none(prepared: Prepared) -> None:
    before = prepared.client.get(f"{API}/audit/head").json()
    document = prepared.client.get(f"{API}/openapi.json").json()
    for path in document["paths"]:
        prepared.client.get(path.replace("{name}", "PUMP-A1"))
    assert prepared.client.get(f"{API}/audit/head").json() == before
