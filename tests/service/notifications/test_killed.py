"""Messages while the service is killed: nothing is lost, and nothing comes more often than it was tried."""

import json
import random
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from service.storage import Repository
from service.storage.records import AlarmPlace, AlarmSpec, Notification
from service.storage.states import AlarmKind, NotificationState
from testing.service.plants import NOW_NS
from testing.service.receivers import http_receiver, mail_server
from testing.waiting import wait_until
from tests.service.notifications.conftest import mail_channel

KILLS = 5


@contextmanager
def working(database_url: str, folder: Path, table: dict[str, Any]) -> Iterator["subprocess.Popen[str]"]:
    """A process that makes and sends messages, until the block ends or somebody kills it."""
    given = {"gather_s": 0, "pause_s": 0, "retry_delay_s": 0.05, "attempts": 20, **table}
    module = "tests.service.notifications.notifying_process"
    command = [sys.executable, "-m", module, database_url, str(folder), json.dumps(given)]
    with (
        (folder / "log").open("a") as log,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True) as process,
    ):
        assert process.stdout is not None
        assert process.stdout.readline() == "working\n", (folder / "log").read_text()
        try:
            yield process
        finally:
            process.terminate()
            process.wait(30)


def raise_alarm(repository: Repository, name: str) -> str:
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, "odd name", name)
    return repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=NOW_NS).id


def all_sent(repository: Repository, number: int) -> bool:
    found = repository.notifications(limit=1000).items
    return len(found) == number and {one.state for one in found} == {NotificationState.SENT}


@pytest.mark.parametrize(
    "database_url", ["sqlite", pytest.param("postgresql", marks=pytest.mark.campaign)], indirect=True
)
def test_a_kill_between_the_receivers_yes_and_its_note_repeats_that_message_once(
    repository: Repository, database_url: str, tmp_path: Path
) -> None:
    raise_alarm(repository, "a")
    with mail_server() as mailbox:
        table = {"channels": {"ops": mail_channel(mailbox.port)}, "routes": [{"channels": ["ops"]}]}
        mailbox.answers.clear()
        with working(database_url, tmp_path, table) as process:
            assert mailbox.took.wait(60)
            process.kill()
            process.wait(30)
        assert len(mailbox.mails) == 1, "the server has it, and nobody knows"
        mailbox.answers.set()
        with working(database_url, tmp_path, table):
            wait_until(lambda: all_sent(repository, 1), "the message to be sent")
    (sent,) = repository.notifications(limit=9).items
    assert sent.attempts == len(mailbox.mails) == 2
    first, second = mailbox.mails
    assert first["Message-ID"] == second["Message-ID"], "mail programs show it once"


@pytest.mark.campaign
@pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)
def test_kills_at_any_time_lose_nothing_and_repeat_no_more_than_they_interrupt(
    repository: Repository, database_url: str, tmp_path: Path
) -> None:
    chance = random.Random(19)
    alarms = [raise_alarm(repository, f"file {number}") for number in range(5)]
    with http_receiver() as receiver:
        hook = {"kind": "webhook", "url": receiver.url}
        table = {
            "channels": {"one": hook, "two": hook},
            "routes": [{"channels": ["one", "two"], "events": ["raised", "acknowledged"]}],
        }
        for kill in range(KILLS):
            with working(database_url, tmp_path, table) as process:
                alarms.append(raise_alarm(repository, f"further file {kill}"))
                time.sleep(chance.uniform(0.0, 0.2))  # any moment will do
                process.kill()
                process.wait(30)
        with working(database_url, tmp_path, table):
            wait_until(lambda: not waiting(repository, len(alarms)), "all messages to be sent")
        taken = Counter(request.headers["webhook-id"] for request in receiver.requests)
    found = {one.id: one for one in repository.notifications(limit=1000).items}
    assert {one.state for one in found.values()} == {NotificationState.SENT}
    assert all(taken[one.id] >= 1 for one in found.values()), "each message has arrived"
    assert all(number <= found[message].attempts for message, number in taken.items())
    assert sum(taken.values()) - len(taken) <= 2 * KILLS, "one message of each channel at each kill"
    told = Counter((one.channel, alarm["id"]) for one in found.values() for alarm in _alarms(one))
    assert set(told) == {(channel, alarm) for channel in ("one", "two") for alarm in alarms}
    assert set(told.values()) == {1}, "each alarm is in one message of each channel"


def waiting(repository: Repository, alarms: int) -> bool:
    """Whether messages wait, or alarms that are in none yet."""
    found = repository.notifications(limit=1000).items
    told = {alarm["id"] for one in found for alarm in _alarms(one)}
    return len(told) < alarms or any(one.state is not NotificationState.SENT for one in found)


def _alarms(message: Notification) -> list[dict[str, str]]:
    listed = (message.document or {}).get("alarms")
    return listed if isinstance(listed, list) else []
