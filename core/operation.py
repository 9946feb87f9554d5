"""What a motor does while it is recorded."""

from enum import StrEnum


class Operation(StrEnum):
    """What a motor does in a recording; only one that runs can be diagnosed, and a start commissioned from.

    A recording that shows the motor run all the time is `running`. In any other one the motor stands
    (`not-running`), is switched on (`start`), is switched off (`stop`) or is tripped by its relay (`trip`).
    """

    RUNNING = "running"
    NOT_RUNNING = "not-running"
    START = "start"
    STOP = "stop"
    TRIP = "trip"


AT_REST = frozenset({Operation.NOT_RUNNING, Operation.STOP})
"""The motor stands when the recording ends."""

EXPECTED = frozenset({Operation.NOT_RUNNING, Operation.START, Operation.STOP, Operation.TRIP})
"""What a motor does of its own accord or of its operator's: its records are not bad, though they tell nothing
of the winding."""
