"""Health, status and time of what OPC UA clients read of motors and relays in all of their states."""

import asyncio
import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

from asyncua import Client, Server, ua

from core.condition.kinds import Kind, State
from core.units import NANOSECONDS_PER_DAY
from service.configuration.settings import Settings
from service.gateways.opcua.address_space import PlantNodes
from service.gateways.opcua.history import utc
from service.gateways.opcua.namespaces import DEVICES, MACHINERY, OURS
from service.gateways.plant_state.figures import PlantChange, PlantState
from service.gateways.plant_state.reading import NOT_JUDGED, read_plant_state
from service.process.installation import installation_id
from service.storage import Repository
from service.storage.states import LinkState
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, UNKNOWN, tell
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS
from testing.waiting import eventually
from tests.service.gateways.opcua.clients import PUMP, looking, node, value

STATE, LEVEL, AS_OF, HEALTH = (f"{PUMP}/{name}" for name in ("State", "FaultLevel", "AsOf", "DeviceHealth"))
RELAY = "relay/A1_SEL710"
UNSOUND = replace(HEALTHY, state=State.WATCH, kind=Kind.SUPPLY)
NOT_TOLD = replace(UNKNOWN, as_of_ns=NOW_NS)
OLD_NS = NOW_NS - 4000 * NANOSECONDS_PER_DAY
"""More days ago than the settings let a condition be without becoming stale."""

BESIDE_RECORDS = ("Stale", "Alarms", "Priority", "QualityReason")
GOOD = ua.StatusCodes.Good
UNCERTAIN = ua.StatusCodes.UncertainLastUsableValue
NO_DATA, NONE_YET = ua.StatusCodes.BadNoData, ua.StatusCodes.BadWaitingForInitialData


def at(time_ns: int) -> datetime:
    return datetime.fromtimestamp(time_ns // SECOND_NS, UTC)


def told(settings: Settings, path: str) -> tuple[Any, int, datetime | None]:
    """Value, status and source time."""
    found = value(settings, path)
    return found.Value.Value, found.StatusCode.value, found.SourceTimestamp


def health(settings: Settings, path: str) -> tuple[int, str]:
    """The number of a device's health, and what the type of the variable calls it."""

    async def look(client: Client) -> tuple[int, str]:
        variable = node(client, f"{path}/DeviceHealth")
        number = (await variable.read_data_value(raise_on_bad_status=False)).Value.Value
        names = client.get_node(await variable.read_data_type())
        strings = await names.get_child(ua.QualifiedName("EnumStrings", 0))
        assert names.nodeid.NamespaceIndex == await client.get_namespace_index(DEVICES)
        return number, (await strings.read_value())[number].Text

    return looking(settings, look)  # type: ignore[no-any-return] # of any client


def has_health(settings: Settings, path: str, wanted: tuple[int, str]) -> bool:
    """Whether it is told soon."""
    return eventually(lambda: health(settings, path) == wanted)


def test_each_health_of_a_motor_has_its_number_and_its_name(
    repository: Repository, settings: Settings
) -> None:
    expected = [
        (HEALTHY, (0, "NORMAL")),
        (UNSOUND, (3, "OFF_SPEC")),
        (DRIFTING, (4, "MAINTENANCE_REQUIRED")),
        (NOT_TOLD, (2, "CHECK_FUNCTION")),
        (FAULT, (1, "FAILURE")),
    ]
    for condition, numbered in expected:
        tell(repository, condition)
        assert has_health(settings, PUMP, numbered), numbered
    assert health(settings, "motor/FAN-A2") == (2, "CHECK_FUNCTION")


def test_each_health_of_a_relay_has_its_number_and_its_name(
    repository: Repository, settings: Settings
) -> None:
    assert health(settings, RELAY) == (2, "CHECK_FUNCTION")
    expected = [
        (LinkState.UP, None, (0, "NORMAL")),
        (LinkState.QUARANTINED, "it does not keep to the standard", (2, "CHECK_FUNCTION")),
        (LinkState.DOWN, "no answer", (1, "FAILURE")),
    ]
    for number, (state, reason, numbered) in enumerate(expected):
        now_ns = NOW_NS + number * SECOND_NS
        set_link_state(repository, "A1_SEL710", state, reason, now_ns=now_ns)
        assert has_health(settings, RELAY, numbered), numbered
        assert told(settings, f"{RELAY}/Link") == (str(state), GOOD, at(now_ns))
        assert told(settings, f"{RELAY}/LinkReason") == (reason or "", GOOD, at(now_ns))
        assert value(settings, f"{RELAY}/DeviceHealth").StatusCode.value == GOOD


def test_a_condition_of_long_ago_is_uncertain_and_has_its_own_time(
    repository: Repository, settings: Settings
) -> None:
    tell(repository, replace(HEALTHY, as_of_ns=OLD_NS))
    assert eventually(lambda: told(settings, STATE) == ("healthy", UNCERTAIN, at(OLD_NS)))
    assert told(settings, AS_OF) == (at(OLD_NS), UNCERTAIN, at(OLD_NS))
    assert told(settings, LEVEL) == (0.0004, UNCERTAIN, at(OLD_NS))
    assert told(settings, HEALTH) == (2, UNCERTAIN, at(OLD_NS))
    assert value(settings, f"{PUMP}/Stale").Value.Value is True
    assert "older" in value(settings, f"{PUMP}/QualityReason").Value.Value
    tell(repository, replace(FAULT, as_of_ns=OLD_NS))
    assert eventually(lambda: told(settings, STATE) == ("fault", UNCERTAIN, at(OLD_NS)))
    assert told(settings, HEALTH) == (1, UNCERTAIN, at(OLD_NS))


def test_a_condition_of_tomorrow_is_uncertain(repository: Repository, settings: Settings) -> None:
    later_ns = (time.time_ns() + 3 * NANOSECONDS_PER_DAY) // SECOND_NS * SECOND_NS
    tell(repository, replace(HEALTHY, as_of_ns=later_ns))
    assert eventually(lambda: told(settings, STATE) == ("healthy", UNCERTAIN, at(later_ns)))
    assert "a clock is wrong" in value(settings, f"{PUMP}/QualityReason").Value.Value
    assert told(settings, HEALTH) == (0, UNCERTAIN, at(later_ns))


def test_a_state_that_is_unknown_is_uncertain(repository: Repository, settings: Settings) -> None:
    tell(repository, NOT_TOLD)
    assert eventually(lambda: told(settings, STATE) == ("unknown", UNCERTAIN, at(NOW_NS)))
    assert told(settings, LEVEL) == (None, NO_DATA, at(NOW_NS))
    assert told(settings, AS_OF) == (at(NOW_NS), UNCERTAIN, at(NOW_NS))
    assert told(settings, HEALTH) == (2, UNCERTAIN, at(NOW_NS))
    tell(repository, HEALTHY)
    assert eventually(lambda: told(settings, STATE) == ("healthy", GOOD, at(NOW_NS)))


def test_what_is_known_beside_records_is_good_since_it_was_read_so(
    repository: Repository, settings: Settings
) -> None:
    """A motor without records had no alarms but a bad status, and an old one the time of its record."""

    def read(name: str, motor: str = PUMP) -> tuple[Any, datetime]:
        said, status, read_at = told(settings, f"{motor}/{name}")
        assert status == GOOD, name
        assert read_at is not None, name
        return said, read_at

    for motor in (PUMP, "motor/FAN-A2"):
        assert [read(name, motor)[0] for name in BESIDE_RECORDS] == [True, 0, "", NOT_JUDGED]
    begun = read("Alarms")[1]
    assert datetime.now(UTC) - begun < timedelta(minutes=5)
    tell(repository, replace(FAULT, as_of_ns=OLD_NS))
    assert eventually(lambda: told(settings, STATE) == ("fault", UNCERTAIN, at(OLD_NS)))
    assert read("Stale") == (True, begun)
    assert read("Alarms")[0] == 1
    assert read("Alarms")[1] > begun
    assert read("Priority")[0]
    assert "older" in read("QualityReason")[0]


def test_what_is_known_beside_records_is_uncertain_while_the_database_is_silent(
    repository: Repository,
) -> None:
    tell(repository, replace(FAULT, as_of_ns=OLD_NS))
    known = read_plant_state(repository, now_ns=time.time_ns(), stale_after_days=3650)
    silent = known.as_uncertain("the service's database does not answer")
    again = replace(known, read_ns=known.read_ns + SECOND_NS)

    async def statuses() -> list[tuple[set[int], set[datetime | None]]]:
        server = Server()
        await server.init()
        nodes = PlantNodes(server, "urn:statorwatch:test")
        await nodes.begin()
        found = []
        for before, now in ((PlantState(), known), (known, silent), (silent, again), (again, known)):
            await nodes.tell(PlantChange(before, now))
            seen = [
                await node(server, f"{motor}/{name}").read_data_value(raise_on_bad_status=False)
                for motor in (PUMP, "motor/FAN-A2")
                for name in BESIDE_RECORDS
            ]
            found.append(
                ({one.StatusCode.value for one in seen}, {one.SourceTimestamp for one in seen}),
            )
        return found

    first, later = utc(known.read_ns), utc(again.read_ns)
    assert asyncio.run(statuses()) == [
        ({GOOD}, {first}),
        ({UNCERTAIN}, {first}),
        ({GOOD}, {later}),
        ({GOOD}, {later}),
    ]


def test_a_motor_that_was_never_judged_waits_for_its_first_values(settings: Settings) -> None:
    assert told(settings, STATE) == (None, NONE_YET, None)
    assert told(settings, LEVEL) == (None, NO_DATA, None)
    assert told(settings, AS_OF) == (None, NO_DATA, None)
    assert told(settings, HEALTH) == (2, GOOD, None)


def test_devices_are_known_by_what_the_standards_have(settings: Settings) -> None:
    names, text = ua.VariantType.LocalizedText, ua.VariantType.String

    async def look(client: Client, path: str) -> dict[tuple[str, str], tuple[ua.VariantType, str] | int]:
        namespaces = await client.get_namespace_array()
        found: dict[tuple[str, str], tuple[ua.VariantType, str] | int] = {}
        for one in await node(client, f"{path}/Identification").get_properties():
            name, kind = await one.read_browse_name(), await one.read_data_type_as_variant_type()
            said = await one.read_data_value(raise_on_bad_status=False)
            place = (namespaces[name.NamespaceIndex], name.Name)
            if said.StatusCode.value != GOOD:
                found[place] = said.StatusCode.value
                continue
            assert kind is said.Value.VariantType
            found[place] = kind, said.Value.Value.Text if kind is names else said.Value.Value
        return found

    uri = f"urn:statorwatch:{installation_id(settings.data_directory)}:motor:PUMP-A1"
    assert looking(settings, lambda client: look(client, PUMP)) == {
        (DEVICES, "ComponentName"): (names, "PUMP-A1"),
        (DEVICES, "Manufacturer"): NO_DATA,
        (DEVICES, "ProductInstanceUri"): (text, uri),
        (DEVICES, "SerialNumber"): NO_DATA,
        (MACHINERY, "Location"): (text, "FACTORY_A"),
        (OURS, "ProtectedBy"): (text, "A1_SEL710"),
    }
    assert looking(settings, lambda client: look(client, RELAY)) == {
        (DEVICES, "ComponentName"): (names, "A1_SEL710"),
        (DEVICES, "Manufacturer"): (names, "SEL"),
        (DEVICES, "Model"): (names, "SEL-710"),
        (DEVICES, "SerialNumber"): NO_DATA,
        (MACHINERY, "Location"): (text, "FACTORY_A"),
    }
