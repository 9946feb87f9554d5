"""Follows the plant's state in the database: one cheap question tells whether to read it again."""

import time
from dataclasses import dataclass, replace
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.storage.change_counter import ChangeCounter
from service.storage.repository import Repository
from service.storage.repository.overviews.change_stamps import Subject
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

PERIOD_S = 0.5
"""Between two looks at the counter of changes."""

SHORTEST_PAUSE_S, LONGEST_PAUSE_S = 1.0, 15.0
SHARE = 20
"""After a reading, no other one for so many times as long: a busy plant costs a twentieth of a core."""

REFRESH_S = 30.0
"""The state is read again at least so often: records get stale without anything being written."""

SILENCE_S = 30.0
"""What has not been known to be so for so long is not good any more: longer than a pause and a reading."""

NOT_READ = "the plant's state has not been read yet"

END_S = 2.0
"""Longest wait for the reading thread to end: a query may hang."""

SUBJECTS = (Subject.FLEET, Subject.ALARMS)


class PlantFollower:
    """Tells of each change of the plant's state. Belongs to one thread.

    It reads on another one: while a query hangs, its owner still learns that nothing is good any more.
    """

    def __init__(
        self,
        repository: Repository,
        *,
        stale_after_days: float | None = None,
        period_s: float = PERIOD_S,
        silence_s: float = SILENCE_S,
    ) -> None:
        self._reader = _Reader(repository, stale_after_days, period_s)
        self._period_s = period_s
        self._silence_s = silence_s
        self._told = PlantState()
        self._is_troubled = False
        self.problem: str | None = NOT_READ
        """Why nothing is known of changes at present; None while the database answers."""

    def next_change(self, stop: Event, *, longest_s: float = float("inf")) -> PlantChange | None:
        """Return the next change; the first one has the whole plant.

        None: `stop` was set, or nothing changed for `longest_s`. Raises what reading raises, unless it is
        that the database does not answer.
        """
        self._reader.start()
        end_s = time.monotonic() + longest_s
        while not stop.is_set() and time.monotonic() < end_s:
            found = self._latest()
            if found is not None and found != self._told:
                change = PlantChange(self._told, found)
                self._told = found
                return change
            self._reader.wait(min(self._period_s, max(end_s - time.monotonic(), 0.0)))
        return None

    def close(self) -> None:
        """End the reading. What is asked afterwards begins it again."""
        self._reader.stop()

    def _latest(self) -> PlantState | None:
        """Return the state that was read last, without good values where that is long ago."""
        found = self._reader.found
        if found.error is not None:
            raise found.error
        silent_s = 0.0 if found.current_s is None else time.monotonic() - found.current_s
        is_silent = silent_s > self._silence_s
        trouble = f"the database has not answered for {silent_s:.0f} s" if is_silent else None
        trouble = found.trouble or trouble
        if trouble is not None and not self._is_troubled:
            log.warning("gateways are not told of changes", error=trouble)
        if trouble is None and self._is_troubled:
            log.info("the database answers again")
        self._is_troubled = trouble is not None
        self.problem = trouble or (NOT_READ if found.state is None else None)
        if is_silent and found.state is not None:
            return found.state.as_uncertain("the service's database does not answer")
        return found.state


@dataclass(frozen=True, slots=True)
class _Found:
    """What reading has come to. It is replaced as a whole, so that no other thread sees half of it.

    state: None before the first one.  current_s: when it was known last that the state is so.
    trouble: why the database does not answer.  error: what has ended the reading.
    """

    state: PlantState | None = None
    current_s: float | None = None
    trouble: str | None = None
    error: Exception | None = None


class _Reader:
    """Reads the state again when something has changed, on a thread of its own."""

    def __init__(self, repository: Repository, stale_after_days: float | None, period_s: float) -> None:
        self._repository = repository
        self._stale_after_days = stale_after_days
        self._period_s = period_s
        self._counted: object = None
        self._stamps: object = None
        self._read_s: float | None = None
        self._pause_s = 0.0
        self._ending = Event()
        self._thread: Thread | None = None
        self._looked = Event()
        self.found = _Found()

    def start(self) -> None:
        """Begin to read, unless that is under way."""
        if self._thread is None:
            self._ending = Event()
            self._thread = Thread(
                target=self._run, args=(self._ending,), name="plant state reader", daemon=True
            )
            self._thread.start()

    def wait(self, longest_s: float) -> None:
        """Wait until the database was asked once more, but no longer than this."""
        self._looked.wait(longest_s)
        self._looked.clear()

    def stop(self) -> None:
        """End the reading; a query that hangs is left to itself."""
        self._ending.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join(END_S)

    def _run(self, ending: Event) -> None:
        counter = self._repository.change_counter()
        try:
            while not ending.is_set():
                self._look(counter)
                self._looked.set()
                ending.wait(self._period_s)
        except Exception as error:  # its owner raises it: the gateway ends, and is started again
            log.exception("the plant's state cannot be read")
            self.found = replace(self.found, error=error)
        finally:
            counter.close()

    def _look(self, counter: ChangeCounter) -> None:
        asked_s = time.monotonic()
        try:
            counted = counter.value()
            if self._is_pausing(asked_s):
                # What has changed since is not known yet: the state may be another one by now.
                current_s = asked_s if counted == self._counted else self.found.current_s
                self.found = _Found(self.found.state, current_s)
                return
            state = self._read_if_changed(counted, asked_s)
        except SQLAlchemyError as error:
            self._counted = self._stamps = None
            self.found = replace(self.found, trouble=database_trouble(error))
            return
        self.found = _Found(state or self.found.state, asked_s)

    def _is_pausing(self, now_s: float) -> bool:
        return self._read_s is not None and now_s - self._read_s < self._pause_s

    def _read_if_changed(self, counted: object, now_s: float) -> PlantState | None:
        is_old = self._read_s is None or now_s - self._read_s > REFRESH_S
        if counted == self._counted and not is_old:
            return None
        stamps = self._repository.change_stamps(SUBJECTS)
        state = None
        if stamps != self._stamps or is_old:
            state = read_plant_state(
                self._repository, now_ns=time.time_ns(), stale_after_days=self._stale_after_days
            )
            self._read_s = time.monotonic()
            self._pause_s = min(max(SHORTEST_PAUSE_S, SHARE * (self._read_s - now_s)), LONGEST_PAUSE_S)
        self._counted, self._stamps = counted, stamps
        return state
