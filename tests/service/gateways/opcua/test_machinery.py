"""Motors are machines by the types of OPC 40001-1, and devices with a health by those of OPC 10000-100."""

import asyncio
from dataclasses import replace
from typing import Any

from asyncua import Client, Server, ua

from service.configuration.settings import Settings
from service.gateways.opcua.address_space import PlantNodes
from service.gateways.opcua.alarm_events import changed_ns
from service.gateways.opcua.companion_types import EDITIONS
from service.gateways.opcua.namespaces import DEVICES, MACHINERY
from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.reading import read_plant_state
from service.storage import Repository
from service.storage.states import AlarmKind, LinkState
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS
from testing.waiting import eventually
from tests.service.gateways.opcua.clients import PUMP, looking, node, value

URI = "urn:statorwatch:test"
KINDS = ua.ObjectIds
MOST_S = 30
OURS_INDEX = 2


async def begun() -> tuple[Server, PlantNodes]:
    """A server in this process, with the types and no devices yet."""
    server = Server()
    await server.init()
    nodes = PlantNodes(server, URI)
    await nodes.begin()
    return server, nodes


async def targets(of: Any, reference: int) -> list[Any]:
    """The nodes that a node refers to."""
    return list(await of.get_referenced_nodes(refs=reference, direction=ua.BrowseDirection.Forward))


async def supertypes(kind: Any) -> list[Any]:
    """A type, and those that it refines."""
    above = await kind.get_referenced_nodes(refs=KINDS.HasSubtype, direction=ua.BrowseDirection.Inverse)
    return [kind, *(await supertypes(above[0]) if above else ())]


async def mandatory_names(client: Client, kind: Any) -> set[tuple[str, str]]:
    """Namespace and name of all that an instance of a type has to have, by its supertypes and interfaces."""
    uris = await client.get_namespace_array()
    found = set()
    for refined in await supertypes(kind):
        for member in await refined.get_children(refs=KINDS.HasProperty):
            rules = await targets(member, KINDS.HasModellingRule)
            if [one.nodeid for one in rules] == [ua.NodeId(KINDS.ModellingRule_Mandatory)]:
                name = await member.read_browse_name()
                found.add((uris[name.NamespaceIndex], name.Name))
        for interface in await targets(refined, KINDS.HasInterface):
            found |= await mandatory_names(client, interface)
    return found


async def names(client: Client, of: Any, reference: int) -> dict[tuple[str, str], Any]:
    """What a node refers to, by namespace and name."""
    uris = await client.get_namespace_array()
    found = {}
    for one in await targets(of, reference):
        name = await one.read_browse_name()
        found[uris[name.NamespaceIndex], name.Name] = one
    return found


async def type_name(client: Client, of: Any) -> str:
    """The name of a node's type."""
    kind = client.get_node(await of.read_type_definition())
    return str((await kind.read_browse_name()).Name)


def test_machines_are_found_by_their_types(repository: Repository, settings: Settings) -> None:
    async def look(client: Client) -> dict[str, str]:
        index = await client.get_namespace_index(MACHINERY)
        found = {}
        for machine in await client.get_node(ua.NodeId(1001, index)).get_children():
            parts = await names(client, machine, KINDS.HasAddIn)
            identification = parts[DEVICES, "Identification"]
            assert await type_name(client, identification) == "MachineIdentificationType"
            kind = client.get_node(await identification.read_type_definition())
            wanted = await mandatory_names(client, kind)
            assert wanted == {
                (DEVICES, "Manufacturer"),
                (DEVICES, "SerialNumber"),
                (DEVICES, "ProductInstanceUri"),
            }
            has = await names(client, identification, KINDS.HasProperty)
            assert wanted <= set(has)
            found[(await machine.read_browse_name()).Name] = await has[
                DEVICES, "ProductInstanceUri"
            ].read_value()
        return found

    found = looking(settings, look)
    assert sorted(found) == ["FAN-A2", "PUMP-A1"]
    assert len(set(found.values())) == 2
    for motor, uri in found.items():
        assert uri.startswith("urn:statorwatch:")
        assert uri.endswith(f":motor:{motor}")


def test_what_nobody_has_said_of_a_machine_is_bad(settings: Settings) -> None:
    for name in ("Manufacturer", "SerialNumber"):
        assert value(settings, f"{PUMP}/Identification/{name}").StatusCode.value == ua.StatusCodes.BadNoData


def test_building_blocks_are_add_ins_of_their_types(settings: Settings) -> None:
    async def look(client: Client) -> None:
        pump = node(client, PUMP)
        assert await type_name(client, pump) == "MotorType"
        (blocks,) = [
            one
            for (_, name), one in (await names(client, pump, KINDS.HasComponent)).items()
            if name == "MachineryBuildingBlocks"
        ]
        found = await names(client, blocks, KINDS.HasAddIn)
        kinds = {name: await type_name(client, one) for name, one in found.items()}
        assert kinds == {
            (DEVICES, "Identification"): "MachineIdentificationType",
            (MACHINERY, "MachineryItemState"): "MachineryItemState_StateMachineType",
            (MACHINERY, "Monitoring"): "MonitoringType",
            (MACHINERY, "Notifications"): "NotificationsType",
        }
        for (uri, name), one in found.items():  # each is called what its type says that instances are called
            kind = client.get_node(await one.read_type_definition())
            said = await (await kind.get_child("0:DefaultInstanceBrowseName")).read_value()
            assert said == await one.read_browse_name(), (uri, name)
        monitoring = await names(client, found[MACHINERY, "Monitoring"], KINDS.HasComponent)
        status = await names(client, monitoring[MACHINERY, "Status"], KINDS.HasComponent)
        assert status[MACHINERY, "MachineryItemState"] == found[MACHINERY, "MachineryItemState"]
        health = monitoring[MACHINERY, "Health"]
        (interface,) = await targets(health, KINDS.HasInterface)
        assert (await interface.read_browse_name()).Name == "IDeviceHealthType"
        (told,) = (await names(client, health, KINDS.HasComponent)).values()
        assert await told.read_value() == await node(client, f"{PUMP}/DeviceHealth").read_value()

    looking(settings, look)


def test_the_state_of_a_machine_is_one_of_its_type(repository: Repository, settings: Settings) -> None:
    async def look(client: Client) -> tuple[str, str, int]:
        machine = node(client, f"{PUMP}/MachineryItemState")
        state = await machine.get_child("0:CurrentState")
        shown = (await state.read_value()).Text
        told = client.get_node(await (await state.get_child("0:Id")).read_value())
        states = await client.get_node(await machine.read_type_definition()).get_children(
            refs=KINDS.HasComponent
        )
        assert told in states
        number = await (await told.get_child("0:StateNumber")).read_value()
        return shown, (await told.read_browse_name()).Name, number

    def status() -> int:
        return int(value(settings, f"{PUMP}/MachineryItemState/CurrentState/Id").StatusCode.value)

    assert status() == ua.StatusCodes.BadNoCommunication
    tell(repository, HEALTHY)
    set_link_state(repository, "A1_SEL710", LinkState.UP, now_ns=NOW_NS, reason=None)
    assert eventually(lambda: status() == ua.StatusCodes.Good)
    assert looking(settings, look) == ("Executing", "Executing", 3)


def test_each_transition_leads_from_one_state_to_another_one(settings: Settings) -> None:
    async def look(client: Client) -> set[tuple[str, str, str]]:
        machine = node(client, f"{PUMP}/MachineryItemState")
        kind = client.get_node(await machine.read_type_definition())
        found = set()
        for one in await kind.get_children(refs=KINDS.HasComponent):
            if await type_name(client, one) == "TransitionType":
                ends = [
                    (await (await targets(one, end))[0].read_browse_name()).Name
                    for end in (KINDS.FromState, KINDS.ToState)
                ]
                found.add(((await one.read_browse_name()).Name, *ends))
        return found

    states = ("NotAvailable", "OutOfService", "NotExecuting", "Executing")
    assert looking(settings, look) == {
        (f"From{before}To{after}", before, after) for before in states for after in states
    }


def test_the_server_says_that_it_has_a_part_of_each_companion_specification(settings: Settings) -> None:
    async def look(client: Client) -> dict[str, tuple[str, bool]]:
        found = {}
        for one in await client.get_node(ua.NodeId(KINDS.Server_Namespaces)).get_children():
            said = {
                (await part.read_browse_name()).Name: await part.read_value()
                for part in await one.get_properties()
            }
            found[said["NamespaceUri"]] = (said["NamespaceVersion"], said["IsNamespaceSubset"])
        return found

    found = looking(settings, look)
    for edition in EDITIONS:
        assert found[edition.namespace] == (edition.version, True)


def test_an_alarm_of_a_motor_is_told_at_its_notifications_with_its_time(
    repository: Repository, settings: Settings
) -> None:
    told: list[tuple[str, Any]] = []

    class Heard:
        def __init__(self, place: str) -> None:
            self.place = place

        def event_notification(self, event: Any) -> None:
            told.append((self.place, event))

    async def listen(client: Client) -> None:
        kind = await client.nodes.base_event_type.get_child("2:MotorAlarmEventType")
        machines = ua.NodeId(1001, await client.get_namespace_index(MACHINERY))
        places = {
            "server": client.nodes.server,
            "machines": client.get_node(machines),
            "pump": node(client, f"{PUMP}/Notifications"),
            "fan": node(client, "motor/FAN-A2/Notifications"),
        }
        for name, place in places.items():
            subscription = await client.create_subscription(100, Heard(name))
            await subscription.subscribe_events(place, kind)
        await asyncio.to_thread(tell, repository, FAULT)
        while not {place for place, _ in told} >= {"server", "machines", "pump"}:
            await asyncio.sleep(0.05)
        # An alarm of the relay comes later: by then one of the motor would have been told at the fan.
        await asyncio.to_thread(
            repository.raise_alarm, "A1_SEL710", AlarmKind.FILE_REFUSED, "E1.CEV", "cut off", now_ns=NOW_NS
        )
        while not [event for _, event in told if event.Kind == "file-refused"]:
            await asyncio.sleep(0.05)

    looking(settings, lambda client: asyncio.wait_for(listen(client), MOST_S))
    assert {place for place, event in told if event.Motor} == {"server", "machines", "pump"}
    assert {place for place, event in told if not event.Motor} == {"server"}
    of_motor = [event for _, event in told if event.Motor]
    assert {event.SourceNode.Identifier for event in of_motor} == {PUMP}
    assert len({event.EventId for event in of_motor}) == len(of_motor) / 3
    (alarm,) = repository.open_alarms(motor="PUMP-A1", limit=5).items
    assert {event.Time.timestamp() for event in of_motor} == {alarm.changed_ns // 1000 / 1e6}


def test_a_motor_that_is_gone_leaves_no_node_behind(repository: Repository) -> None:
    known = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=3650)
    less = PlantState(
        motors={name: one for name, one in known.motors.items() if name != "PUMP-A1"},
        relays={name: one for name, one in known.relays.items() if name != "A1_SEL710"},
    )

    async def left() -> tuple[set[str], set[str]]:
        server, nodes = await begun()
        aspace = server.iserver.aspace._nodes
        before = set(aspace)
        await nodes.tell(PlantChange(PlantState(), known))
        await nodes.tell(PlantChange(known, less))
        ours = {str(one.Identifier) for one in set(aspace) - before}
        dangling = {
            f"{one} to {reference.NodeId}"
            for one in aspace
            for reference in aspace[one].references
            if reference.NodeId not in aspace and reference.NodeId.NamespaceIndex == OURS_INDEX
        }
        await nodes.tell(PlantChange(less, known))
        again = {str(one.Identifier) for one in set(aspace) - before}
        assert again > ours
        return {one for one in ours if "PUMP-A1" in one or "A1_SEL710" in one}, dangling

    assert asyncio.run(left()) == (set(), set())


def test_who_follows_a_motor_that_leaves_is_told_that_it_is_gone(repository: Repository) -> None:
    known = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=3650)
    less = replace(known, motors={name: one for name, one in known.motors.items() if name != "PUMP-A1"})
    told: list[int] = []

    class Heard:
        def datachange_notification(self, _which: Any, _said: Any, data: Any) -> None:
            told.append(data.monitored_item.Value.StatusCode.value)

    async def follow() -> None:
        server, nodes = await begun()
        server.set_endpoint(f"opc.tcp://{LOOPBACK}:{free_port()}/")
        await nodes.tell(PlantChange(PlantState(), known))
        async with server, Client(server.endpoint.geturl()) as client:
            subscription = await client.create_subscription(20, Heard())
            await subscription.subscribe_data_change(node(client, f"{PUMP}/State"))
            while not told:
                await asyncio.sleep(0.02)
            await nodes.tell(PlantChange(known, less))
            while len(told) < 2:
                await asyncio.sleep(0.02)
            await subscription.delete()

    asyncio.run(asyncio.wait_for(follow(), MOST_S))
    assert told == [ua.StatusCodes.BadWaitingForInitialData, ua.StatusCodes.BadNodeIdUnknown]


def test_the_description_of_a_motor_follows_the_plant(repository: Repository) -> None:
    known = read_plant_state(repository, now_ns=NOW_NS, stale_after_days=3650)
    pump = known.motors["PUMP-A1"]
    later = replace(known, motors={**known.motors, "PUMP-A1": replace(pump, description="feeds the boiler")})

    async def described() -> list[str]:
        server, nodes = await begun()
        found = []
        for before, now in ((PlantState(), known), (known, later)):
            await nodes.tell(PlantChange(before, now))
            found.append((await node(server, PUMP).read_description()).Text)
        return found

    assert asyncio.run(described()) == [pump.description, "feeds the boiler"]


def test_the_health_of_a_device_is_an_enumeration_that_tells_its_names(settings: Settings) -> None:
    async def look(client: Client) -> tuple[bool, list[tuple[int, str]]]:
        kind = client.get_node(await node(client, f"{PUMP}/DeviceHealth").read_data_type())
        abstract = (await kind.read_attribute(ua.AttributeIds.IsAbstract)).Value.Value
        fields = (await kind.read_data_type_definition()).Fields
        return abstract, [(field.Value, field.Name) for field in fields]

    names = ("NORMAL", "FAILURE", "CHECK_FUNCTION", "OFF_SPEC", "MAINTENANCE_REQUIRED")
    assert looking(settings, look) == (False, list(enumerate(names)))


def test_an_event_has_the_latest_of_the_times_that_are_new(repository: Repository) -> None:
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "E1.CEV", "cut off", now_ns=NOW_NS)
    (alarm,) = repository.open_alarms(limit=5).items
    assert changed_ns(None, alarm) == max(alarm.raised_ns, alarm.changed_ns)
    assert changed_ns(alarm, replace(alarm, reason="another one")) is None
    assert changed_ns(alarm, replace(alarm, cleared_ns=NOW_NS + 5)) == NOW_NS + 5
    assert changed_ns(alarm, replace(alarm, raised_ns=NOW_NS + 7, raises=2)) == NOW_NS + 7
