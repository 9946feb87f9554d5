"""A background thread that repeats one piece of work and reports when it fails."""

import time
from collections.abc import Callable
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.timing.backoff import Backoff
from service.timing.database_silence import database_trouble, does_not_answer

log = structlog.get_logger(__name__)

LONGEST_PAUSE_S = 30.0
"""After errors that nobody foresaw: each is logged with its traceback, and periods may be short."""

OVERDUE_PERIODS = 5
SHORTEST_OVERDUE_S = 30.0
"""Work that lasts for longer than both say hangs, or has more to do than it can."""


class PeriodicWorker:
    """One thread that calls `work` every `period_s` seconds until it is stopped.

    No failure ends the thread. It is logged, `problem` reports it, and the work is tried again. Where the
    database does not answer, that is a warning, and the next attempt comes a period later. Any other error is
    logged with its traceback, and the pauses grow while such errors follow each other. `problem` also reports
    work that does not come to its end.
    """

    def __init__(
        self,
        name: str,
        work: Callable[[], None],
        *,
        period_s: float,
        at_once: bool = False,
        once_more: bool = False,
        stopping: Event | None = None,
        overdue_s: float | None = None,
    ) -> None:
        """
        at_once: begin with the work, not with a pause.
        once_more: do the work a last time after `stop`.
        stopping: set by `stop`, for work that may take long and should then end.
        overdue_s: how long the work may last [s]; by default five periods, and 30 s at least.
        """
        self._name = name
        self._work = work
        self._period_s = period_s
        self._at_once = at_once
        self._once_more = once_more
        self._backoff = Backoff(period_s, max(period_s, LONGEST_PAUSE_S))
        self._unforeseen = 0
        self._stopping = stopping or Event()
        self._due = Event()
        self._thread = Thread(target=self._run, name=name, daemon=True)
        self._started = False
        self._failure: str | None = None
        self._overdue_s = overdue_s or max(OVERDUE_PERIODS * period_s, SHORTEST_OVERDUE_S)
        self._begun_s: float | None = None

    def start(self) -> None:
        """Start the thread."""
        self._started = True
        self._thread.start()

    def stop(self, timeout_s: float | None = None) -> None:
        """Let the work under way end, then the thread; wait for that, at most `timeout_s` if given."""
        self._stopping.set()
        self._due.set()
        if self._started:
            self._thread.join(timeout_s)

    def wake(self) -> None:
        """Work now instead of at the end of the pause."""
        self._due.set()

    def problem(self) -> str | None:
        """Return why the work is not done at present; None while all is well."""
        if not self._started:
            return f"{self._name} has not started"
        if not self._thread.is_alive() and not self._stopping.is_set():
            return f"{self._name} is not running"
        return self._overdue() or self._failure

    def _overdue(self) -> str | None:
        begun_s = self._begun_s
        if begun_s is None:
            return None
        lasted_s = time.monotonic() - begun_s
        if lasted_s <= self._overdue_s:
            return None
        return f"{self._name} has been at work for {lasted_s:.0f} s, expected at most {self._overdue_s:g} s"

    def _run(self) -> None:
        if self._at_once:
            self._attempt()
        while True:
            self._due.wait(self._backoff.pause_s(self._unforeseen) or self._period_s)
            self._due.clear()
            if self._stopping.is_set():
                break
            self._attempt()
        if self._once_more:
            self._attempt()

    def _attempt(self) -> None:
        self._begun_s = time.monotonic()
        try:
            self._work()
        except SQLAlchemyError as error:
            self._failure = database_trouble(error)
            if does_not_answer(error):
                self._unforeseen = 0
                log.warning("database does not answer, trying again", work=self._name, error=str(error))
            else:
                self._unforeseen += 1
                log.exception("database refused a statement, trying again", work=self._name)
        except Exception as error:  # a bug in one round must not end all that would follow
            self._unforeseen += 1
            self._failure = f"{type(error).__name__}: {error}"
            log.exception("background work failed, trying again", work=self._name)
        else:
            self._unforeseen = 0
            self._failure = None
        finally:
            self._begun_s = None
