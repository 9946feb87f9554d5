"""What there is to do for the conditions of motors, for workers that have nothing to diagnose."""

import time
from collections import deque
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor, Future
from dataclasses import dataclass
from importlib.metadata import version
from random import choice

import structlog
from pebble import ProcessExpired
from structlog.typing import FilteringBoundLogger

from core.condition.rules import RULES
from core.machines.parameters import Motor
from core.units import NANOSECONDS_PER_DAY
from service.alarms.condition_rules import AT_ONCE, ConditionRules
from service.condition.errors import RecordFoldError
from service.condition.worker import FoldTask
from service.storage.repository import Repository
from service.storage.transaction_limits import USUAL, TransactionLimits
from service.timing.backoff import Backoff
from service.timing.database_silence import does_not_answer

log: FilteringBoundLogger = structlog.get_logger(__name__)

FAILURES = Backoff(first_s=1.0, longest_s=300.0)
"""Before a motor whose task has failed is tried again."""

MOST_FAILURES = 3
"""After so many in a row, the recording that cannot be folded is left out.

A motor whose fold fails otherwise, or brings its worker down, is set aside until something changes again.
"""

LEFT_OUT = "left out of the condition: {}; it is tried again with another diagnosis, and by another version"

PROGRAM = f"{version('statorwatch')}, rules {RULES}"
"""What left a record out: another one tries it again."""

IN_TURN_NS = NANOSECONDS_PER_DAY
"""Motors take turns that are to be folded from about the same time on; those further behind come after."""

MOST_CHARACTERS = 300
"""Of what is told of a failure."""


@dataclass(frozen=True, slots=True)
class ConditionTask:
    """A task for a worker: to fold a motor (service.condition.worker.fold_motor).

    marks: of the changes that are folded, where the motor's fold has failed before.
    """

    motor: str
    fold: FoldTask
    marks: tuple[str, ...] = ()


@dataclass(slots=True)
class _Trouble:
    """Failures in a row of a motor's tasks, and when the next one may begin."""

    failures: int = 0
    until_s: float = 0.0


class ConditionWork:
    """Says which motor is folded next. For use by one thread.

    One task a motor at a time. A motor whose task fails is tried again after a pause, and set aside after a
    few failures; meanwhile its condition ages. Several services may share a database: what two of them do
    twice is kept once.
    """

    def __init__(
        self,
        repository: Repository,
        motors: Mapping[str, Motor],
        *,
        database_url: str,
        alarm_rules: ConditionRules = AT_ONCE,
        limits: TransactionLimits = USUAL,
    ) -> None:
        """alarm_rules: when a motor's condition makes an alarm. limits: of the workers' transactions."""
        self._alarm_rules = alarm_rules
        self._repository = repository
        self._motors = motors
        self._database_url = database_url
        self._limits = limits
        self._under_way: dict[str, ConditionTask] = {}
        self._trouble: dict[str, _Trouble] = {}
        # Services that share a database begin with different motors, and seldom fold the same one.
        self._latest = choice(sorted(motors)) if motors else ""  # noqa: S311 - nothing to keep secret
        self._to_judge_again: deque[str] = deque()

    def begin(self) -> None:
        """Have tried again what was set aside or left out, and see what other rules have judged.

        Raises SQLAlchemyError.
        """
        self._repository.resume_folds(PROGRAM)
        self._to_judge_again = deque(self._repository.motors_judged_by_other_rules(RULES))
        if self._to_judge_again:
            number = len(self._to_judge_again)
            log.info("motors are judged again by the rules of this version", motors=number)

    def next_task(self) -> ConditionTask | None:
        """Return the next task, which is under way from now on; None where there is nothing to do.

        Raises SQLAlchemyError.
        """
        task = self._next_fold() or self._next_judged_again()
        if task is not None:
            self._under_way[task.motor] = task
        return task

    def ended(self, task: ConditionTask, future: "Future[int]") -> None:
        """Take note of a task that has ended, however it did. Raises SQLAlchemyError."""
        if self._under_way.get(task.motor) is not task:
            return  # it was given back before its worker ended
        del self._under_way[task.motor]
        error = None if future.cancelled() else future.exception()
        if future.cancelled() or isinstance(error, BrokenExecutor):
            return  # the pool's end, not the task's fault
        if error is not None:
            self._failed(task, error)
            return
        self._trouble.pop(task.motor, None)

    @property
    def tasks_under_way(self) -> int:
        """Return how many tasks workers have."""
        return len(self._under_way)

    def give_back(self) -> None:
        """Take all tasks back as if they had not been given: the workers are gone, or there are none."""
        self._under_way.clear()

    def _next_fold(self) -> ConditionTask | None:
        """Return the next motor to fold: new records first, then those that are folded from long ago on.

        Of the latter, the one that is furthest comes to its end before another one begins.
        """
        marks_ns = self._repository.earliest_marks()
        due = [motor for motor in marks_ns if self._is_free(motor)]
        if not due:
            return None
        latest_ns = max(marks_ns[motor] for motor in due)
        due = [motor for motor in due if marks_ns[motor] >= latest_ns - IN_TURN_NS]
        motor = next((one for one in due if one > self._latest), due[0])
        self._latest = motor
        # They may be many, and are of use only where the motor is about to be set aside.
        marks = self._repository.fold_marks(motor) if motor in self._trouble else ()
        task = FoldTask(
            self._database_url, self._motors[motor], alarm_rules=self._alarm_rules, limits=self._limits
        )
        return ConditionTask(motor, task, marks)

    def _next_judged_again(self) -> ConditionTask | None:
        """Begin with another motor that other rules have judged, where none waits to be folded.

        Until its turn it goes on from where it is: its condition follows new records.
        """
        if not self._to_judge_again:
            return None
        waiting = set(self._repository.earliest_marks()).intersection(self._motors)
        if waiting.difference(self._under_way):
            return None
        while self._to_judge_again:
            motor = self._to_judge_again.popleft()
            if self._repository.judge_anew(motor, RULES):
                log.info("motor is judged again", motor=motor, left=len(self._to_judge_again))
                return self._next_fold()
        return None

    def _is_free(self, motor: str) -> bool:
        trouble = self._trouble.get(motor)
        is_pausing = trouble is not None and time.monotonic() < trouble.until_s
        return motor in self._motors and motor not in self._under_way and not is_pausing

    def _failed(self, task: ConditionTask, error: BaseException) -> None:
        trouble = self._trouble.setdefault(task.motor, _Trouble())
        trouble.failures += 1
        trouble.until_s = time.monotonic() + FAILURES.pause_s(trouble.failures)
        log.error("work on a condition failed, trying again", motor=task.motor, exc_info=error)
        if trouble.failures < MOST_FAILURES:
            return
        if isinstance(error, RecordFoldError):
            log.error("record left out of the condition", recording=error.recording_id, reason=error.reason)
            self._repository.leave_out(error.recording_id, LEFT_OUT.format(error.reason), PROGRAM)
            del self._trouble[task.motor]
        elif not does_not_answer(error):
            problem = f"folding failed {trouble.failures} times, the last time: {_words(error)}"
            log.error("motor set aside: its condition follows no records", motor=task.motor, reason=problem)
            self._repository.set_fold_aside(task.motor, task.marks, problem)
            del self._trouble[task.motor]


def _words(error: BaseException) -> str:
    """Return why a task failed, for people."""
    if isinstance(error, ProcessExpired):
        return f"the worker process died (exit code {error.exitcode})"
    if isinstance(error, TimeoutError):
        return "it took too long"
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:MOST_CHARACTERS]
