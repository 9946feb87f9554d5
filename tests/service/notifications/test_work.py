"""The work of notifications as a whole: real alarms, a real mail server, a real HTTP receiver."""

import json
import re
import time
from dataclasses import replace
from email.message import EmailMessage
from pathlib import Path
from typing import Any

import structlog

from core.units import NANOSECONDS_PER_DAY
from service.audit.actions import AuditAction
from service.configuration.settings import Settings
from service.notifications.digests import due_digests
from service.recording_store.store import RecordingStore
from service.roles import Role
from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec, Gathering, NewNotification
from service.storage.records.actors import SERVICE, Actor
from service.storage.states import AlarmKind, NotificationKind, NotificationState
from testing.service.conditions import FAULT, OPEN_PHASE, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import OBSERVATION
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.receivers import http_receiver, mail_server
from testing.waiting import eventually, wait_until
from tests.service.notifications.conftest import Work, mail_channel

HOSTILE = "EVT\r\nBcc: victim@evil.example\r\n\r\n<script>alert(1)</script>"
ANN = Actor("ann <b>", "command line", frozenset({Role.OPERATOR}))


def refuse_file(repository: Repository, name: str = HOSTILE, reason: str = "odd & long") -> str:
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, reason, name)
    return repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=NOW_NS).id


def html_of(mail: EmailMessage) -> str:
    part = mail.get_body(("html",))
    assert isinstance(part, EmailMessage)
    return str(part.get_content())


def text_of(mail: EmailMessage) -> str:
    part = mail.get_body(("plain",))
    assert isinstance(part, EmailMessage)
    return str(part.get_content())


def test_a_fault_comes_as_a_mail_with_its_trend_and_what_to_do(
    repository: Repository, store: RecordingStore, at_work: Work
) -> None:
    for hour in range(3):
        told = replace(OBSERVATION, time_ns=NOW_NS + hour * 3600 * SECOND_NS)
        add_diagnosed(repository, store, fault(), told.time_ns, name=f"E{hour}", observed=told)
    tell(repository, FAULT)
    spec = AlarmSpec(
        AlarmKind.CONDITION_FAULT,
        "shorted turns in phase b: 1.20 %",
        "shorted turns in phase b",
        advice="Stop the motor.",
        one_of_kind=True,
    )
    repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS)
    with mail_server() as mailbox:
        routes = [{"channels": ["ops"], "priorities": ["critical"]}]
        table = {"channels": {"ops": mail_channel(mailbox.port)}, "routes": routes}
        with at_work({**table, "time_zone": "Europe/Berlin", "address": "https://mcc.example"}):
            assert mailbox.took.wait(30)
    (mail,) = mailbox.mails
    assert mail["Subject"] == "[critical] PUMP-A1: condition fault: shorted turns in phase b"
    text = text_of(mail)
    assert "what to do: Stop the motor." in text
    assert "consequence: " in text
    assert re.search(r"since: \d{4}-\d\d-\d\d \d\d:\d\d:\d\d \+0[12]:00", text)
    assert "motor: https://mcc.example/motors/PUMP-A1" in text
    assert "Stop the motor." in html_of(mail)
    (picture,) = [part for part in mail.walk() if part.get_content_type() == "image/png"]
    shown = picture.get_payload(decode=True)
    assert isinstance(shown, bytes)
    assert shown.startswith(b"\x89PNG")
    name = str(picture["Content-ID"]).strip("<>")
    assert f'src="cid:{name}"' in html_of(mail)


def test_hostile_names_are_text_in_every_form(repository: Repository, at_work: Work) -> None:
    refuse_file(repository)
    with mail_server() as mailbox, http_receiver() as receiver:
        table = {
            "channels": {
                "ops": mail_channel(mailbox.port),
                "cmms": {"kind": "webhook", "url": receiver.url},
            },
            "routes": [{"channels": ["ops", "cmms"]}],
        }
        with at_work(table):
            wait_until(lambda: mailbox.mails and receiver.requests, "both messages")
    (mail,) = mailbox.mails
    assert mailbox.recipients == ["shift@plant.example"]
    assert mail["Bcc"] is None
    assert "<script" not in html_of(mail)
    assert "&lt;script&gt;alert(1)" in html_of(mail)
    assert not any(line.startswith("Bcc") for line in text_of(mail).splitlines())
    told: dict[str, Any] = json.loads(receiver.requests[0].body)
    assert told["alarms"][0]["kind"] == "file-refused"
    assert told["alarms"][0]["reason"] == "odd & long"
    assert told["alarms"][0]["action"]
    assert told["id"] == receiver.requests[0].headers["webhook-id"]


def test_a_receiver_that_refuses_holds_up_nobody_else_and_gets_the_message_later(
    repository: Repository, at_work: Work
) -> None:
    with mail_server() as mailbox, http_receiver() as receiver:
        mailbox.replies = ["451 later"] * 3
        receiver.answers.clear()
        table = {
            "channels": {
                "ops": mail_channel(mailbox.port),
                "cmms": {"kind": "webhook", "url": receiver.url},
            },
            "routes": [{"channels": ["cmms", "ops"]}],
        }
        with structlog.testing.capture_logs(), at_work(table) as part:
            alarm = refuse_file(repository)
            wait_until(lambda: mailbox.mails, "the mail")
            assert len(receiver.requests) == 1, "the receiver has not answered yet"
            assert part.problem() is None, "others' failures are no failure of the service"
            receiver.answers.set()
            states = {NotificationState.SENT}
            wait_until(
                lambda: {one.state for one in repository.notifications(limit=9, alarm=alarm).items} == states
            )
    tried = {one.channel: one.attempts for one in repository.notifications(limit=9).items}
    assert tried == {"ops": 4, "cmms": 1}
    assert len(mailbox.mails) == len(receiver.requests) == 1


def test_without_channels_nothing_calls_out_and_nothing_is_kept_for_later(
    repository: Repository, at_work: Work
) -> None:
    refuse_file(repository)
    with at_work({}):
        none = Gathering(0, 0)
        assert eventually(lambda: repository.route_alarm_changes(lambda _: (), none, now_ns=NOW_NS) == 0)
    assert repository.notifications(limit=9).items == ()


def test_a_digest_is_sent_once_though_several_services_run(repository: Repository, at_work: Work) -> None:
    tell(repository, FAULT)
    with mail_server() as mailbox:
        table = {
            "channels": {"office": mail_channel(mailbox.port)},
            "digests": [{"period": "daily", "at": at, "channels": ["office"]} for at in _times()],
        }
        with at_work(table), at_work(table), at_work(table):
            wait_until(lambda: mailbox.mails, "the digest")
            wait_until(
                lambda: all(
                    one.state is NotificationState.SENT for one in repository.notifications(limit=9).items
                )
            )
        with at_work(table):
            pass
    (mail,) = mailbox.mails
    assert "daily digest" in mail["Subject"]
    assert mail["Subject"].endswith(": 1 fault, 1 unknown")
    assert "PUMP-A1 (FACTORY_A): fault, shorted turns in phase b" in text_of(mail)


def test_a_fault_in_one_of_two_phases_is_told_as_that(repository: Repository, at_work: Work) -> None:
    tell(repository, OPEN_PHASE)
    (alarm,) = repository.open_alarms(limit=9).items
    assert alarm.subject == "shorted turns in phase a or c"
    with mail_server() as mailbox:
        routes = [{"channels": ["ops"], "priorities": ["critical"]}]
        digests = [{"period": "daily", "at": at, "channels": ["ops"]} for at in _times()]
        channels = {"ops": mail_channel(mailbox.port)}
        with at_work({"channels": channels, "routes": routes, "digests": digests}):
            wait_until(lambda: len(mailbox.mails) == 2, "the alarm and the digest")
    digest, told = sorted(mailbox.mails, key=lambda mail: "digest" not in str(mail["Subject"]))
    assert told["Subject"] == "[critical] PUMP-A1: condition fault: shorted turns in phase a or c"
    found = "PUMP-A1 (FACTORY_A): fault, shorted turns in phase a (72 %) or c (28 %)"
    assert found in text_of(digest)


def test_no_digest_is_sent_of_a_time_before_the_first_start(repository: Repository, tmp_path: Path) -> None:
    table = {
        "channels": {"office": mail_channel(25)},
        "digests": [{"period": "daily", "at": at, "channels": ["office"]} for at in _times()],
    }
    settings = Settings.model_validate({"data_directory": tmp_path, "notifications": table})
    now_ns = time.time_ns()
    assert len(list(due_digests(settings, repository, now_ns))) == 1
    repository.note_by(SERVICE, AuditAction.PLANT_CHANGED, ("motor", "PUMP-A1"), now_ns=now_ns)
    assert list(due_digests(settings, repository, now_ns)) == []
    assert len(list(due_digests(settings, repository, now_ns + NANOSECONDS_PER_DAY))) == 1


def _times() -> list[str]:
    """Return a time of day that passed a few hours ago, in UTC."""
    return [time.strftime("%H:00", time.gmtime(time.time() - 7200))]


def test_a_claim_of_an_earlier_life_is_taken_up_at_once(repository: Repository, at_work: Work) -> None:
    new = NewNotification(NotificationKind.TEST, "ops", "shift@plant.example", {"by": "ann"})
    digest = NewNotification(
        NotificationKind.ALARMS, "ops", "shift@plant.example", {"number": 0, "alarms": []}
    )
    repository.add_notifications([new, digest], now_ns=NOW_NS)
    for claim in ("this 1", "this 2"):
        assert repository.claim_notification("ops", claim=claim, now_ns=NOW_NS)
    with mail_server() as mailbox, structlog.testing.capture_logs():
        with at_work({"channels": {"ops": mail_channel(mailbox.port)}}):
            assert mailbox.took.wait(30)
        states = {one.kind: one.state for one in repository.notifications(limit=9).items}
    assert states == {
        NotificationKind.TEST: NotificationState.DEAD,
        NotificationKind.ALARMS: NotificationState.SENT,
    }
