"""A service whose changes are looked up in its audit trail, with what the changes are about."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any

import httpx
import pyotp
from fastapi import FastAPI

from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.access.passwords import hashed
from service.api import ApiContext
from service.client.credentials import bearer
from service.configuration.channels import Channel, CommandChannel
from service.configuration.notifications import NotificationSettings
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.records import SERVICE, Alarm
from service.storage.states import AlarmKind
from service.timing.backoff import Backoff
from testing.service.accounts import EVERYTHING, TESTER, TESTS, token_of
from testing.service.authenticator import Authenticator
from testing.service.database import make_database
from testing.service.diagnosed import add_diagnosed
from testing.service.job_runner import register_runner
from testing.service.plants import NOW_NS, healthy, two_motor_plant
from tests.service.api.serving import serving

API = "/api/v1"
MOTOR = f"{API}/motors/PUMP-A1"
ME = TESTER
PERSON = "person-"
"""How the names begin of those who do what ME cannot: log in, and end all of their tokens."""
Body = dict[str, str]
ADDRESS = "http://localhost"
INSPECTION = {"outcome": "nothing-found", "text": "opened and tested"}
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody


@dataclass(frozen=True)
class Prepared:
    """A service with what the requests are about; each call makes another one."""

    app: FastAPI
    client: httpx.Client
    repository: Repository
    store: RecordingStore
    numbers: Iterator[int]

    def latest_entries(self) -> list[tuple[str, str, str]]:
        """Action, actor and origin of the last entry of the audit trail."""
        with self.repository.audit_trail() as trail:
            latest = trail.entries(first=trail.head.number)
            return [(entry.action, entry.actor, entry.origin) for entry in latest]

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

    def person(self) -> str:
        """The name of somebody new who has a password."""
        name = f"{PERSON}{next(self.numbers)}"
        self.repository.add_user(name, EVERYTHING, password=_hash(), by=TESTS, now_ns=time.time_ns())
        return name

    def bearer_of(self, name: str) -> Mapping[str, str]:
        """The headers of a token of a user."""
        return bearer(token_of(self.repository, name=name))

    def somebody(self) -> Mapping[str, str]:
        """The headers of a token of somebody new."""
        return self.bearer_of(self.person())

    def user_with_token(self) -> str:
        user = self.user()
        self.bearer_of(user.rpartition("/")[2])
        return user

    def login(self) -> httpx.Response:
        wanted = {"name": self.person(), "password": PASSWORD}
        return httpx.post(f"{self.client.base_url}{API}/login", json=wanted, trust_env=False, timeout=30)

    def logout(self) -> httpx.Response:
        url = f"{self.client.base_url}{API}/logout"
        return httpx.post(url, cookies=self.login().cookies, trust_env=False, timeout=30)

    def other_password(self) -> httpx.Response:
        wanted = {"old": PASSWORD, "new": f"{PASSWORD} staple"}
        return self.client.put(f"{API}/account/password", json=wanted, headers=self.somebody())

    def in_session(
        self,
        path: str,
        *,
        with_app: bool = False,
        code: bool = False,
        json: Body | None = None,
        data: Body | None = None,
    ) -> httpx.Response:
        """Send a document or a form in a session of somebody new.

        with_app: with a second factor. code: with that of an app which is being set up as the body.
        """
        with httpx.Client(
            base_url=self.client.base_url, cookies=self.login().cookies, trust_env=False, timeout=30
        ) as session:
            if with_app or code:
                secret = session.post(f"{API}/account/totp", json={"password": PASSWORD}).json()["secret"]
                shown = {"code": pyotp.TOTP(secret).now()}
                if code:
                    return session.post(path, json=json and shown, data=data and shown)
                assert session.post(f"{API}/account/totp/confirmation", json=shown).is_success
            return session.post(path, json=json, data=data)

    def with_passkey(
        self, path: str, *, added: bool = False, json: Body | None = None, data: Body | None = None
    ) -> httpx.Response:
        """Send a document or a form in a session of somebody new, with what a device answers in it.

        added: whose passkey is added already; its id takes the place of {passkey_id} in the path.
        """
        device = Authenticator(ADDRESS, "localhost")
        with httpx.Client(
            base_url=self.client.base_url, cookies=self.login().cookies, trust_env=False, timeout=30
        ) as session:
            asked = session.post(f"{API}/account/passkeys/options", json={"password": PASSWORD}).json()
            made = {"label": "blue key", "answer": device.create(asked["options"])}
            if not added:
                return session.post(path, json=json and made, data=data and made)
            kept = session.post(f"{API}/account/passkeys", json=made).json()
            return session.post(path.replace("{passkey_id}", kept["id"]), json=json, data=data)

    def inspection(self) -> str:
        kept = self.client.post(f"{MOTOR}/inspections", json=INSPECTION)
        return str(kept.headers["location"])

    def note(self, kind: str = "note") -> str:
        return str(self.client.post(f"{MOTOR}/notes", json={"text": "a note", "kind": kind}).json()["id"])

    def alarm(self) -> str:
        subject = f"X{next(self.numbers)}.CFG"
        alarm: Alarm = self.repository.raise_alarm(
            "A1_SEL710", AlarmKind.FILE_REFUSED, subject, "outside", now_ns=NOW_NS
        )
        return f"{API}/alarms/{alarm.id}"

    def acknowledged(self) -> str:
        """Return the id of an alarm that the same account has acknowledged."""
        path = self.alarm()
        self.client.post(f"{path}/acknowledgements")
        return path.rpartition("/")[2]

    def deleted(self) -> str:
        """Return the id of a recording that the same account has deleted."""
        recording_id = self.recording()
        self.client.delete(f"{API}/recordings/{recording_id}", params={"reason": "a test"})
        return recording_id

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


@cache
def _hash() -> str:
    return hashed(PASSWORD)


SHELVED = {"until": rfc3339(time.time_ns() + NANOSECONDS_PER_DAY)}


Send = Callable[[Prepared], httpx.Response]
"""Sends one change with success."""

Changes = Mapping[str, tuple[Send, str]]
"""How each change, by method and path, is sent with success, and the action of the entry that it leaves."""


def sent(prepared: Prepared, changes: Changes, change: str) -> httpx.Response:
    """Send a change; the entry that it leaves names who sent it, and from where."""
    send, action = changes[change]
    answer = send(prepared)
    assert not answer.is_error, answer.text
    assert answer.request.method == change.partition(" ")[0]
    ((found, actor, origin),) = prepared.latest_entries()
    assert (found, origin) == (action, "127.0.0.1")
    assert actor == ME or actor.startswith(PERSON)
    return answer


@contextmanager
def audited_service(data: Path, create: Callable[[ApiContext], FastAPI]) -> Iterator[Prepared]:
    """A service on a data directory of its own. create: makes its application."""
    engine = connect(make_database(data))
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
    store = FolderStore(data / "recordings")
    channels: dict[str, Channel] = {"hook": CommandChannel(kind="command", command=("/bin/true",))}
    told = NotificationSettings(channels=channels, address=ADDRESS)
    settings = Settings(data_directory=data, notifications=told)
    motors = {one.motor.name: one.motor for one in two_motor_plant().motors}
    app = create(ApiContext(settings, repository, store, motors=motors))
    with serving(app) as client:
        yield Prepared(app, client, repository, store, count())
    engine.dispose()
