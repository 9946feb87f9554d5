"""Requests recordings at the times of the motors' and the buses' schedules.

Several services may share a database. The due time is the key of the request, so that each recording is
requested once. The motors of a bus are all requested in one go, so that their records show the same supply. A
time that passed while no service ran is not made up for: the condition it was meant for is gone.

A schedule may ask for running motors only. Whether a motor runs is seen in what its relay measures all the
time. A motor of which nothing fresh was measured is recorded: the record tells then what it does.
"""

import time
from collections.abc import Iterable

import structlog

from core.units import NANOSECONDS_PER_SECOND
from service.plant import Bus, PlantMotor, Schedule
from service.plant.standstill import why_it_stands
from service.storage import Repository

log = structlog.get_logger(__name__)

PERIOD_S = 1.0
FRESH_PERIODS, LEAST_FRESH_S = 3.0, 30.0
"""Measured values tell whether a motor runs for so many of their periods, and for so long at least."""
LONGEST_DELAY_NS = 60 * NANOSECONDS_PER_SECOND
"""A due time that is found later than this, after a suspend or a clock change, is skipped."""


class Scheduler:
    """Compares the schedules with the wall clock."""

    def __init__(
        self,
        motors: Iterable[PlantMotor],
        repository: Repository,
        *,
        buses: Iterable[Bus] = (),
        since_ns: int | None = None,
        metering_period_s: float = 10.0,
    ) -> None:
        """since_ns: times from then on are due; now if None.

        metering_period_s: how often the relays' measured values are sampled.
        """
        motors = tuple(motors)
        self._nameplates = {motor.name: motor.motor.nameplate for motor in motors}
        self._fresh_ns = round(max(FRESH_PERIODS * metering_period_s, LEAST_FRESH_S) * NANOSECONDS_PER_SECOND)
        self._schedules: list[tuple[Schedule, tuple[str, ...]]] = [
            *((motor.schedule, (motor.name,)) for motor in motors if motor.schedule is not None),
            *((bus.schedule, bus.motors) for bus in buses if bus.schedule is not None),
        ]
        self._repository = repository
        self._checked_ns = time.time_ns() if since_ns is None else since_ns
        self._next_ns: dict[int, int] = {}

    def request_due(self, now_ns: int) -> None:
        """Request the recordings that became due since the last call.

        Raises SQLAlchemyError: the next call requests what this one could not.
        """
        if not self._checked_ns <= now_ns <= self._checked_ns + LONGEST_DELAY_NS:
            self._checked_ns = min(now_ns, max(self._checked_ns, now_ns - LONGEST_DELAY_NS))
            self._next_ns.clear()
        for number, (schedule, motors) in enumerate(self._schedules):
            due_ns = self._next_ns.get(number)
            if due_ns is None:
                due_ns = self._next_ns[number] = schedule.next_after(self._checked_ns)
            if due_ns > now_ns:
                continue
            for motor in motors:
                if schedule.only_running and self._is_skipped(motor, due_ns, now_ns):
                    continue
                request = self._repository.schedule_recording(motor, due_ns=due_ns, now_ns=now_ns)
                if request is None:
                    log.warning("schedule skipped: the previous recording request is still open", motor=motor)
            del self._next_ns[number]
        self._checked_ns = now_ns

    def _is_skipped(self, motor: str, due_ns: int, now_ns: int) -> bool:
        """Note that a motor is not recorded because it stands; False where it may run."""
        measured = self._repository.latest_sample(motor, since_ns=now_ns - self._fresh_ns)
        reason = None if measured is None else why_it_stands(measured.values, self._nameplates[motor])
        if reason is None:
            return False
        if self._repository.skip_recording(motor, reason, due_ns=due_ns, now_ns=now_ns):
            log.info("schedule skipped", motor=motor, reason=reason)
        return True
