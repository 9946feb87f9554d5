"""The nodes of the server: machines and relays, each with its health and its figures."""

from collections.abc import Collection, Mapping
from typing import Final

from asyncua import Node, Server, ua

from service.gateways.opcua.values import (
    BESIDE_RECORDS,
    HISTORIES,
    INITIAL,
    MOTOR_VARIABLES,
    MotorVariable,
    health_value,
    item_state_values,
    motor_value,
    relay_value,
)
from service.gateways.plant_state.figures import MotorFigures, PlantChange, PlantState, RelayFigures
from service.storage.records import Alarm, Quantity

OURS: Final = "urn:statorwatch:plant"
DEVICES: Final = "http://opcfoundation.org/UA/DI/"
MACHINERY: Final = "http://opcfoundation.org/UA/Machinery/"
HEALTH_TYPE: Final = 6244
"""DeviceHealthEnumeration in the namespace of OPC UA for Devices."""
HEALTH_NAMES: Final = ("NORMAL", "FAILURE", "CHECK_FUNCTION", "OFF_SPEC", "MAINTENANCE_REQUIRED")
MACHINES: Final = 1001
"""The folder Machines in the namespace of OPC UA for Machinery."""
NAMES: Final = ua.VariantType.LocalizedText
IDENTIFICATION: Final[Mapping[str, tuple[str, ua.VariantType]]] = {
    "ComponentName": (DEVICES, NAMES),
    "Manufacturer": (DEVICES, NAMES),
    "Model": (DEVICES, NAMES),
    "ProductInstanceUri": (DEVICES, ua.VariantType.String),
    "Location": (MACHINERY, ua.VariantType.String),
    "ProtectedBy": (OURS, ua.VariantType.String),
}
"""Namespace and type of what a device is known by (OPC 10000-100 and OPC 40001-1); the last one is ours."""

READ_HISTORY: Final = ua.AccessLevel.CurrentRead.mask | ua.AccessLevel.HistoryRead.mask

HISTORY_NODES = dict[ua.NodeId, tuple[str, Quantity]]


class PlantNodes:
    """Makes the nodes, and writes those values that are other than before."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._told: dict[ua.NodeId, ua.DataValue] = {}
        self._devices: dict[str, Node] = {}
        self.histories: HISTORY_NODES = {}

    async def begin(self) -> None:
        """Make the folders and the type of a device's health."""
        server = self._server
        self._ours = await server.register_namespace(OURS)
        self._di = await server.register_namespace(DEVICES)
        self._machinery = await server.register_namespace(MACHINERY)
        enumeration = server.get_node(ua.NodeId(ua.ObjectIds.Enumeration))
        health = await enumeration.add_data_type(
            ua.NodeId(HEALTH_TYPE, self._di), ua.QualifiedName("DeviceHealthEnumeration", self._di)
        )
        await health.add_property(
            ua.NodeId(6450, self._di),
            ua.QualifiedName("EnumStrings", 0),
            [ua.LocalizedText(name) for name in HEALTH_NAMES],
        )
        objects = server.nodes.objects
        self._machines = await objects.add_folder(
            ua.NodeId(MACHINES, self._machinery), ua.QualifiedName("Machines", self._machinery)
        )
        self._relays = await objects.add_folder(
            ua.NodeId("relays", self._ours), ua.QualifiedName("Relays", self._ours)
        )

    async def tell(self, change: PlantChange) -> None:
        """Make what is new, delete what is gone, write what has changed."""
        for name in (*change.motors_gone, *change.relays_gone):
            await self._forget(name)
        # What is known beside records is uncertain while the database is silent, whatever a motor's quality.
        is_as_current = change.before.is_current == change.now.is_current
        for motor in change.motors if is_as_current else change.now.motors.values():
            if f"motor/{motor.name}" not in self._devices:
                await self._add_motor(motor)
            await self._write_motor(motor, change.now)
        for relay in change.relays:
            if f"relay/{relay.name}" not in self._devices:
                await self._add_relay(relay)
            await self._write_relay(relay)

    def motor_node(self, motor: str) -> ua.NodeId:
        """Return the node of a motor, known or not."""
        return ua.NodeId(f"motor/{motor}", self._ours)

    def source_of(self, alarm: Alarm) -> ua.NodeId:
        """Return the node of what an alarm is about: a motor, a relay, or the service."""
        if alarm.motor is not None:
            return self.motor_node(alarm.motor)
        if alarm.ied is not None:
            return ua.NodeId(f"relay/{alarm.ied}", self._ours)
        return ua.NodeId(ua.ObjectIds.Server)

    async def _add_motor(self, motor: MotorFigures) -> None:
        node = await self._add_device(f"motor/{motor.name}", self._machines, motor.name, motor.description)
        identification = {
            "ComponentName": motor.name,
            "Location": motor.site,
            "ProductInstanceUri": f"{OURS}:motor:{motor.name}",
            "ProtectedBy": motor.relay,
        }
        await self._identify(node, f"motor/{motor.name}", identification)
        monitoring = await node.add_folder(
            ua.NodeId(f"motor/{motor.name}/Monitoring", self._ours),
            ua.QualifiedName("Monitoring", self._machinery),
        )
        for variable in MOTOR_VARIABLES:
            await self._add_variable(motor.name, monitoring, variable)
        await self._add_item_state(node, f"motor/{motor.name}")

    async def _add_item_state(self, node: Node, path: str) -> None:
        blocks = await node.add_folder(
            ua.NodeId(f"{path}/MachineryBuildingBlocks", self._ours),
            ua.QualifiedName("MachineryBuildingBlocks", self._machinery),
        )
        machine = await blocks.add_object(
            ua.NodeId(f"{path}/MachineryItemState", self._ours),
            ua.QualifiedName("MachineryItemState", self._machinery),
        )
        state = await machine.add_variable(
            ua.NodeId(f"{path}/MachineryItemState/CurrentState", self._ours),
            ua.QualifiedName("CurrentState", 0),
            ua.Variant(ua.LocalizedText(""), ua.VariantType.LocalizedText),
        )
        await state.add_property(
            ua.NodeId(f"{path}/MachineryItemState/CurrentState/Id", self._ours),
            ua.QualifiedName("Id", 0),
            ua.Variant(ua.NodeId(), ua.VariantType.NodeId),
        )

    async def _add_variable(self, motor: str, parent: Node, variable: MotorVariable) -> None:
        node_id = ua.NodeId(f"motor/{motor}/{variable.name}", self._ours)
        node = await parent.add_variable(
            node_id,
            ua.QualifiedName(variable.name, self._ours),
            ua.Variant(INITIAL[variable.kind], variable.kind),
            variable.kind,
        )
        await node.write_attribute(
            ua.AttributeIds.Description, ua.DataValue(ua.Variant(ua.LocalizedText(variable.meaning)))
        )
        quantity = HISTORIES.get(variable.name)
        if quantity is not None:
            self.histories[node_id] = (motor, quantity)
            await node.write_attribute(
                ua.AttributeIds.AccessLevel, ua.DataValue(ua.Variant(READ_HISTORY, ua.VariantType.Byte))
            )
            await node.write_attribute(
                ua.AttributeIds.UserAccessLevel, ua.DataValue(ua.Variant(READ_HISTORY, ua.VariantType.Byte))
            )
            await node.write_attribute(ua.AttributeIds.Historizing, ua.DataValue(ua.Variant(Value=True)))

    async def _write_motor(self, motor: MotorFigures, now: PlantState) -> None:
        path = f"motor/{motor.name}"
        values = {f"{path}/{one.name}": motor_value(one, motor, now) for one in MOTOR_VARIABLES}
        values[f"{path}/DeviceHealth"] = health_value(motor.device_health, motor.quality, motor.as_of_ns)
        state, node = item_state_values(motor, self._machinery)
        current = f"{path}/MachineryItemState/CurrentState"
        values |= {current: state, f"{current}/Id": node}
        await self._write(values, read={f"{path}/{name}" for name in BESIDE_RECORDS})

    async def _add_relay(self, relay: RelayFigures) -> None:
        path = f"relay/{relay.name}"
        node = await self._add_device(path, self._relays, relay.name, relay.type)
        await self._identify(
            node, path, {"Manufacturer": relay.manufacturer, "Model": relay.type, "Location": relay.site}
        )
        for name in ("Link", "LinkReason"):
            await node.add_variable(
                ua.NodeId(f"{path}/{name}", self._ours), ua.QualifiedName(name, self._ours), ""
            )

    async def _write_relay(self, relay: RelayFigures) -> None:
        path = f"relay/{relay.name}"
        await self._write(
            {
                f"{path}/Link": relay_value(str(relay.link), relay),
                f"{path}/LinkReason": relay_value(relay.link_reason or "", relay),
                f"{path}/DeviceHealth": health_value(relay.device_health, relay.quality, relay.changed_ns),
            }
        )

    async def _add_device(self, path: str, parent: Node, name: str, description: str) -> Node:
        node = await parent.add_object(ua.NodeId(path, self._ours), ua.QualifiedName(name, self._ours))
        await node.write_attribute(
            ua.AttributeIds.Description, ua.DataValue(ua.Variant(ua.LocalizedText(description)))
        )
        await node.add_variable(
            ua.NodeId(f"{path}/DeviceHealth", self._ours),
            ua.QualifiedName("DeviceHealth", self._di),
            ua.Variant(0, ua.VariantType.Int32),
            datatype=ua.NodeId(HEALTH_TYPE, self._di),
        )
        self._devices[path] = node
        return node

    async def _identify(self, node: Node, path: str, properties: Mapping[str, str]) -> None:
        identification = await node.add_object(
            ua.NodeId(f"{path}/Identification", self._ours), ua.QualifiedName("Identification", self._di)
        )
        indices = {OURS: self._ours, DEVICES: self._di, MACHINERY: self._machinery}
        for name, text in properties.items():
            namespace, kind = IDENTIFICATION[name]
            value = ua.LocalizedText(text) if kind is NAMES else text
            await identification.add_property(
                ua.NodeId(f"{path}/Identification/{name}", self._ours),
                ua.QualifiedName(name, indices[namespace]),
                ua.Variant(value, kind),
            )

    async def _forget(self, name: str) -> None:
        for path in (f"motor/{name}", f"relay/{name}"):
            node = self._devices.pop(path, None)
            if node is not None:
                await self._server.delete_nodes([node], recursive=True)
                for known in (self._told, self.histories):
                    for one in [one for one in known if str(one.Identifier).startswith(f"{path}/")]:
                        del known[one]

    async def _write(self, values: Mapping[str, ua.DataValue], *, read: Collection[str] = ()) -> None:
        """Write those values that are others than before. read: that these were read again is no change."""
        for path, value in values.items():
            node_id = ua.NodeId(path, self._ours)
            told = self._told.get(node_id)
            is_same = told is not None and (told.Value, told.StatusCode) == (value.Value, value.StatusCode)
            if told != value and not (is_same and path in read):
                self._told[node_id] = value
                await self._server.write_attribute_value(node_id, value)
