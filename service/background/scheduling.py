"""Asks for event reports when a motor's schedule says so.

Several services may share a database: the due time is the key of the request, so each is asked once. A time
that passed while no service ran is not made up for, since the condition it was meant for is gone.
"""

import time
from collections.abc import Iterable
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.plant import PlantMotor, Schedule
from service.storage import Repository

log = structlog.get_logger(__name__)

PERIOD_S = 1.0
LATEST_NS = 60 * 1_000_000_000
"""A due time found later than this, after a sleep of the machine or a jump of its clock, is let go."""


class Scheduler:
    """One thread that compares the schedules with the clock."""

    def __init__(self, motors: Iterable[PlantMotor], repository: Repository) -> None:
        self._schedules: dict[str, Schedule] = {
            motor.name: motor.schedule for motor in motors if motor.schedule is not None
        }
        self._repository = repository
        self._looked_ns = time.time_ns()
        self._next_ns: dict[str, int] = {}
        self._stopping = Event()
        self._thread = Thread(target=self._run, name="scheduler", daemon=True)

    def start(self) -> None:
        if self._schedules:
            self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()

    def problem(self) -> str | None:
        """Why nothing is scheduled at present; None while all is well."""
        ended = bool(self._schedules) and not self._thread.is_alive()
        return "the scheduler is not running" if ended else None

    def look(self, now_ns: int) -> None:
        """Ask for what became due since the last look. Raises SQLAlchemyError: ask again."""
        if not self._looked_ns <= now_ns <= self._looked_ns + LATEST_NS:
            self._looked_ns = min(now_ns, max(self._looked_ns, now_ns - LATEST_NS))
            self._next_ns.clear()
        for motor, schedule in self._schedules.items():
            due_ns = self._next_ns.get(motor)
            if due_ns is None:
                due_ns = self._next_ns[motor] = schedule.next_after(self._looked_ns)
            if due_ns > now_ns:
                continue
            report = self._repository.schedule_recording(motor, due_ns=due_ns, now_ns=now_ns)
            if report is None:
                log.warning("not scheduled: the one before is not done", motor=motor)
            del self._next_ns[motor]
        self._looked_ns = now_ns

    def _run(self) -> None:
        while not self._stopping.wait(PERIOD_S):
            try:
                self.look(time.time_ns())
            except SQLAlchemyError as error:
                log.warning("database does not answer, trying again", error=str(error))
