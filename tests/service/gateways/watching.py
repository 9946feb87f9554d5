"""What each gateway says of PUMP-A1, as a client of its protocol sees it."""

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

from asyncua import ua
from asyncua.sync import Client as OpcUaClient

from mms import GOOD, Client, FunctionalConstraint
from mms import Quality as MmsQuality
from mms.values import BitString
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec104.points import BLOCK, FIRST
from service.gateways.supervision import PlantGateways
from testing.ports import LOOPBACK, free_port
from testing.service import sparkplug
from testing.service.gateways import running_gateways
from testing.service.iec104_master import Master
from testing.service.mosquitto import Mosquitto
from testing.waiting import eventually, wait_until
from tests.service.gateways.iec61850.test_iec61850 import PUMP as LOGICAL_DEVICE
from tests.service.gateways.modbus.test_modbus import PUMP as REGISTER
from tests.service.gateways.modbus.test_modbus import figures
from tests.service.gateways.mqtt.test_plain_topics import PUMP as TOPIC
from tests.service.gateways.opcua.clients import PUMP as NODE

ALARM, FAULT = 3, 3
"""EEHealth by IEC 61850-7-4, and the state in the registers."""
POINT = FIRST + BLOCK
"""Where PUMP-A1 begins in IEC 60870-5-104: the second motor."""


@dataclass(frozen=True, slots=True)
class Seen:
    """Whether the state is told as one that can be relied on, and whether it is a fault."""

    is_good: bool
    is_fault: bool


Look = Callable[[], Seen]


def all_gateways(directory: Path, broker: Mosquitto, **settings: object) -> Settings:
    """Settings of a service with a gateway of each protocol that tells the plant's state."""
    tables: dict[str, object] = {
        "iec104": {"port": free_port()},
        "iec61850": {"port": free_port()},
        "modbus": {"port": free_port()},
        "mqtt": {"port": broker.port, "sparkplug": {}},
        "opcua": {"port": free_port(), "anonymous": True, "unencrypted": True},
    }
    gateways = GatewaysSettings.model_validate(tables)
    return Settings.model_validate({"data_directory": directory, "gateways": gateways, **settings})


class Watch:
    """The clients of all gateways."""

    def __init__(self, looks: Mapping[str, Look]) -> None:
        self._looks = looks

    @property
    def names(self) -> set[str]:
        """Return all gateways."""
        return set(self._looks)

    def good(self) -> set[str]:
        """Return the gateways that say now that the state is good."""
        return {name for name, look in self._looks.items() if look().is_good}

    def wait_for_good(self) -> None:
        """Wait until all say so at once."""
        left: set[str] = set()

        def none_is_left() -> bool:
            left.clear()
            left.update(self.names - self.good())
            return not left

        assert eventually(none_is_left), f"not good at {', '.join(sorted(left))}"

    def wait_for_fault(self) -> None:
        """Wait until all tell a fault, none of them as good."""
        found: dict[str, Seen] = {}

        def all_tell_it() -> bool:
            found.update({name: look() for name, look in self._looks.items()})
            return all(seen.is_fault for seen in found.values())

        assert eventually(all_tell_it), f"{found}"
        assert not any(seen.is_good for seen in found.values()), f"{found}"

    def longest_good_s(self, within_s: float = 120.0) -> Mapping[str, float]:
        """Wait until none says so, and return for how long each did at least, and at most so."""
        begun_s = time.monotonic()
        longest_s = dict.fromkeys(self._looks, 0.0)
        left = set(self._looks)

        def none_is_left() -> bool:
            for name in sorted(left):
                asked_s = time.monotonic() - begun_s
                if self._looks[name]().is_good:
                    longest_s[name] = asked_s
                else:
                    left.discard(name)
            return not left

        wait_until(none_is_left, "no gateway to say that the state is good", within_s=within_s)
        return longest_s


@contextmanager
def watched_gateways(settings: Settings, broker: Mosquitto) -> Iterator[tuple[PlantGateways, Watch]]:
    """Run the gateways, with a client at each."""
    gateways = settings.gateways
    with ExitStack() as clients:
        topics = clients.enter_context(broker.listening(TOPIC))
        births = clients.enter_context(broker.listening("spBv1.0/StatorWatch/+/#"))
        running = clients.enter_context(running_gateways(settings))
        assert gateways.iec104 is not None
        assert gateways.iec61850 is not None
        assert gateways.modbus is not None
        assert gateways.opcua is not None
        master = clients.enter_context(closing(Master(LOOPBACK, gateways.iec104.port)))
        modbus_port = gateways.modbus.port
        mms_client = clients.enter_context(Client.connect(LOOPBACK, gateways.iec61850.port))
        opcua_client = clients.enter_context(OpcUaClient(f"opc.tcp://{LOOPBACK}:{gateways.opcua.port}/"))

        def of_iec104() -> Seen:
            master.interrogate()
            state = master.told[POINT]
            return Seen(state.quality == 0, state.value == 1)

        def of_iec61850() -> Seen:
            health = f"{LOGICAL_DEVICE}/ZMOT1.EEHealth"
            bits = mms_client.read(f"{health}.q", FunctionalConstraint.ST)
            assert isinstance(bits, BitString)
            told = mms_client.read(f"{health}.stVal", FunctionalConstraint.ST)
            return Seen(MmsQuality.of(bits) == GOOD, told == ALARM)

        def of_modbus() -> Seen:
            state, _, _, _, quality = figures(modbus_port, REGISTER, "", 5)
            return Seen(quality == 0, state == FAULT)

        def of_opcua() -> Seen:
            found = opcua_client.get_node(f"ns=2;s={NODE}/State").read_data_value(raise_on_bad_status=False)
            return Seen(found.StatusCode.value == ua.StatusCodes.Good, found.Value.Value == "fault")

        def of_mqtt() -> Seen:
            told = json.loads(topics[-1].payload) if topics else {}
            return Seen(told.get("quality") == "good", told.get("state") == "fault")

        def of_sparkplug() -> Seen:
            pump = [one for one in list(births) if one.topic.endswith("/PUMP-A1")]
            for told in reversed(sparkplug.told(pump)):
                if (state := told.metrics.get("Condition/State")) is not None:
                    (quality,) = state["properties"][0]["values"]
                    return Seen(quality["int_value"] == [192], told.value("Condition/State") == "fault")
            return Seen(is_good=False, is_fault=False)

        looks = {
            "iec104": of_iec104,
            "iec61850": of_iec61850,
            "modbus": of_modbus,
            "opcua": of_opcua,
            "mqtt": of_mqtt,
            "sparkplug": of_sparkplug,
        }
        yield running, Watch(looks)
