"""Work of a moment that somebody waits for: done by the diagnosis workers before anything else.

They have the numbers loaded, which the service's own process does without.
"""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from service.jobs.workers import Argument, NoWorkersError, Result, Workers
from service.waveforms.computing import ANSWER_TIMEOUT_S, NoAnswerError


@dataclass(frozen=True, slots=True)
class _Asked:
    function: Callable[[Any], Any]
    argument: Any
    answer: "Future[Any]"


class Answers:
    """What was asked for and waits for a worker. Any thread asks; the runner's thread has it done."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._asked: deque[_Asked] = deque()
        self._under_way: set[Future[Any]] = set()
        self._problem: str | None = None

    @property
    def under_way(self) -> int:
        """Return how many workers are at it."""
        return len(self._under_way)

    def ask(self, function: Callable[[Argument], Result], argument: Argument, /) -> "Future[Result]":
        """Have a worker do something; the answer ends with NoAnswerError where there is none."""
        answer: Future[Result] = Future()
        self._asked.append(_Asked(function, argument, answer))
        if self._problem is not None:
            self.refuse(self._problem)
        self._wake()
        return answer

    def begin(self, pool: Workers) -> bool:
        """Give a worker what was asked first. Returns False where nothing waits."""
        self._problem = None
        if not self._asked:
            return False
        asked = self._asked.popleft()
        if not asked.answer.set_running_or_notify_cancel():
            return True
        try:
            future = pool.schedule(asked.function, asked.argument, ANSWER_TIMEOUT_S)
        except NoWorkersError as error:
            asked.answer.set_exception(NoAnswerError(str(error)))
            return True
        self._under_way.add(future)
        future.add_done_callback(lambda done: self._done(asked, done))
        return True

    def refuse(self, problem: str) -> None:
        """Answer with NoAnswerError what waits, and what will be asked until `begin` is called again."""
        self._problem = problem
        while self._asked:
            try:
                asked = self._asked.popleft()
            except IndexError:  # another thread was faster
                return
            if asked.answer.set_running_or_notify_cancel():
                asked.answer.set_exception(NoAnswerError(problem))

    def _done(self, asked: _Asked, future: "Future[Any]") -> None:
        """Hand a result over; a thread of the pool calls this."""
        self._under_way.discard(future)
        if future.cancelled():
            asked.answer.set_exception(NoAnswerError("the workers have ended"))
        elif (error := future.exception()) is not None:
            asked.answer.set_exception(error)
        else:
            asked.answer.set_result(future.result())
        self._wake()
