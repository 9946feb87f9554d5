"""MachineryItemState of OPC 40001-1: whether a motor runs, as far as its relay and its records tell."""

from enum import IntEnum

from asyncua import ua

from service.gateways.opcua.history import utc
from service.gateways.plant_state.figures import MotorFigures, Quality, RelayFigures
from service.storage.states import LinkState


class ItemState(IntEnum):
    """States of the machine, by their nodes in that namespace."""

    NOT_AVAILABLE = 5005
    """Nothing is known, or the relay does not answer."""
    EXECUTING = 5006
    """The latest record is of a running motor."""
    NOT_EXECUTING = 5007
    """The motor was seen to stand since."""

    @property
    def browse_name(self) -> str:
        """The name that the standard gives it."""
        return self.name.title().replace("_", "")


def item_state(motor: MotorFigures, relay: RelayFigures | None) -> ItemState:
    """Return the state of a motor's machine."""
    if relay is None or relay.link is not LinkState.UP or _seen_ns(motor) is None:
        return ItemState.NOT_AVAILABLE
    stands = motor.stood_ns is not None and motor.stood_ns > (motor.as_of_ns or 0)
    return ItemState.NOT_EXECUTING if stands else ItemState.EXECUTING


def state_values(
    motor: MotorFigures, relay: RelayFigures | None, namespace: int
) -> tuple[ua.DataValue, ua.DataValue]:
    """Return CurrentState and its Id. namespace: index of that of OPC UA for Machinery."""
    state = item_state(motor, relay)
    is_sure = state is ItemState.NOT_AVAILABLE or (not motor.stale and motor.quality is not Quality.BAD)
    status = ua.StatusCodes.Good if is_sure else ua.StatusCodes.UncertainLastUsableValue
    seen_ns = _seen_ns(motor)
    if state is ItemState.NOT_AVAILABLE and relay is not None:
        seen_ns = relay.changed_ns
    time = None if seen_ns is None else utc(seen_ns)
    name = ua.Variant(ua.LocalizedText(state.browse_name, "en"), ua.VariantType.LocalizedText)
    node = ua.Variant(ua.NodeId(int(state), namespace), ua.VariantType.NodeId)
    code = ua.StatusCode(status)
    return (
        ua.DataValue(name, StatusCode=code, SourceTimestamp=time),
        ua.DataValue(node, StatusCode=code, SourceTimestamp=time),
    )


def _seen_ns(motor: MotorFigures) -> int | None:
    """Return when the motor was seen last, running or not."""
    return max((one for one in (motor.as_of_ns, motor.stood_ns) if one is not None), default=None)
