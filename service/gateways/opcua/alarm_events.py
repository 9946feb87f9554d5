"""Each change of an alarm as an event, told at the server and at the machine that it is about."""

from datetime import datetime
from typing import Final

from asyncua import ua
from asyncua.server.event_generator import EventGenerator

from service.gateways.opcua.address_space import PlantNodes
from service.gateways.opcua.companion_types import MOTOR
from service.gateways.opcua.history import utc
from service.gateways.opcua.namespaces import OURS
from service.gateways.opcua.node_items import add, reference_item
from service.gateways.opcua.transport import BoundedServer
from service.gateways.opcua.values import SEVERITIES
from service.gateways.plant_state.figures import PlantChange
from service.storage.records import Alarm

FIELDS: Final = (
    ("Alarm", ua.VariantType.String),
    ("Motor", ua.VariantType.String),
    ("Kind", ua.VariantType.String),
    ("State", ua.VariantType.String),
    ("Standing", ua.VariantType.Boolean),
)


class AlarmEvents:
    """Sends the events."""

    def __init__(self, server: BoundedServer, nodes: PlantNodes, generator: EventGenerator) -> None:
        self._server = server
        self._nodes = nodes
        self._generator = generator

    @classmethod
    async def of(cls, server: BoundedServer, nodes: PlantNodes) -> "AlarmEvents":
        """Make the type of the events."""
        index = await server.get_namespace_index(OURS)
        kind = await server.create_custom_event_type(
            index, "MotorAlarmEventType", ua.ObjectIds.BaseEventType, list(FIELDS)
        )
        motor_type = ua.NodeId(MOTOR[1], index)
        await add(server, [], [reference_item(motor_type, ua.ObjectIds.GeneratesEvent, kind.nodeid)])
        return cls(server, nodes, await server.get_event_generator(kind))

    async def tell(self, change: PlantChange) -> None:
        """Send an event for each alarm that is new, has changed, or is over."""
        for alarm in change.alarms:
            await self._send(alarm, str(alarm.state), utc(alarm.changed_ns))
        for gone in change.alarms_gone:
            await self._send(change.before.alarms[gone], "normal", None)

    async def _send(self, alarm: Alarm, state: str, time: datetime | None) -> None:
        """Send an event. time: of the change; None where it is only known to be over now."""
        event = self._generator.event
        event.Alarm, event.Motor, event.Kind = alarm.id, alarm.motor or "", str(alarm.kind)
        event.State, event.Standing = state, alarm.standing and state != "normal"
        event.Severity = SEVERITIES[alarm.priority]
        event.SourceNode, event.SourceName = self._nodes.source_of(alarm), alarm.place
        server, *others = self._nodes.notifiers_of(alarm)
        event.emitting_node = server
        await self._generator.trigger(time, alarm.reason)
        for notifier in others:  # the same event, with the same EventId
            event.emitting_node = notifier
            await self._server.iserver.subscription_service.trigger_event(event)
