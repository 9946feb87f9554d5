"""The nodes of the server: machines and relays, each with its health and its figures."""

from collections.abc import Collection, Mapping, Sequence
from urllib.parse import quote

from asyncua import Server, ua

from service.gateways.opcua.companion_types import MACHINES
from service.gateways.opcua.device_nodes import (
    COMPONENT_NAMES,
    IDENTIFICATION,
    MACHINE_NAMES,
    DeviceNodes,
    Nodes,
    References,
    motor_path,
    relay_path,
)
from service.gateways.opcua.namespaces import MACHINERY, OURS, Namespaces
from service.gateways.opcua.node_items import (
    HAS_NOTIFIER,
    ORGANIZES,
    add,
    delete,
    object_item,
    reference_item,
)
from service.gateways.opcua.type_nodes import add_companion_types
from service.gateways.opcua.values import (
    BESIDE_RECORDS,
    HISTORIES,
    MOTOR_VARIABLES,
    health_value,
    item_state_values,
    motor_value,
    relay_value,
    text_value,
)
from service.gateways.plant_state.figures import MotorFigures, PlantChange, PlantState, RelayFigures
from service.storage.records import Alarm

HistoryNodes = dict[ua.NodeId, tuple[str, str]]


class PlantNodes:
    """Makes the nodes, and writes those values that are other than before.

    uri: of the server, which makes the names of machines unique in the world.
    """

    def __init__(self, server: Server, uri: str) -> None:
        self._server = server
        self._uri = uri
        self._told: dict[ua.NodeId, ua.DataValue] = {}
        self._devices: dict[str, Sequence[ua.NodeId]] = {}
        self.histories: HistoryNodes = {}

    async def begin(self) -> None:
        """Make the types and the folders."""
        self._spaces = spaces = await Namespaces.registered(self._server)
        await add_companion_types(self._server, spaces)
        self._machines = spaces.node_id(*MACHINES)
        self._relays = spaces.own("relays")
        self._device_nodes = DeviceNodes(spaces, self._machines, self._relays)
        objects, server = ua.NodeId(ua.ObjectIds.ObjectsFolder), ua.NodeId(ua.ObjectIds.Server)
        machines = spaces.name(MACHINERY, "Machines")
        relays = spaces.name(OURS, "Relays")
        await add(
            self._server,
            [
                object_item(self._machines, machines, objects, ORGANIZES, is_notifier=True),
                object_item(self._relays, relays, objects, ORGANIZES),
            ],
            [reference_item(server, HAS_NOTIFIER, self._machines)],
        )

    async def tell(self, change: PlantChange) -> None:
        """Make what is new, delete what is gone, write what has changed."""
        for path in (*map(motor_path, change.motors_gone), *map(relay_path, change.relays_gone)):
            await self._forget(path)
        # What is known beside records is uncertain while the database is silent, whatever a motor's quality.
        is_as_current = change.before.is_current == change.now.is_current
        for motor in change.motors if is_as_current else change.now.motors.values():
            if motor_path(motor.name) not in self._devices:
                await self._add(motor_path(motor.name), self._device_nodes.motor(motor))
                self._keep_histories(motor.name)
            await self._write_motor(motor, change.now)
        for relay in change.relays:
            if relay_path(relay.name) not in self._devices:
                await self._add(relay_path(relay.name), self._device_nodes.relay(relay))
            await self._write_relay(relay)

    def source_of(self, alarm: Alarm) -> ua.NodeId:
        """Return the node of what an alarm is about: a motor, a relay, or the service."""
        if alarm.motor is not None:
            return self._spaces.own(motor_path(alarm.motor))
        if alarm.ied is not None:
            return self._spaces.own(relay_path(alarm.ied))
        return ua.NodeId(ua.ObjectIds.Server)

    def notifiers_of(self, alarm: Alarm) -> Sequence[ua.NodeId]:
        """Return the nodes at which clients are told of an alarm: the server, and those of its motor."""
        server = ua.NodeId(ua.ObjectIds.Server)
        if alarm.motor is None:
            return (server,)
        return (server, self._machines, self._spaces.own(f"{motor_path(alarm.motor)}/Notifications"))

    async def _add(self, path: str, items: tuple[Nodes, References]) -> None:
        nodes, references = items
        await add(self._server, nodes, references)
        self._devices[path] = [one.RequestedNewNodeId for one in nodes]

    def _keep_histories(self, motor: str) -> None:
        for variable, quantity in HISTORIES.items():
            self.histories[self._spaces.own(f"{motor_path(motor)}/{variable}")] = (motor, quantity)

    async def _write_motor(self, motor: MotorFigures, now: PlantState) -> None:
        path = motor_path(motor.name)
        values = {f"{path}/{one.name}": motor_value(one, motor, now) for one in MOTOR_VARIABLES}
        values[f"{path}/DeviceHealth"] = health_value(motor.device_health, motor.quality, motor.as_of_ns)
        state, node = item_state_values(motor, self._spaces.machinery)
        current = f"{path}/MachineryItemState/CurrentState"
        values |= {current: state, f"{current}/Id": node}
        known = {
            "ComponentName": motor.name,
            "Location": motor.site,
            "ProductInstanceUri": f"{self._uri}:motor:{quote(motor.name, safe='')}",
            "ProtectedBy": motor.relay,
        }
        values |= _identity(path, MACHINE_NAMES, known)
        await self._describe(path, motor.description)
        await self._write(values, read={f"{path}/{name}" for name in BESIDE_RECORDS})

    async def _write_relay(self, relay: RelayFigures) -> None:
        path = relay_path(relay.name)
        values = {
            f"{path}/Link": relay_value(str(relay.link), relay),
            f"{path}/LinkReason": relay_value(relay.link_reason or "", relay),
            f"{path}/DeviceHealth": health_value(relay.device_health, relay.quality, relay.changed_ns),
        }
        known = {
            "ComponentName": relay.name,
            "Location": relay.site,
            "Manufacturer": relay.manufacturer,
            "Model": relay.type,
        }
        await self._describe(path, relay.type)
        await self._write(values | _identity(path, COMPONENT_NAMES, known))

    async def _forget(self, path: str) -> None:
        nodes = self._devices.pop(path, ())
        if nodes:
            await delete(self._server, nodes, (self._machines, self._relays))
        for known in (self._told, self.histories):
            for one in nodes:
                known.pop(one, None)

    async def _write(self, values: Mapping[str, ua.DataValue], *, read: Collection[str] = ()) -> None:
        """Write those values that are others than before. read: that these were read again is no change."""
        for path, value in values.items():
            node_id = self._spaces.own(path)
            told = self._told.get(node_id)
            is_same = told is not None and (told.Value, told.StatusCode) == (value.Value, value.StatusCode)
            if told != value and not (is_same and path in read):
                await self._put(node_id, ua.AttributeIds.Value, value)
                self._told[node_id] = value

    async def _describe(self, path: str, description: str) -> None:
        text = ua.DataValue(ua.Variant(ua.LocalizedText(description)))
        await self._put(self._spaces.own(path), ua.AttributeIds.Description, text)

    async def _put(self, node: ua.NodeId, attribute: ua.AttributeIds, value: ua.DataValue) -> None:
        """Write an attribute. The server's own way drops the status of a write that is refused."""
        (await self._server.iserver.aspace.write_attribute_value(node, attribute, value)).check()


def _identity(path: str, names: Sequence[str], known: Mapping[str, str]) -> dict[str, ua.DataValue]:
    """Return the values of what a device is known by; what nobody has said is bad."""
    return {
        f"{path}/Identification/{name}": text_value(known.get(name, ""), IDENTIFICATION[name][1])
        for name in names
    }
