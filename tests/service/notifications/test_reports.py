"""Reports by mail: sent once at their time, as files, and told in words where they cannot be made."""

import time
from datetime import datetime
from email.message import EmailMessage
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

import pytest
from pydantic import ValidationError

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.application.parts import running
from service.audit.actions import AuditAction
from service.configuration.reports import ReportMail
from service.configuration.settings import Settings
from service.notifications.due import latest_due
from service.notifications.messages.writing import message_of
from service.notifications.reports import due_reports
from service.notifications.work import NotificationWork
from service.senders.mail import mail_document
from service.storage import Repository
from service.storage.records import NewNotification
from service.storage.records.actors import SERVICE
from service.storage.states import NotificationKind
from testing.service.plants import NOW_NS
from testing.service.receivers import mail_server
from testing.waiting import wait_until
from tests.service.notifications.conftest import mail_channel

BERLIN = ZoneInfo("Europe/Berlin")
FLEET = {"report": "fleet", "period": "daily", "channels": ["shift"], "at": "06:00"}
MOTORS = {**FLEET, "report": "motor", "period": "weekly", "motors": ["PUMP-A1", "FAN-A2"]}
ALARMS = {**FLEET, "report": "alarms", "period": "monthly", "format": "xlsx", "sites": ["FACTORY_A"]}


def settings_with(tmp_path: Path, *mails: dict[str, Any], port: int = 25, **more: Any) -> Settings:
    channels = {"shift": mail_channel(port), "log": {"kind": "syslog", "host": "127.0.0.1"}}
    notifications = {"channels": channels, "time_zone": "Europe/Berlin", "retry_delay_s": 0.05, **more}
    return Settings.model_validate(
        {"data_directory": tmp_path, "notifications": notifications, "reports": {"mails": list(mails)}}
    )


def ns(*when: int) -> int:
    return round(datetime(*when, tzinfo=BERLIN).timestamp()) * NANOSECONDS_PER_SECOND  # type: ignore[misc, arg-type]  # year, month, day, hour, minute


@pytest.mark.parametrize(
    ("period", "at", "due"),
    [
        ("daily", (2026, 11, 23, 5, 59), (2026, 11, 22, 6, 0)),
        ("daily", (2026, 11, 23, 6, 0), (2026, 11, 23, 6, 0)),
        ("weekly", (2026, 11, 22, 12, 0), (2026, 11, 16, 6, 0)),
        ("monthly", (2026, 11, 30, 12, 0), (2026, 11, 1, 6, 0)),
        ("monthly", (2026, 3, 1, 5, 0), (2026, 2, 1, 6, 0)),
    ],
)
def test_when_a_report_was_due_last(period: str, at: tuple[int, ...], due: tuple[int, ...]) -> None:
    kind = "alarms" if period == "monthly" else "fleet"
    mail = ReportMail.model_validate({**FLEET, "report": kind, "period": period})
    found = latest_due(mail, datetime(*at, tzinfo=BERLIN))  # type: ignore[misc, arg-type]  # as above
    assert found == datetime(*due, tzinfo=BERLIN)  # type: ignore[misc, arg-type]  # as above


def test_what_is_due_is_said_once_and_is_of_its_time(repository: Repository, tmp_path: Path) -> None:
    settings = settings_with(tmp_path, FLEET, MOTORS, ALARMS)
    now_ns = ns(2026, 6, 1, 7, 0)  # a Monday, and the first of a month
    due = list(due_reports(settings, repository, now_ns))
    of_then = {"format": "pdf", "until_ns": ns(2026, 6, 1, 6, 0)}
    assert [dict(one.document) for one in due] == [
        {**of_then, "report": "fleet", "period": "daily", "sites": None},
        {**of_then, "report": "motor", "period": "weekly", "motor": "PUMP-A1"},
        {**of_then, "report": "motor", "period": "weekly", "motor": "FAN-A2"},
        {
            **of_then, "report": "alarms", "period": "monthly", "format": "xlsx",
            "month": "2026-05", "sites": ["FACTORY_A"],
        },
    ]  # fmt: skip
    repository.add_notifications(due, now_ns=now_ns)
    assert list(due_reports(settings, repository, now_ns)) == []
    assert len(list(due_reports(settings, repository, now_ns + NANOSECONDS_PER_DAY))) == 1
    assert list(due_reports(settings, repository, now_ns + 13 * 3600 * 10**9)) == [], "too late for it"


def test_no_report_of_a_time_before_the_first_start(repository: Repository, tmp_path: Path) -> None:
    settings = settings_with(tmp_path, FLEET)
    now_ns = ns(2026, 6, 1, 7, 0)
    repository.note_by(SERVICE, AuditAction.PLANT_CHANGED, ("motor", "PUMP-A1"), now_ns=now_ns)
    assert list(due_reports(settings, repository, now_ns)) == []


def test_a_report_comes_as_a_mail_with_its_file(repository: Repository, tmp_path: Path) -> None:
    at = time.strftime("%H:00", time.gmtime(time.time() - 7200))
    with mail_server() as mailbox:
        settings = settings_with(
            tmp_path,
            {**FLEET, "at": at},
            port=mailbox.port,
            time_zone="UTC",
            address="https://mcc.plant.example",
        )
        with running([NotificationWork(settings, repository, installation="this", period_s=0.02)]):
            wait_until(lambda: mailbox.mails, "the report")
    (mail,) = mailbox.mails
    assert mail["Subject"].startswith("StatorWatch: Fleet, daily report of ")
    body = mail.get_body(("plain",))
    assert isinstance(body, EmailMessage)
    assert "motors: 2: 2 unknown" in body.get_content()
    assert "https://mcc.plant.example/reports" in body.get_content()
    (file,) = list(mail.iter_attachments())
    assert file.get_content_type() == "application/pdf"
    assert str(file.get_filename()).startswith("fleet_daily_")
    assert file.get_content().startswith(b"%PDF")


def test_every_attempt_sends_the_same(repository: Repository, tmp_path: Path) -> None:
    settings = settings_with(tmp_path, FLEET)
    (new,) = due_reports(settings, repository, ns(2026, 6, 1, 7, 0))
    (kept,) = repository.add_notifications([new], now_ns=NOW_NS)
    first, second = (
        message_of(kept, settings.notifications, repository, with_pictures=True) for _ in range(2)
    )
    assert first == second
    assert len(first.attachments) == 1


def test_a_motor_that_left_the_plant_is_told_in_words(repository: Repository, tmp_path: Path) -> None:
    settings = settings_with(tmp_path)
    document = {
        "report": "motor", "period": "daily", "format": "pdf", "until_ns": NOW_NS, "motor": "GONE\r\nBcc: x",
    }  # fmt: skip
    new = NewNotification(NotificationKind.REPORT, "shift", "shift@plant.example", document)
    (kept,) = repository.add_notifications([new], now_ns=NOW_NS)
    message = message_of(kept, settings.notifications, repository, with_pictures=True)
    assert message.subject == "StatorWatch: a report could not be made"
    assert "GONE" in message.text
    assert message.attachments == ()
    channel = settings.notifications.channels["shift"]
    assert channel.kind == "mail"
    assert b"\nBcc:" not in mail_document(channel, "shift@plant.example", message)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"report": "fleet", "period": "monthly"}, "period daily or weekly of the report fleet"),
        ({"report": "alarms", "period": "daily"}, "period monthly of the report alarms"),
        ({"report": "motor"}, "motors, such as"),
        ({"motors": ["PUMP-A1"]}, "motors with the report motor only"),
        (
            {"report": "motor", "motors": ["A"], "sites": ["B"]},
            "sites with the reports fleet and alarms only",
        ),
        ({"channels": ["log"]}, "channels of kind mail in mails.0, found log; there are shift"),
        ({"channels": ["nobody"]}, "channels of kind mail in mails.0, found nobody"),
        ({"at": "6 o'clock"}, "a time of day"),
    ],
)
def test_settings_that_do_not_fit_are_refused(tmp_path: Path, wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        settings_with(tmp_path, {**FLEET, **wrong})
