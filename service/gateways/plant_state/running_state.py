"""Whether a motor runs, as far as its relay's link and its records tell."""

from enum import StrEnum

from service.storage.states import LinkState


class RunningState(StrEnum):
    """What was seen of the motor last."""

    RUNNING = "running"
    STANDING = "standing"
    UNKNOWN = "unknown"
    """Its relay does not answer, or nothing was seen of it yet."""


def running_state(link: LinkState, as_of_ns: int | None, stood_ns: int | None) -> RunningState:
    """Return the state. as_of_ns: latest record of it running.  stood_ns: when it was last seen to stand."""
    if link is not LinkState.UP or (as_of_ns is None and stood_ns is None):
        return RunningState.UNKNOWN
    return RunningState.STANDING if (stood_ns or 0) > (as_of_ns or 0) else RunningState.RUNNING
