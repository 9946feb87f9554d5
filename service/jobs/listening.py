"""Wakes the job runner when jobs are queued, where the database tells of it."""

from collections.abc import Callable
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.storage import Repository

log = structlog.get_logger(__name__)

LOOK_S = 1.0
"""How often the thread looks whether it is to end."""

RECONNECT_S = 2.0


POLL_PERIOD_S = 0.2
TOLD_POLL_PERIOD_S = 1.0
"""Where the database tells of jobs, polls find what was queued while the connection was lost."""


def usual_poll_period_s(repository: Repository) -> float:
    """Return how often a runner looks for jobs by itself [s]."""
    return TOLD_POLL_PERIOD_S if repository.tells_of_jobs else POLL_PERIOD_S


class JobListener:
    """One thread that waits for the database to tell of jobs. The runner's polls are the net under it."""

    def __init__(self, repository: Repository, wake: Callable[[], None]) -> None:
        self._repository = repository
        self._wake = wake
        self._stopping = Event()
        self._thread: Thread | None = None

    def start(self) -> None:
        """Start the thread, where the database tells of jobs."""
        if self._repository.tells_of_jobs:
            self._thread = Thread(target=self._run, name="job listener", daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """End the thread and wait for that."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        while not self._stopping.is_set():
            try:
                self._listen()
            except SQLAlchemyError as error:
                log.warning("the database tells of no jobs at present, polling goes on", error=str(error))
                self._stopping.wait(RECONNECT_S)

    def _listen(self) -> None:
        """Wake the runner until told to stop. Raises SQLAlchemyError where the connection is lost."""
        with self._repository.job_notices() as wait:
            self._wake()  # for what was queued before
            while not self._stopping.is_set():
                if wait(LOOK_S):
                    self._wake()
