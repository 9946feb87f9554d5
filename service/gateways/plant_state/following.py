"""Follows the plant's state in the database: one cheap question tells whether to read it again."""

import time
from threading import Event

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.storage.repository import Repository
from service.storage.repository.overviews.change_stamps import Subject
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

PERIOD_S = 0.5
"""Between two looks at the counter of changes."""

SHORTEST_PAUSE_S = 1.0
SHARE = 20
"""After a reading, no other one for so many times as long: a busy plant costs a twentieth of a core."""

REFRESH_S = 30.0
"""The state is read again at least so often: records get stale without anything being written."""

SILENCE_S = 30.0
"""Where the database has not answered for so long, no value is good any more."""

SUBJECTS = (Subject.FLEET, Subject.ALARMS)


class PlantFollower:
    """Tells of each change of the plant's state. Belongs to one thread."""

    def __init__(
        self,
        repository: Repository,
        *,
        stale_after_days: float | None = None,
        period_s: float = PERIOD_S,
        silence_s: float = SILENCE_S,
    ) -> None:
        self._repository = repository
        self._stale_after_days = stale_after_days
        self._period_s = period_s
        self._silence_s = silence_s
        self._counter = repository.change_counter()
        self._counted: object = None
        self._stamps: object = None
        self._told = PlantState()
        self._read_s: float | None = None
        self._answered_s: float | None = None
        self._pause_s = 0.0
        self.problem: str | None = None
        """Why nothing is known of changes at present; None while the database answers."""

    def next_change(self, stop: Event, *, longest_s: float = float("inf")) -> PlantChange | None:
        """Return the next change; the first one has the whole plant.

        None: `stop` was set, or nothing changed for `longest_s`.
        """
        end_s = time.monotonic() + longest_s
        while not stop.is_set() and time.monotonic() < end_s:
            found = self._look()
            if found is not None and found != self._told:
                change = PlantChange(self._told, found)
                self._told = found
                return change
            stop.wait(min(self._period_s, max(end_s - time.monotonic(), 0.0)))
        return None

    def close(self) -> None:
        """Give the counter's connection back."""
        self._counter.close()

    def _look(self) -> PlantState | None:
        """Return the state, if it was read; one without good values where the database is silent for long."""
        now_s = time.monotonic()
        if self._read_s is not None and now_s - self._read_s < self._pause_s:
            return None
        try:
            found = self._read_if_changed(now_s)
        except SQLAlchemyError as error:
            return self._silent(database_trouble(error), now_s)
        self._answered_s = now_s
        if self.problem is not None:
            log.info("the database answers again")
            self.problem = None
        return found

    def _read_if_changed(self, now_s: float) -> PlantState | None:
        is_old = self._read_s is None or now_s - self._read_s > REFRESH_S
        counted = self._counter.value()
        if counted == self._counted and not is_old:
            return None
        stamps = self._repository.change_stamps(SUBJECTS)
        state = None
        if stamps != self._stamps or is_old:
            state = read_plant_state(
                self._repository, now_ns=time.time_ns(), stale_after_days=self._stale_after_days
            )
            self._read_s = time.monotonic()
            self._pause_s = max(SHORTEST_PAUSE_S, SHARE * (self._read_s - now_s))
        self._counted, self._stamps = counted, stamps
        return state

    def _silent(self, trouble: str, now_s: float) -> PlantState | None:
        if self.problem is None:
            log.warning("gateways are not told of changes", error=trouble)
            self.problem = trouble
        self._counted = self._stamps = None
        is_long = self._answered_s is not None and now_s - self._answered_s > self._silence_s
        return self._told.as_uncertain("the service's database does not answer") if is_long else None
