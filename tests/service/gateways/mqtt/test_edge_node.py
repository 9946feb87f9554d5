"""The edge node keeps the rules of Sparkplug 3.0, named as its public compatibility kit (TCK) names them."""

import os
import random
import signal
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import dropwhile
from pathlib import Path

import pytest

from service.gateways.mqtt.documents import VERSION
from service.gateways.supervision import PlantGateways
from service.storage import Repository
from service.storage.states import LinkState
from testing.service import sparkplug
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways, started_gateways
from testing.service.links import set_link_state
from testing.service.mosquitto import Heard, Mosquitto
from testing.service.plants import NOW_NS, two_motor_plant
from testing.service.sparkplug import Told
from testing.waiting import eventually, wait_until
from tests.service.gateways.mqtt.conftest import settings_of

COMMANDS = "spBv1.0/StatorWatch/NCMD/statorwatch"
REBIRTH = (
    'timestamp: 1 metrics { name: "Node Control/Rebirth" timestamp: 1 datatype: 11 boolean_value: true }'
)
BORN = ["NBIRTH", "DBIRTH", "DBIRTH"]
FEW_BIRTHS = 5


def kinds(heard: Sequence[Heard]) -> list[str]:
    return [one.topic.split("/")[2] for one in list(heard)]


def told(heard: Sequence[Heard], kind: str) -> list[Told]:
    return [one for one in sparkplug.told(heard) if one.kind == kind]


@pytest.fixture
def heard(broker: Mosquitto) -> Iterator[list[Heard]]:
    with broker.listening("spBv1.0/#") as heard:
        yield heard


@pytest.fixture
def gateways(
    repository: Repository, broker: Mosquitto, tmp_path: Path, heard: list[Heard]
) -> Iterator[PlantGateways]:
    tell(repository, HEALTHY)
    with running_gateways(settings_of(tmp_path, broker.port, sparkplug={})) as gateways:
        wait_until(lambda: len(heard) >= len(BORN))
        yield gateways


def test_births(gateways: PlantGateways, heard: list[Heard]) -> None:
    # tck-id-message-flow-device-birth-publish-nbirth-wait, tck-id-principles-birth-certificates-order
    assert kinds(heard) == BORN
    # tck-id-payloads-nbirth-retain, tck-id-payloads-dbirth-retain
    assert not any(one.is_retained for one in heard)
    node, fan, pump = sparkplug.told(heard)
    # tck-id-topics-nbirth-seq-num, tck-id-payloads-dbirth-seq-inc
    assert [one.sequence for one in (node, fan, pump)] == [0, 1, 2]
    # tck-id-payloads-nbirth-timestamp, tck-id-payloads-dbirth-timestamp
    assert all(one.fields["timestamp"][0] > 1_700_000_000_000 for one in (node, fan, pump))
    # tck-id-topics-nbirth-bdseq-included, tck-id-message-flow-edge-node-birth-publish-nbirth-payload-bdSeq
    assert node.metrics["bdSeq"]["datatype"] == [4]
    # tck-id-topics-nbirth-rebirth-metric, tck-id-operational-behavior-data-commands-rebirth-value
    assert node.metrics["Node Control/Rebirth"]["datatype"] == [11]
    assert node.value("Node Control/Rebirth") is False
    assert node.value("Properties/Version") == VERSION
    # tck-id-payloads-metric-datatype-req, tck-id-payloads-name-birth-data-requirement
    for one in (node, fan, pump):
        assert all({"name", "timestamp", "datatype"} <= metric.keys() for metric in one.metrics.values())
    # tck-id-topics-dbirth-metric-reqs: every metric that is ever told of a motor
    assert fan.metrics.keys() == pump.metrics.keys()
    assert (fan.device, pump.device) == ("FAN-A2", "PUMP-A1")
    assert (pump.value("Condition/State"), pump.value("Condition/Level")) == ("healthy", 0.0004)
    assert pump.value("Condition/As Of") == NOW_NS // 10**6
    assert fan.value("Condition/Level") is None
    # tck-id-payloads-propertyset-quality-value-type, tck-id-payloads-propertyset-quality-value-value
    assert {tuple(one["properties"][0]["keys"]) for one in pump.metrics.values()} == {("Quality",)}
    assert pump.metrics["Condition/State"]["properties"][0]["values"] == [{"type": [3], "int_value": [192]}]
    assert fan.metrics["Condition/State"]["properties"][0]["values"] == [{"type": [3], "int_value": [0]}]


def test_only_what_changed_is_told(
    gateways: PlantGateways, repository: Repository, heard: list[Heard]
) -> None:
    tell(repository, replace(FAULT, as_of_ns=NOW_NS + 10**9), now_ns=NOW_NS + 10**9)
    wait_until(lambda: "DDATA" in kinds(heard))
    (data,) = told(heard, "DDATA")
    # tck-id-payloads-ddata-seq-inc, tck-id-operational-behavior-data-publish-dbirth-change
    assert (data.device, data.sequence) == ("PUMP-A1", 3)
    assert (data.value("Condition/State"), data.value("Condition/Phase")) == ("fault", "b")
    assert data.value("Device Health") == "failure"
    assert data.metrics["Condition/State"]["timestamp"] == [(NOW_NS + 10**9) // 10**6]
    assert "Properties/Site" not in data.metrics
    gone_ns = NOW_NS + 3600 * 10**9
    set_link_state(repository, "A2_SEL710", LinkState.DOWN, now_ns=gone_ns, reason="no answer")
    wait_until(lambda: kinds(heard).count("DDATA") == 2)
    link = told(heard, "DDATA")[1]
    assert link.value("Relay/Link") == "down"
    assert link.metrics["Relay/Link"]["timestamp"] == [gone_ns // 10**6], "not that of a record"
    assert link.metrics["Relay/Link"]["properties"][0]["values"] == [{"type": [3], "int_value": [192]}]


def test_a_motor_that_leaves_dies_and_is_born_again(
    gateways: PlantGateways, repository: Repository, heard: list[Heard]
) -> None:
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[:1]))
    wait_until(lambda: "DDEATH" in kinds(heard))
    (death,) = told(heard, "DDEATH")
    gone = plant.motors[1].name
    # tck-id-payloads-ddeath-seq, tck-id-payloads-ddeath-seq-inc, tck-id-payloads-ddeath-timestamp
    assert (death.device, death.sequence, set(death.fields)) == (gone, 3, {"timestamp", "seq"})
    repository.sync_plant(plant)
    wait_until(lambda: kinds(heard).count("DBIRTH") == 3)
    assert told(heard, "DBIRTH")[-1].device == gone


def test_a_rebirth_is_a_birth_of_the_same_connection(
    gateways: PlantGateways, broker: Mosquitto, heard: list[Heard]
) -> None:
    broker.publish(COMMANDS, sparkplug.encode(REBIRTH))
    wait_until(lambda: [one for one in kinds(heard) if one != "NCMD"] == 2 * BORN)
    first, second = told(heard, "NBIRTH")
    # tck-id-operational-behavior-data-commands-rebirth-action-2
    # tck-id-operational-behavior-data-commands-rebirth-action-3
    assert second.sequence == 0
    assert second.value("bdSeq") == first.value("bdSeq")


def test_many_orders_get_few_births(gateways: PlantGateways, broker: Mosquitto, heard: list[Heard]) -> None:
    for _ in range(20):
        broker.publish(COMMANDS, sparkplug.encode(REBIRTH))
    wait_until(lambda: kinds(heard).count("NBIRTH") >= 3)
    assert kinds(heard).count("NBIRTH") == 3


def test_garbled_and_huge_commands_do_nothing(
    gateways: PlantGateways, repository: Repository, broker: Mosquitto, heard: list[Heard]
) -> None:
    process_id = gateways.status()[0].process_id
    chance = random.Random(23)
    for size in (1, 7, 60, 1000, 60_000, 1_000_000):
        broker.publish(COMMANDS, chance.randbytes(size))
    broker.publish(COMMANDS, b"\x12\xff\xff\xff\xff\x0f")
    tell(repository, FAULT)
    wait_until(lambda: "DDATA" in kinds(heard))
    assert gateways.status()[0].process_id == process_id
    assert kinds(heard).count("NBIRTH") == 1


def test_a_killed_node_dies_and_is_born_with_the_next_number(
    gateways: PlantGateways, heard: list[Heard]
) -> None:
    process_id = gateways.status()[0].process_id
    assert process_id is not None
    os.kill(process_id, signal.SIGKILL)
    wait_until(lambda: kinds(heard) == [*BORN, "NDEATH", *BORN])
    death = told(heard, "NDEATH")[0]
    first, second = told(heard, "NBIRTH")
    # tck-id-topics-ndeath-payload, tck-id-payloads-ndeath-will-message, tck-id-payloads-ndeath-seq
    assert list(death.metrics) == ["bdSeq"]
    assert death.sequence is None
    # tck-id-payloads-ndeath-bdseq, tck-id-topics-nbirth-bdseq-matching, tck-id-topics-nbirth-bdseq-increment
    assert death.value("bdSeq") == first.value("bdSeq") == 0
    assert second.value("bdSeq") == 1


@pytest.mark.parametrize(("protocol", "deaths"), [("5", 2), ("3.1.1", 1)])
def test_a_node_that_is_stopped_says_so(
    repository: Repository, broker: Mosquitto, tmp_path: Path, heard: list[Heard], protocol: str, deaths: int
) -> None:
    (tmp_path / "mqtt-sparkplug.json").write_text('{"bdSeq": 255}', encoding="utf-8")
    with running_gateways(settings_of(tmp_path, broker.port, sparkplug={}, protocol=protocol)):
        wait_until(lambda: len(heard) >= len(BORN))
    # tck-id-operational-behavior-edge-node-intentional-disconnect-ndeath: the node itself
    # tck-id-payloads-ndeath-will-message-publisher-disconnect-mqtt50: and the broker, by the node's will
    # tck-id-payloads-ndeath-will-message-publisher-disconnect-mqtt311
    assert eventually(lambda: kinds(heard) == BORN + deaths * ["NDEATH"])
    # tck-id-message-flow-edge-node-birth-publish-will-message-payload-bdSeq: after 255 comes 0
    births = [one.value("bdSeq") for one in sparkplug.told(heard) if "bdSeq" in one.metrics]
    assert births == [0] * (1 + deaths)


def test_sequence_numbers_begin_again_after_255(
    repository: Repository, broker: Mosquitto, tmp_path: Path, heard: list[Heard]
) -> None:
    plant = two_motor_plant()
    first = plant.motors[0]
    many = [replace(first, motor=replace(first.motor, name=f"Süd/{number}+#")) for number in range(300)]
    repository.sync_plant(replace(plant, motors=tuple(many)))
    with running_gateways(settings_of(tmp_path, broker.port, sparkplug={})):
        wait_until(lambda: len(heard) >= 1 + len(many))
    found = sparkplug.told(heard[: 1 + len(many)])
    # tck-id-payloads-sequence-num-incrementing
    assert [one.sequence for one in found] == [number % 256 for number in range(301)]
    # tck-id-topic-structure-namespace-valid-device-id, tck-id-topic-structure-namespace-unique-device-id
    assert {one.device for one in found[1:]} == {f"Süd%2F{number}%2B%23" for number in range(300)}


def test_a_node_is_born_and_dies_with_its_primary_host(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    state = "spBv1.0/STATE/SCADA1"

    def host(text: str) -> None:
        broker.publish(state, text.encode(), retain=True)

    settings = settings_of(tmp_path, broker.port, sparkplug={"primary_host": "SCADA1"})
    with broker.listening("spBv1.0/StatorWatch/#") as heard, started_gateways(settings) as gateways:

        def waits() -> bool:
            problem = gateways.status()[0].problem or ""
            return "the edge node waits for its primary host SCADA1 to be online" in problem

        wait_until(waits, "the edge node to wait")
        # tck-id-message-flow-edge-node-birth-publish-phid-wait; what cannot be read changes nothing
        for text in ('{"online": false, "timestamp": 1000}', '{"online": "yes", "timestamp": 1}', "[", "{}"):
            host(text)
        broker.publish(COMMANDS, sparkplug.encode(REBIRTH))
        wait_until(lambda: kinds(heard) == ["NCMD"], "the command that changes nothing")
        # tck-id-message-flow-edge-node-birth-publish-phid-wait-online, and -wait-id by the topic
        host('{"online": true, "timestamp": 2000}')
        wait_until(lambda: kinds(heard) == ["NCMD", *BORN], "the births")
        wait_until(lambda: gateways.status()[0].problem is None, "nothing to be waited for")
        # tck-id-operational-behavior-edge-node-termination-host-offline-timestamp
        host('{"online": false, "timestamp": 1999}')
        tell(repository, FAULT)
        wait_until(lambda: kinds(heard)[4:] == ["DDATA"], "the change")
        # tck-id-message-flow-edge-node-birth-publish-phid-offline: by the node, and by the broker its will
        host('{"online": false, "timestamp": 3000}')
        wait_until(lambda: kinds(heard)[5:] == ["NDEATH", "NDEATH"], "the death")
        wait_until(waits, "the edge node to wait again")
        # tck-id-operational-behavior-edge-node-termination-host-offline-reconnect
        host('{"online": true, "timestamp": 4000}')
        wait_until(lambda: kinds(heard)[7:] == BORN, "the births of the next connection")
    first, second = told(heard, "NBIRTH")
    assert (first.value("bdSeq"), second.value("bdSeq")) == (0, 1)


def test_a_primary_host_that_leaves_in_the_middle_of_the_births_is_heeded(
    repository: Repository, broker: Mosquitto, tmp_path: Path
) -> None:
    plant = two_motor_plant()
    first = plant.motors[0]
    motors = tuple(replace(first, motor=replace(first.motor, name=f"M{number}")) for number in range(300))
    repository.sync_plant(replace(plant, motors=motors))
    settings = settings_of(tmp_path, broker.port, sparkplug={"primary_host": "SCADA1"})
    with broker.listening("spBv1.0/StatorWatch/#") as heard, started_gateways(settings) as gateways:

        def says(online: str, timestamp: int) -> None:
            text = f'{{"online": {online}, "timestamp": {timestamp}}}'
            broker.publish("spBv1.0/STATE/SCADA1", text.encode(), retain=True)

        def waits() -> bool:
            return "waits for its primary host" in (gateways.status()[0].problem or "")

        def after(number: int) -> list[str]:
            """What was heard since, without what was still on its way from the death before."""
            return list(dropwhile(lambda kind: kind == "NDEATH", kinds(heard)[number:]))

        def has_heard(number: int) -> bool:
            return len(after(number)) > FEW_BIRTHS

        def has_died_since(number: int) -> bool:
            return "NDEATH" in after(number)

        wait_until(waits, "the edge node to wait")
        for begins in range(1, 4):
            before = len(heard)
            says("true", 10 * begins)
            wait_until(partial(has_heard, before), "the first births")
            says("false", 10 * begins + 1)
            wait_until(partial(has_died_since, before), "the death")
            wait_until(waits, "the edge node to wait again")
            found = after(before)
            assert found[0] == "NBIRTH"
            assert set(found[found.index("NDEATH") :]) == {"NDEATH"}, "nothing is told after a death"
        before = len(heard)
        says("true", 1000)
        wait_until(lambda: after(before).count("DBIRTH") == len(motors), "all births")
        assert after(before)[0] == "NBIRTH"
