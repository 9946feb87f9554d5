"""What a server is asked to add for a motor and for a relay."""

from collections.abc import Mapping, Sequence
from typing import Final

from asyncua import ua

from service.gateways.opcua.companion_types import (
    COMPONENT_IDENTIFICATION,
    DEVICE_HEALTH,
    HEALTH_ENUMERATION,
    ITEM_STATE,
    LOCALIZED_TEXT,
    MACHINE_IDENTIFICATION,
    MONITORING,
    MOTOR,
    NOTIFICATIONS,
    RELAY,
    STRING,
    NodeKey,
)
from service.gateways.opcua.namespaces import DEVICES, MACHINERY, OURS, STANDARD, Namespaces
from service.gateways.opcua.node_items import (
    FOLDER,
    HAS_ADD_IN,
    HAS_COMPONENT,
    HAS_INTERFACE,
    ORGANIZES,
    object_item,
    reference_item,
    variable_item,
)
from service.gateways.opcua.values import HISTORIES, INITIAL, MOTOR_VARIABLES
from service.gateways.plant_state.figures import MotorFigures, RelayFigures

IDENTIFICATION: Final[Mapping[str, tuple[str, ua.VariantType]]] = {
    "ComponentName": (DEVICES, LOCALIZED_TEXT),
    "Manufacturer": (DEVICES, LOCALIZED_TEXT),
    "Model": (DEVICES, LOCALIZED_TEXT),
    "ProductInstanceUri": (DEVICES, STRING),
    "SerialNumber": (DEVICES, STRING),
    "Location": (MACHINERY, STRING),
    "ProtectedBy": (OURS, STRING),
}
"""Namespace and type of what a device is known by (OPC 10000-100 and OPC 40001-1); the last one is ours."""
MACHINE_NAMES: Final = (
    "ComponentName", "Location", "Manufacturer", "ProductInstanceUri", "ProtectedBy", "SerialNumber",
)  # fmt: skip
COMPONENT_NAMES: Final = ("ComponentName", "Location", "Manufacturer", "Model", "SerialNumber")

PARTS: Final = (
    "Identification", "Monitoring", "Notifications", "MachineryBuildingBlocks", "MachineryItemState",
)  # fmt: skip
"""Objects of a machine."""

Nodes = list[ua.AddNodesItem]
References = list[ua.AddReferencesItem]


def motor_path(motor: str) -> str:
    """Return the path of a motor's node in our namespace."""
    return f"motor/{motor}"


def relay_path(relay: str) -> str:
    """Return the path of a relay's node in our namespace."""
    return f"relay/{relay}"


class DeviceNodes:
    """Makes the items of devices. machines, relays: the nodes that they are below."""

    def __init__(self, spaces: Namespaces, machines: ua.NodeId, relays: ua.NodeId) -> None:
        self._spaces = spaces
        self._machines = machines
        self._relays = relays

    def motor(self, motor: MotorFigures) -> tuple[Nodes, References]:
        """Return the nodes of a motor, and the references that they have beside those to their parents."""
        spaces, path = self._spaces, motor_path(motor.name)
        node = spaces.own(path)
        identification, monitoring, notifications, blocks, machine_state = (
            spaces.own(f"{path}/{name}") for name in PARTS
        )
        status, health = (spaces.own(f"{path}/Monitoring/{name}") for name in ("Status", "Health"))
        nodes = [
            *self._device(path, self._machines, MOTOR, motor.name),
            *self._identification(path, MACHINE_IDENTIFICATION, MACHINE_NAMES),
            self._part(monitoring, "Monitoring", node, HAS_ADD_IN, MONITORING),
            self._part(status, "Status", monitoring),
            self._part(health, "Health", monitoring),
            *self._variables(motor.name, monitoring),
            self._part(blocks, "MachineryBuildingBlocks", node),
            *self._item_state(path, blocks),
            object_item(
                notifications, spaces.name(MACHINERY, "Notifications"), node, HAS_ADD_IN,
                spaces.node_id(*NOTIFICATIONS), is_notifier=True,
            ),
        ]  # fmt: skip
        references = [
            *(reference_item(blocks, HAS_ADD_IN, one) for one in (identification, monitoring, notifications)),
            reference_item(status, HAS_COMPONENT, machine_state),
            reference_item(health, HAS_INTERFACE, spaces.node_id(*DEVICE_HEALTH)),
            reference_item(health, HAS_COMPONENT, spaces.own(f"{path}/DeviceHealth")),
        ]
        return nodes, references

    def relay(self, relay: RelayFigures) -> tuple[Nodes, References]:
        """Return the nodes of a relay."""
        spaces, path = self._spaces, relay_path(relay.name)
        nodes = [
            *self._device(path, self._relays, RELAY, relay.name),
            *self._identification(path, COMPONENT_IDENTIFICATION, COMPONENT_NAMES),
        ]
        for name in ("Link", "LinkReason"):
            node_id, browse_name = spaces.own(f"{path}/{name}"), spaces.name(OURS, name)
            value = ua.Variant("", STRING)
            nodes.append(
                variable_item(node_id, browse_name, spaces.own(path), value, ua.NodeId(STRING.value))
            )
        return nodes, []

    def _device(self, path: str, parent: ua.NodeId, kind: NodeKey, name: str) -> Nodes:
        """Return a device with its health."""
        spaces = self._spaces
        node = spaces.own(path)
        return [
            object_item(
                node, spaces.name(OURS, name), parent, ORGANIZES, spaces.node_id(*kind),
            ),
            variable_item(
                spaces.own(f"{path}/DeviceHealth"), spaces.name(DEVICES, "DeviceHealth"), node,
                ua.Variant(0, ua.VariantType.Int32), spaces.node_id(*HEALTH_ENUMERATION),
            ),
        ]  # fmt: skip

    def _identification(self, path: str, kind: NodeKey, names: Sequence[str]) -> Nodes:
        spaces, node = self._spaces, self._spaces.own(f"{path}/Identification")
        nodes = [
            object_item(
                node, spaces.name(DEVICES, "Identification"), spaces.own(path), HAS_ADD_IN,
                spaces.node_id(*kind),
            )
        ]  # fmt: skip
        for name in names:
            namespace, variant = IDENTIFICATION[name]
            nodes.append(
                variable_item(
                    spaces.own(f"{path}/Identification/{name}"), spaces.name(namespace, name), node,
                    ua.Variant(ua.LocalizedText("") if variant is LOCALIZED_TEXT else "", variant),
                    ua.NodeId(variant.value), is_property=True,
                )
            )  # fmt: skip
        return nodes

    def _part(
        self,
        node: ua.NodeId,
        name: str,
        parent: ua.NodeId,
        reference: int = HAS_COMPONENT,
        kind: NodeKey | None = None,
    ) -> ua.AddNodesItem:
        """Return an object of OPC 40001-1; a folder unless it has a type of its own."""
        type_definition = FOLDER if kind is None else self._spaces.node_id(*kind)
        return object_item(node, self._spaces.name(MACHINERY, name), parent, reference, type_definition)

    def _item_state(self, path: str, blocks: ua.NodeId) -> Nodes:
        spaces = self._spaces
        machine = spaces.own(f"{path}/MachineryItemState")
        state = spaces.own(f"{path}/MachineryItemState/CurrentState")
        return [
            self._part(machine, "MachineryItemState", blocks, HAS_ADD_IN, ITEM_STATE),
            variable_item(
                state, spaces.name(STANDARD, "CurrentState"), machine,
                ua.Variant(ua.LocalizedText(""), LOCALIZED_TEXT), ua.NodeId(ua.ObjectIds.LocalizedText),
                type_definition=ua.ObjectIds.FiniteStateVariableType,
            ),
            variable_item(
                spaces.own(f"{path}/MachineryItemState/CurrentState/Id"), spaces.name(STANDARD, "Id"), state,
                ua.Variant(ua.NodeId(), ua.VariantType.NodeId), ua.NodeId(ua.ObjectIds.NodeId),
                is_property=True,
            ),
        ]  # fmt: skip

    def _variables(self, motor: str, monitoring: ua.NodeId) -> Nodes:
        spaces = self._spaces
        return [
            variable_item(
                spaces.own(f"{motor_path(motor)}/{one.name}"), spaces.name(OURS, one.name), monitoring,
                ua.Variant(INITIAL[one.kind], one.kind), ua.NodeId(one.kind.value),
                has_history=one.name in HISTORIES, description=one.meaning,
            )
            for one in MOTOR_VARIABLES
        ]  # fmt: skip
