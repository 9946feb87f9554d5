"""`mcc notify`: what was sent to whom, tests, another attempt; against a service's API and senders."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import structlog

from service.api import ApiContext, create_app
from service.application.parts import running
from service.cli.app import main
from service.configuration.settings import Settings
from service.notifications.work import NotificationWork
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind
from testing.service.plants import NOW_NS
from testing.service.receivers import HttpReceiver, Mailbox, http_receiver, mail_server
from testing.waiting import wait_until
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store
from tests.service.notifications.conftest import mail_channel

__all__ = ["database_url", "engine", "repository", "store"]

Mcc = Callable[..., tuple[int, str, str]]


@pytest.fixture
def mailbox() -> Iterator[Mailbox]:
    with mail_server() as mailbox:
        yield mailbox


@pytest.fixture
def receiver() -> Iterator[HttpReceiver]:
    with http_receiver() as receiver:
        yield receiver


@pytest.fixture
def mcc(
    repository: Repository,
    store: RecordingStore,
    tmp_path: Path,
    mailbox: Mailbox,
    receiver: HttpReceiver,
    capsys: pytest.CaptureFixture[str],
) -> Iterator[Mcc]:
    """Run a command against a service that notifies by mail and by webhook."""
    table: dict[str, Any] = {
        "gather_s": 0,
        "attempts": 1,
        "channels": {
            "ops": mail_channel(mailbox.port),
            "cmms": {"kind": "webhook", "url": receiver.url},
        },
        "routes": [{"channels": ["cmms"]}],
    }
    settings = Settings.model_validate({"data_directory": tmp_path, "notifications": table})
    work = NotificationWork(settings, repository, installation="this", period_s=0.02)
    app = create_app(ApiContext(settings, repository, store))
    with structlog.testing.capture_logs(), running([work]), serving(app) as client:

        def run(*words: str) -> tuple[int, str, str]:
            capsys.readouterr()
            code = main([*words, "--url", str(client.base_url)])
            printed = capsys.readouterr()
            return code, printed.out, printed.err

        yield run


def test_a_test_tells_of_each_receiver_whether_it_arrived(
    mcc: Mcc, mailbox: Mailbox, receiver: HttpReceiver
) -> None:
    code, out, _ = mcc("notify", "test")
    assert (code, out) == (0, "ops: shift@plant.example: sent\ncmms: sent\n")
    assert mailbox.mails[0]["Subject"] == "StatorWatch: a test of notifications"
    mailbox.replies = ["554 no relaying"]
    code, out, _ = mcc("notify", "test", "ops")
    assert code == 1
    assert out.startswith("ops: shift@plant.example: mail server 127.0.0.1")
    assert "554 no relaying" in out
    code, out, _ = mcc("notify", "test", "cmms", "--json")
    assert code == 0
    assert [one["state"] for one in json.loads(out)["notifications"]] == ["sent"]
    code, _, err = mcc("notify", "test", "opps")
    assert code == 1
    assert "did you mean 'ops'?" in err


def test_what_was_given_up_is_listed_and_tried_again(
    mcc: Mcc, repository: Repository, receiver: HttpReceiver
) -> None:
    receiver.statuses = [500]
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, "odd name", "EVT")
    repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=NOW_NS)

    def listed(state: str) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = json.loads(mcc("notify", "list", "--state", state, "--json")[1])[
            "notifications"
        ]
        return found

    wait_until(lambda: listed("dead"))
    (dead,) = listed("dead")
    _, out, _ = mcc("notify", "list")
    assert dead["id"] in out
    assert "answers HTTP status 500" in out
    _, out, _ = mcc("notify", "channels")
    assert [line.split()[-2:] for line in out.splitlines() if "cmms" in line] == [["0", "1"]]
    code, out, _ = mcc("notify", "retry", "--all")
    assert (code, out) == (0, "1 message tried again; mcc notify list shows what comes of it\n")
    wait_until(lambda: listed("sent"))
    assert len(receiver.requests) == 2
    assert receiver.requests[0].headers["webhook-id"] == receiver.requests[1].headers["webhook-id"]
    assert mcc("notify", "retry")[0] == 2
    code, _, err = mcc("notify", "retry", dead["id"])
    assert code == 1
    assert "is sent and cannot become queued" in err
