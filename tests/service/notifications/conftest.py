from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from service.application.parts import running
from service.configuration.settings import Settings
from service.notifications.work import NotificationWork
from service.storage import Repository
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

Work = Callable[[dict[str, Any]], Any]


@pytest.fixture
def at_work(repository: Repository, tmp_path: Path) -> Work:
    """A block in which notifications work, with this table of settings."""

    @contextmanager
    def work(notifications: dict[str, Any]) -> Iterator[NotificationWork]:
        table = {"gather_s": 0, "pause_s": 0, "retry_delay_s": 0.05, **notifications}
        settings = Settings.model_validate({"data_directory": tmp_path, "notifications": table})
        part = NotificationWork(settings, repository, installation="this", period_s=0.02)
        with running([part]):
            yield part

    return work


def mail_channel(port: int, **more: Any) -> dict[str, Any]:
    given = {"kind": "mail", "host": "127.0.0.1", "port": port, "security": "none"}
    return {**given, "from": "mcc@plant.example", "to": ["shift@plant.example"], "timeout_s": 20, **more}
