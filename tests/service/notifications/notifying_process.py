"""Notifications in a process of their own, to be killed: python -m ... DATABASE_URL FOLDER SETTINGS."""

import json
import signal
import sys
from pathlib import Path
from threading import Event

from service.application.parts import running
from service.configuration.settings import Settings
from service.notifications.work import NotificationWork
from service.process.installation import installation_id
from service.process.logs import configure_logging
from service.storage import Repository, connect


def main(database_url: str, folder: str, table: str) -> None:
    """Work until SIGTERM."""
    configure_logging("notifying")
    ending = Event()
    signal.signal(signal.SIGTERM, lambda _number, _frame: ending.set())
    settings = Settings.model_validate({"data_directory": Path(folder), "notifications": json.loads(table)})
    work = NotificationWork(
        settings,
        Repository(connect(database_url)),
        installation=installation_id(settings.data_directory),
        period_s=0.02,
    )
    with running([work]):
        sys.stdout.write("working\n")
        sys.stdout.flush()
        ending.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
