"""python -m benchmarks.gateways.killed: how soon a killed gateway tells values of 500 motors as good again.

Each gateway is killed in turns (SIGKILL) while all run. The time is from the kill to the first good value
that a new client reads; with MQTT it is to the status that the broker hears anew, after all motors' states.
"""

import argparse
import os
import re
import signal
import subprocess
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from asyncua import ua
from asyncua.sync import Client as OpcUaClient
from open61850 import data as open_data
from open61850 import mms as open_mms

from benchmarks.gateways.plant import ChangingPlant, changing_plant
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.iec104.points import address
from service.gateways.iec61850.logical_devices import logical_devices
from service.gateways.modbus.register_map import BLOCK, FIRST_BLOCK
from service.gateways.supervision import PlantGateways
from service.timing.backoff import STABLE_AFTER_S
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.service.iec104_master import Master
from testing.service.mosquitto import Heard, running_mosquitto
from testing.waiting import wait_until

Look = Callable[[], bool]
"""Whether a new client is told a good value now."""

HEALTHY = 1
"""In the registers, and as the health (Ok) of IEC 61850-7-4."""
GOOD = open_data.BitStringData(bytes(2), 3)


def main() -> None:
    """Print the times."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--motors", type=int, default=500)
    parser.add_argument("--kills", type=int, default=5, help="of each gateway")
    wanted = parser.parse_args()
    ports = {kind: free_port() for kind in ("iec104", "iec61850", "modbus", "opcua")}
    with TemporaryDirectory(prefix="statorwatch-") as name, running_mosquitto(Path(name)) as broker:
        plant = changing_plant(Path(name), wanted.motors, now_ns=time.time_ns())
        tables: dict[str, dict[str, object]] = {kind: {"port": port} for kind, port in ports.items()}
        tables["opcua"] |= {"anonymous": True, "unencrypted": True}
        tables["mqtt"] = {"port": broker.port, "sparkplug": {}}
        gateways = GatewaysSettings.model_validate(tables)
        with (
            broker.listening("statorwatch/status") as heard,
            running_gateways(Settings(data_directory=Path(name), gateways=gateways)) as running,
        ):
            looks = _looks(ports, plant, heard)
            for kind, look in looks.items():
                wait_until(look, f"a good value from {kind}")
            times_s: dict[str, list[float]] = {kind: [] for kind in looks}
            for _ in range(wanted.kills):
                begun_s = time.monotonic()
                for kind, look in looks.items():
                    times_s[kind].append(_killed_s(running, kind, look))
                    print(f"{kind}: {times_s[kind][-1]:.1f} s", flush=True)
                # Those that are killed again and again are given longer pauses: that is not what is measured.
                time.sleep(max(0.0, begun_s + STABLE_AFTER_S + 10.0 - time.monotonic()))
            assert all(look() for look in looks.values())
    print(f"{wanted.motors} motors, each gateway killed {wanted.kills} times")
    for kind, found_s in times_s.items():
        print(f"{kind:9} back after {median(found_s):.1f} s in the middle, {max(found_s):.1f} s at most")


def _killed_s(running: PlantGateways, kind: str, look: Look) -> float:
    (process_id,) = (one.process_id for one in running.status() if one.kind == kind)
    assert process_id is not None
    begun_s = time.monotonic()
    os.kill(process_id, signal.SIGKILL)
    wait_until(lambda: not look(), f"{kind} to be gone")
    wait_until(look, f"a good value from {kind}")
    return time.monotonic() - begun_s


def _looks(ports: Mapping[str, int], plant: ChangingPlant, heard: list[Heard]) -> dict[str, Look]:
    """The last motor as each client sees it: it is told last."""
    place = len(plant.motors) - 1
    name = plant.motors[place]

    def of_iec104() -> bool:
        try:
            with closing(Master(LOOPBACK, ports["iec104"])) as master:
                return master.read(address(place, 0)).quality == 0
        except OSError:
            return False

    def of_iec61850() -> bool:
        health = f"MCC{logical_devices(plant.motors)[name]}/ZMOT1.EEHealth"
        try:
            with open_mms.MmsClient.connect(LOOPBACK, port=ports["iec61850"]) as client:
                state, quality = (client.read(f"{health}.{part}[ST]") for part in ("stVal", "q"))
        except OSError:
            return False
        return (state, quality) == (open_data.IntData(HEALTHY), GOOD)

    def of_modbus() -> bool:
        first = FIRST_BLOCK + BLOCK * place
        command = ["mbpoll", "-0", "-1", "-q", "-B", "-t", "3", "-c", "5"]
        command += ["-p", str(ports["modbus"]), "-r", str(first), LOOPBACK]
        done = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
        return [int(one) for one in re.findall(r"^\[\d+\]:\s+(\d+)", done.stdout, re.MULTILINE)] == [
            HEALTHY,
            0,
            0,
            0,
            0,
        ]

    def of_opcua() -> bool:
        try:
            with OpcUaClient(f"opc.tcp://{LOOPBACK}:{ports['opcua']}/") as client:
                node = client.get_node(f"ns=2;s=motor/{name}/State")
                found = node.read_data_value(raise_on_bad_status=False)
        except (OSError, TimeoutError, ua.UaError):
            return False
        assert found.StatusCode is not None
        return bool(found.StatusCode.value == ua.StatusCodes.Good)

    def of_mqtt() -> bool:
        return bool(heard) and b'"state": "online"' in heard[-1].payload

    return {
        "iec104": of_iec104,
        "iec61850": of_iec61850,
        "modbus": of_modbus,
        "mqtt": of_mqtt,
        "opcua": of_opcua,
    }


if __name__ == "__main__":
    main()
