"""Terms of the control services that client and server share (IEC 61850-7-2 clause 20)."""

from enum import IntEnum
from typing import Final


class ControlModel(IntEnum):
    """Control model of a controllable object (IEC 61850-7-2, ctlModel)."""

    STATUS_ONLY = 0
    DIRECT_NORMAL = 1
    SBO_NORMAL = 2
    DIRECT_ENHANCED = 3
    SBO_ENHANCED = 4

    @property
    def words(self) -> str:
        """Name of the model as SCL files write it."""
        return _WORDS[self]


_WORDS: Final = (
    "status-only",
    "direct-with-normal-security",
    "sbo-with-normal-security",
    "direct-with-enhanced-security",
    "sbo-with-enhanced-security",
)


class AddCause(IntEnum):
    """Why a control was refused (IEC 61850-7-2, AddCause)."""

    UNKNOWN = 0
    NOT_SUPPORTED = 1
    BLOCKED_BY_SWITCHING_HIERARCHY = 2
    SELECT_FAILED = 3
    INVALID_POSITION = 4
    POSITION_REACHED = 5
    PARAMETER_CHANGE_IN_EXECUTION = 6
    STEP_LIMIT = 7
    BLOCKED_BY_MODE = 8
    BLOCKED_BY_PROCESS = 9
    BLOCKED_BY_INTERLOCKING = 10
    BLOCKED_BY_SYNCHROCHECK = 11
    COMMAND_ALREADY_IN_EXECUTION = 12
    BLOCKED_BY_HEALTH = 13
    ONE_OF_N_CONTROL = 14
    ABORTION_BY_CANCEL = 15
    TIME_LIMIT_OVER = 16
    ABORTION_BY_TRIP = 17
    OBJECT_NOT_SELECTED = 18
    OBJECT_ALREADY_SELECTED = 19
    NO_ACCESS_AUTHORITY = 20
    ENDED_WITH_OVERSHOOT = 21
    ABORTION_DUE_TO_DEVIATION = 22
    ABORTION_BY_COMMUNICATION_LOSS = 23
    ABORTION_BY_COMMAND = 24
    NONE = 25
    INCONSISTENT_PARAMETERS = 26
    LOCKED_BY_OTHER_CLIENT = 27

    @property
    def words(self) -> str:
        """The cause in words."""
        return self.name.lower().replace("_", " ")


def words_of(add_cause: int) -> str:
    """Put an add cause into words, also one that the standard does not know.

    Parameters
    ----------
    add_cause : int
        Number of the cause.

    Returns
    -------
    str
        The cause in words.
    """
    try:
        return AddCause(add_cause).words
    except ValueError:
        return f"add cause {add_cause}"
