"""The health of motors and relays in the five words of NAMUR NE 107, which OPC UA for Devices uses too."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from core.condition.kinds import Kind, State
from service.storage.states import LinkState


class DeviceHealth(StrEnum):
    """The worst comes last."""

    NORMAL = "normal"
    OFF_SPEC = "off-spec"
    """The device works outside of what it is made for: here, at a supply that is not sound."""
    CHECK_FUNCTION = "check-function"
    """What is known of it cannot be relied on now."""
    MAINTENANCE_REQUIRED = "maintenance-required"
    FAILURE = "failure"


_OF_STATE: Final[Mapping[State, DeviceHealth]] = {
    State.HEALTHY: DeviceHealth.NORMAL,
    State.WATCH: DeviceHealth.MAINTENANCE_REQUIRED,
    State.FAULT: DeviceHealth.FAILURE,
    State.UNKNOWN: DeviceHealth.CHECK_FUNCTION,
}
_OF_LINK: Final[Mapping[LinkState, DeviceHealth]] = {
    LinkState.UP: DeviceHealth.NORMAL,
    LinkState.DOWN: DeviceHealth.FAILURE,
    LinkState.QUARANTINED: DeviceHealth.CHECK_FUNCTION,
    LinkState.UNKNOWN: DeviceHealth.CHECK_FUNCTION,
}


def health_of_motor(state: State, kind: Kind, *, stale: bool) -> DeviceHealth:
    """Return the health of a motor by the state of its worst part, and what that part has."""
    health = DeviceHealth.OFF_SPEC if kind is Kind.SUPPLY else _OF_STATE[state]
    return DeviceHealth.CHECK_FUNCTION if stale and health is not DeviceHealth.FAILURE else health


def health_of_relay(link: LinkState) -> DeviceHealth:
    """Return the health of a relay, of which the service sees whether it answers."""
    return _OF_LINK[link]
