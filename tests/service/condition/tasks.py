"""Two motors with their records, and tasks that fail."""

from concurrent.futures import Future

from testing.service.following import FAN, PUMP
from testing.service.observations import records_of_a_motor
from testing.service.plants import motor

RECORDS = records_of_a_motor(12)
MOTORS = {name: motor(name) for name in (PUMP, FAN)}


def failed(error: Exception) -> Future[int]:
    """What a worker gives for a task that failed."""
    future: Future[int] = Future()
    future.set_exception(error)
    return future
