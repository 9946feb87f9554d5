"""Two services on one PostgreSQL database: each message goes out once, and one goes on without the other."""

import json
import time
from pathlib import Path

import pytest

from service.client.rest_client import ServiceClient
from service.storage import Repository, connect
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, NotificationState
from testing.service.processes import running_service, switched_off_plant
from testing.service.receivers import mail_server
from testing.waiting import wait_until
from tests.service.notifications.conftest import mail_channel

ALARMS = 20


def raise_alarms(repository: Repository, wave: str) -> None:
    for number in range(ALARMS):
        name = f"{wave}-{number:02d}"
        spec = AlarmSpec(AlarmKind.FILE_REFUSED, f"refused {name}", name)
        repository.raise_alarm_at(AlarmPlace(relay="A1_SEL710"), spec, now_ns=time.time_ns())


def is_all_told(repository: Repository, since_ns: int) -> bool:
    """Whether messages were made since then, and all there are have been sent."""
    found = repository.notifications(limit=1000).items
    is_made = any(one.created_ns >= since_ns for one in found)
    return is_made and {one.state for one in found} == {NotificationState.SENT}


@pytest.mark.campaign
@pytest.mark.timeout(600)
def test_messages_go_out_once_and_go_on_when_one_service_is_killed(
    tmp_path: Path, postgresql_url: str
) -> None:
    engine = connect(postgresql_url)
    repository = Repository(engine)
    with mail_server() as mailbox:
        table = {
            "gather_s": 0,
            "pause_s": 0,
            "channels": {"shift": mail_channel(mailbox.port)},
            "routes": [{"channels": ["shift"], "kinds": ["file-refused"]}],
        }
        settings = {
            "MCC_DATABASE_URL": postgresql_url,
            "MCC_RECORDINGS_DIRECTORY": str(tmp_path / "recordings"),
            "MCC_WORKERS": "1",
            "MCC_NOTIFICATIONS": json.dumps(table),
        }
        scd = switched_off_plant(tmp_path)
        first = running_service(tmp_path / "first", scd, **settings)
        second = running_service(tmp_path / "second", scd, **settings)
        for folder in ("first", "second", "recordings"):
            (tmp_path / folder).mkdir()
        with second as staying:
            with first as lost:
                begun_ns = time.time_ns()
                raise_alarms(repository, "before")
                wait_until(lambda: is_all_told(repository, begun_ns), "all mails of two services")
                assert len(mailbox.mails) == len(repository.notifications(limit=1000).items)
                begun_ns = time.time_ns()
                raise_alarms(repository, "during")
                lost.kill(alone=False)
            # What the lost service had claimed goes out when its claim has been silent for long enough.
            wait_until(lambda: is_all_told(repository, begun_ns), "all mails of one service", within_s=240)
            found = repository.notifications(limit=1000).items
            assert len(found) <= len(mailbox.mails) <= sum(one.attempts for one in found)
            with ServiceClient(staying.url) as client:
                assert client.is_ready()
                standing = [one["subject"] for one in client.items("/alarms", limit="500")]
        assert len(standing) == len(set(standing)) >= 2 * ALARMS
    engine.dispose()
