"""The health of motors and relays in the five words of NAMUR NE 107, which OPC UA for Devices uses too."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from core.condition.kinds import Kind, State
from core.rotor.finding import RotorState
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


_ORDER: Final = tuple(DeviceHealth)

_OF_STATE: Final[Mapping[State, DeviceHealth]] = {
    State.HEALTHY: DeviceHealth.NORMAL,
    State.WATCH: DeviceHealth.MAINTENANCE_REQUIRED,
    State.FAULT: DeviceHealth.FAILURE,
    State.UNKNOWN: DeviceHealth.CHECK_FUNCTION,
}
_OF_ROTOR: Final[Mapping[RotorState, DeviceHealth]] = {
    RotorState.WATCH: DeviceHealth.MAINTENANCE_REQUIRED,
    RotorState.FAULT: DeviceHealth.FAILURE,
}
_OF_LINK: Final[Mapping[LinkState, DeviceHealth]] = {
    LinkState.UP: DeviceHealth.NORMAL,
    LinkState.DOWN: DeviceHealth.FAILURE,
    LinkState.QUARANTINED: DeviceHealth.CHECK_FUNCTION,
    LinkState.UNKNOWN: DeviceHealth.CHECK_FUNCTION,
}


def health_of_motor(state: State, kind: Kind, *, stale: bool, rotor: RotorState | None) -> DeviceHealth:
    """Return the health of a motor: the worse one of what is said of its winding and of its rotor.

    rotor: what its standing alarm says; None where none stands.
    """
    of_winding = DeviceHealth.OFF_SPEC if kind is Kind.SUPPLY else _OF_STATE[state]
    if stale and of_winding is not DeviceHealth.FAILURE:
        of_winding = DeviceHealth.CHECK_FUNCTION
    of_rotor = DeviceHealth.NORMAL if rotor is None else _OF_ROTOR.get(rotor, DeviceHealth.NORMAL)
    return max(of_winding, of_rotor, key=_ORDER.index)


def health_of_relay(link: LinkState) -> DeviceHealth:
    """Return the health of a relay, of which the service sees whether it answers."""
    return _OF_LINK[link]
