"""Each change of an alarm as an event, told at the server and at the machine that it is about."""

from datetime import datetime
from typing import Final

from asyncua import ua
from asyncua.server.event_generator import EventGenerator

from service.gateways.opcua.address_space import PlantNodes
from service.gateways.opcua.companion_types import MOTOR, RELAY
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
        sources = [ua.NodeId(name, index) for _, name in (MOTOR, RELAY)]
        references = [reference_item(one, ua.ObjectIds.GeneratesEvent, kind.nodeid) for one in sources]
        await add(server, [], references)
        return cls(server, nodes, await server.get_event_generator(kind))

    async def tell(self, change: PlantChange) -> None:
        """Send an event for each alarm that is new, has changed, or is over."""
        for alarm in change.alarms:
            time_ns = changed_ns(change.before.alarms.get(alarm.id), alarm)
            await self._send(alarm, str(alarm.state), None if time_ns is None else utc(time_ns))
        for gone in change.alarms_gone:
            await self._send(change.before.alarms[gone], "normal", None)

    async def _send(self, alarm: Alarm, state: str, time: datetime | None) -> None:
        """Send an event. time: of the change; None where it is only seen now."""
        event = self._generator.event
        event.Alarm, event.Motor, event.Kind = alarm.id, alarm.motor or "", str(alarm.kind)
        event.State, event.Standing = state, alarm.standing and state != "normal"
        event.Severity = SEVERITIES[alarm.priority]
        event.SourceNode, event.SourceName = self._nodes.source_of(alarm), alarm.place
        event.Message = ua.LocalizedText(alarm.reason)
        server, *others = self._nodes.notifiers_of(alarm)
        event.emitting_node = server
        await self._generator.trigger(time)
        for notifier in others:  # the same event, with the same EventId
            event.emitting_node = notifier
            await self._server.iserver.subscription_service.trigger_event(event)


def changed_ns(before: Alarm | None, now: Alarm) -> int | None:
    """Return when an alarm changed: the latest of its times that are new; None where none is."""
    known = () if before is None else (before.raised_ns, before.changed_ns, before.cleared_ns)
    times = (now.raised_ns, now.changed_ns, now.cleared_ns)
    return max((time for time in times if time is not None and time not in known), default=None)
